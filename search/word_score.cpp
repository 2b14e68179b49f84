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
                                    const Eigen::VectorXd& weight, const Eigen::VectorXd& offset,
                                    double ridge) {
  const Eigen::Index width = rows.cols();
  std::vector<bool> used(static_cast<size_t>(width), true);
  for (;;) {
    Eigen::VectorXd beta = Eigen::VectorXd::Zero(width);
    for (int step = 0; step < kNewtonSteps; ++step) {
      const Eigen::VectorXd p = (rows * beta + offset).unaryExpr(&sigmoid);
      Eigen::VectorXd penalty = Eigen::VectorXd::Constant(width, ridge);
      penalty(0) = 0;
      Eigen::VectorXd gradient =
          rows.transpose() * (weight.cwiseProduct(right - p)) - penalty.cwiseProduct(beta);
      const Eigen::VectorXd curvature =
          weight.cwiseProduct(p.cwiseProduct(Eigen::VectorXd::Ones(p.size()) - p));
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
  Eigen::VectorXd right, weight, offset;
  explicit Regression(size_t count, Eigen::Index width)
      : rows(static_cast<Eigen::Index>(count), width),
        right(rows.rows()),
        weight(rows.rows()),
        offset(Eigen::VectorXd::Zero(rows.rows())) {}
};

}  // namespace

double WordScore::logit(const WordFeatures& features) const {
  const double cosine = features.motion.value_or(0);
  if (!features.captions) return motion_only_bias + motion_only * cosine;
  return bias + best * features.best + mean * features.mean + words * features.words +
         (features.other_side ? other_side : 0) + motion * cosine + share * features.share;
}

double WordScore::probability(const WordFeatures& features) const {
  return sigmoid(logit(features));
}

WordScore fit_word_score(const std::vector<JudgedFeatures>& pairs, double ridge) {
  size_t right = 0;
  for (const JudgedFeatures& pair : pairs) right += pair.right ? 1 : 0;
  if (pairs.size() < kMinPairs || right == 0 || right == pairs.size()) {
    throw Error("a score is fitted to at least 20 hits, some of them right and some wrong");
  }
  Regression worded(pairs.size(), 6), moving(pairs.size(), 2);
  for (size_t i = 0; i < pairs.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const WordFeatures& one = pairs[i].features;
    const double cosine = one.motion.value_or(0);
    worded.rows.row(row) << 1, one.best, one.mean, one.words, cosine, one.share;
    moving.rows.row(row) << 1, cosine;
    if (one.other_side) worded.offset(row) = kOtherSide;
    worded.right(row) = moving.right(row) = pairs[i].right ? 1 : 0;
    worded.weight(row) = moving.weight(row) = pairs[i].weight;
  }
  const Eigen::VectorXd with =
      logistic_regression(worded.rows, worded.right, worded.weight, worded.offset, ridge);
  const Eigen::VectorXd without =
      logistic_regression(moving.rows, moving.right, moving.weight, moving.offset, ridge);
  WordScore score;
  score.bias = with(0);
  score.best = with(1);
  score.mean = with(2);
  score.words = with(3);
  score.motion = with(4);
  score.share = with(5);
  score.other_side = kOtherSide;
  score.motion_only_bias = without(0);
  score.motion_only = without(1);
  return score;
}

}  // namespace remomask::search
