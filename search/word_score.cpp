#include "search/word_score.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "remomask/error.h"

namespace remomask::search {

namespace {

constexpr size_t kMinPairs = 20;
constexpr int kNewtonSteps = 50;
// Pairs in which only the side is wrong are rare among prompts, and a wrong side is wrong.
constexpr double kOtherSide = -6;

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

/// Weights of a logistic regression whose first column is the constant. Columns whose weight
/// would be negative are left out, the worst first, until none is.
Eigen::VectorXd logistic_regression(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right,
                                    const Eigen::VectorXd& offset, double ridge) {
  const Eigen::Index width = rows.cols();
  std::vector<bool> used(static_cast<size_t>(width), true);
  for (;;) {
    Eigen::VectorXd beta = Eigen::VectorXd::Zero(width);
    for (int step = 0; step < kNewtonSteps; ++step) {
      const Eigen::VectorXd p = (rows * beta + offset).unaryExpr(&sigmoid);
      Eigen::VectorXd penalty = Eigen::VectorXd::Constant(width, ridge);
      penalty(0) = 0;
      Eigen::VectorXd gradient = rows.transpose() * (right - p) - penalty.cwiseProduct(beta);
      const Eigen::VectorXd curvature = p.cwiseProduct(Eigen::VectorXd::Ones(p.size()) - p);
      Eigen::MatrixXd hessian = rows.transpose() * curvature.asDiagonal() * rows;
      hessian.diagonal() += penalty + Eigen::VectorXd::Constant(width, 1e-9);
      for (Eigen::Index c = 0; c < width; ++c) {
        if (used[static_cast<size_t>(c)]) continue;
        gradient(c) = 0;
        hessian.row(c).setZero();
        hessian.col(c).setZero();
        hessian(c, c) = 1;
      }
      const Eigen::VectorXd move = hessian.ldlt().solve(gradient);
      beta += move;
      if (move.cwiseAbs().maxCoeff() < 1e-9) break;
    }
    Eigen::Index worst = 0;
    for (Eigen::Index c = 1; c < width; ++c) {
      if (beta(c) < 0 && (worst == 0 || beta(c) < beta(worst))) worst = c;
    }
    if (worst == 0) return beta;
    used[static_cast<size_t>(worst)] = false;
  }
}

struct Regression {
  Eigen::MatrixXd rows;
  Eigen::VectorXd right, offset;

  Regression(const std::vector<JudgedFeatures>& pairs, Eigen::Index width)
      : rows(static_cast<Eigen::Index>(pairs.size()), width),
        right(rows.rows()),
        offset(Eigen::VectorXd::Zero(rows.rows())) {
    for (size_t i = 0; i < pairs.size(); ++i) {
      right(static_cast<Eigen::Index>(i)) = pairs[i].right ? 1 : 0;
    }
  }
  Eigen::VectorXd solve(double ridge) const {
    return logistic_regression(rows, right, offset, ridge);
  }
};

void check_pairs(const std::vector<JudgedFeatures>& pairs) {
  size_t right = 0;
  for (const JudgedFeatures& pair : pairs) right += pair.right ? 1 : 0;
  if (pairs.size() < kMinPairs || right == 0 || right == pairs.size()) {
    throw Error("a score is fitted to at least 20 hits, some of them right and some wrong");
  }
}

}  // namespace

double WordScore::logit(const WordFeatures& features) const {
  const double cosine = features.motion.value_or(0);
  const double undescribed = motion_only_bias + motion_only * cosine;
  if (!features.captions) return undescribed;
  if (features.described < 1) {
    WordFeatures if_right = features;
    if_right.described = 1;
    const double p = features.described * probability(if_right) +
                     (1 - features.described) * sigmoid(undescribed);
    return std::log(p / (1 - p));
  }
  return bias + best * features.best + mean * features.mean + words * features.words +
         (features.other_side ? other_side : 0) + motion * cosine + share * features.share;
}

double WordScore::probability(const WordFeatures& features) const {
  return sigmoid(logit(features));
}

WordScore fit_word_score(const std::vector<JudgedFeatures>& worded,
                         const std::vector<JudgedFeatures>& moving, double ridge) {
  check_pairs(worded);
  check_pairs(moving);
  Regression with(worded, 6), without(moving, 2);
  for (size_t i = 0; i < worded.size(); ++i) {
    const WordFeatures& one = worded[i].features;
    const auto row = static_cast<Eigen::Index>(i);
    with.rows.row(row) << 1, one.best, one.mean, one.words, one.motion.value_or(0), one.share;
    if (one.other_side) with.offset(row) = kOtherSide;
  }
  for (size_t i = 0; i < moving.size(); ++i) {
    without.rows.row(static_cast<Eigen::Index>(i)) << 1, moving[i].features.motion.value_or(0);
  }
  const Eigen::VectorXd weights = with.solve(ridge), motion_weights = without.solve(ridge);
  WordScore score;
  score.bias = weights(0);
  score.best = weights(1);
  score.mean = weights(2);
  score.words = weights(3);
  score.motion = weights(4);
  score.share = weights(5);
  score.other_side = kOtherSide;
  score.motion_only_bias = motion_weights(0);
  score.motion_only = motion_weights(1);
  return score;
}

}  // namespace remomask::search
