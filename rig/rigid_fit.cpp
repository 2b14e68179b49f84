#include "rig/rigid_fit.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "remomask/skeleton.h"

namespace remomask::rig {

namespace {

constexpr int kFitRounds = 8, kSettleRounds = 6;
constexpr double kConverged = 2e-5;     // m, largest move of a joint in a round
constexpr double kRodTolerance = 1e-7;  // m
constexpr double kLargestMove = 0.05;   // m in a round, while far from the constraints
constexpr double kTolerated = 0.01;     // m; joints farther away gain weight
constexpr double kMaxGain = 8;
constexpr double kFootWeight = 100, kWristWeight = 4, kSpineWeight = 3;

using Weights = std::array<double, kRigJoints>;

Weights base_weights() {
  Weights weights;
  weights.fill(1);
  for (const size_t foot : {7, 8, 10, 11}) weights[foot] = kFootWeight;
  for (const size_t wrist : {20, 21}) weights[wrist] = kWristWeight;
  // The short bone between these would fold before it moves a misfit chest.
  for (const size_t spine : {6, 9}) weights[spine] = kSpineWeight;
  return weights;
}

/// Joints that are far away gain weight, which brings the fit near to that of the smallest largest
/// distance. The square root keeps the rounds from
/// swinging.
void gain_weight(const Pose& target, const Pose& pose, const Weights& base, Weights& weights) {
  for (size_t j = 0; j < kRigJoints; ++j) {
    const double far = (target[j] - pose[j]).squaredNorm() / (kTolerated * kTolerated);
    weights[j] = std::sqrt(weights[j] * base[j] * std::min(1 + far, kMaxGain));
  }
}

}  // namespace

struct RigidFit::State {
  Pose pose;
  Weights weights;
  std::array<Vec3, kRods> directions;
  Vector errors;  ///< of the lengths
};

RigidFit::RigidFit(const RestSkeleton& rest) : rest_(rest) {
  // Limbs from their ends to the trunk, then the trunk: a matrix in this order has all that is not
  // zero near its diagonal, and elimination keeps it so.
  static constexpr std::array<std::array<size_t, 2>, kRods> kPairs = {
      {{7, 10},  {4, 7},   {1, 4},   {8, 11},  {5, 8},  {2, 5},   {0, 1},  {0, 2},   {1, 2},
       {0, 3},   {1, 3},   {2, 3},   {3, 6},   {6, 9},  {12, 15}, {9, 12}, {18, 20}, {16, 18},
       {13, 16}, {19, 21}, {17, 19}, {14, 17}, {9, 13}, {12, 13}, {9, 14}, {12, 14}, {13, 14}}};
  const std::vector<int>& parents = humanml_skeleton().parents;
  for (size_t k = 0; k < kRods; ++k) {
    const auto [a, b] = kPairs[k];
    const bool bone = parents[b] == static_cast<int>(a);
    rods_[k] = {a, b, (bone ? rest.offsets[b] : Vec3(rest.offsets[b] - rest.offsets[a])).norm()};
    first_[k] = k;
    for (size_t l = 0; l < k; ++l) {
      for (const size_t joint : {a, b}) {
        if (joint != kPairs[l][0] && joint != kPairs[l][1]) continue;
        const double sign = (joint == b) == (joint == kPairs[l][1]) ? 1 : -1;
        neighbours_[k][neighbour_count_[k]++] = {l, joint, sign};
        first_[k] = std::min(first_[k], l);
      }
    }
  }
}

Pose RigidFit::nearest_by_directions(const Pose& target) const {
  const std::vector<int>& parents = humanml_skeleton().parents;
  const auto chest_or_pelvis = [&](size_t joint, size_t left, size_t right, size_t top) {
    return rotation_of_triangle(rest_.offsets[left], rest_.offsets[right], rest_.offsets[top],
                                target[left] - target[joint], target[right] - target[joint],
                                target[top] - target[joint]);
  };
  const Quat pelvis = chest_or_pelvis(0, 1, 2, 3), chest = chest_or_pelvis(9, 13, 14, 12);
  Pose pose;
  pose[0] = target[0];
  for (size_t j = 1; j < kRigJoints; ++j) {
    const auto parent = static_cast<size_t>(parents[j]);
    Vec3 bone = target[j] - target[parent];
    const double length = bone.norm(), wanted = rest_.offsets[j].norm();
    bone = length > 1e-9 ? Vec3(bone * (wanted / length)) : rest_.offsets[j];
    if (parent == 0) bone = pelvis * rest_.offsets[j];
    if (parent == 9) bone = chest * rest_.offsets[j];
    pose[j] = pose[parent] + bone;
  }
  return pose;
}

void RigidFit::measure(State& state) const {
  for (size_t k = 0; k < kRods; ++k) {
    const Vec3 along = state.pose[rods_[k].b] - state.pose[rods_[k].a];
    const double length = along.norm();
    state.directions[k] = length > 1e-9 ? Vec3(along / length) : Vec3::Zero();
    state.errors[k] = length - rods_[k].length;
  }
}

/// Solves A x = right for the matrix A of the rods over each other, by Cholesky's method within the
/// matrix's skyline.
void RigidFit::solve(State& state, Vector& right) const {
  std::array<Vector, kRods> lower;
  for (size_t k = 0; k < kRods; ++k) {
    std::fill(lower[k].begin() + static_cast<ptrdiff_t>(first_[k]),
              lower[k].begin() + static_cast<ptrdiff_t>(k), 0.0);
    for (size_t n = 0; n < neighbour_count_[k]; ++n) {
      const Neighbour& other = neighbours_[k][n];
      lower[k][other.rod] += other.sign / state.weights[other.joint] *
                             state.directions[k].dot(state.directions[other.rod]);
    }
    const double size = state.directions[k].squaredNorm();
    // The small addition keeps bones without a length from dividing by zero.
    lower[k][k] = size * (1 / state.weights[rods_[k].a] + 1 / state.weights[rods_[k].b]) + 1e-10;
    for (size_t l = first_[k]; l <= k; ++l) {
      double sum = lower[k][l];
      for (size_t i = std::max(first_[k], first_[l]); i < l; ++i) sum -= lower[k][i] * lower[l][i];
      lower[k][l] = l < k ? sum / lower[l][l] : std::sqrt(std::max(sum, 1e-10));
    }
    for (size_t l = first_[k]; l < k; ++l) right[k] -= lower[k][l] * right[l];
    right[k] /= lower[k][k];
  }
  for (size_t k = kRods; k-- > 0;) {
    right[k] /= lower[k][k];
    for (size_t l = first_[k]; l < k; ++l) right[l] -= lower[k][l] * right[k];
  }
}

double RigidFit::step(State& state, const Pose& pull, double most) const {
  Vector forces;
  for (size_t k = 0; k < kRods; ++k) {
    const Rod& rod = rods_[k];
    forces[k] = -state.errors[k] - state.directions[k].dot(pull[rod.b] - pull[rod.a]);
  }
  solve(state, forces);
  Pose moves = pull;
  for (size_t k = 0; k < kRods; ++k) {
    const Rod& rod = rods_[k];
    moves[rod.b] += forces[k] / state.weights[rod.b] * state.directions[k];
    moves[rod.a] -= forces[k] / state.weights[rod.a] * state.directions[k];
  }
  double largest = 0;
  for (const Vec3& move : moves) largest = std::max(largest, move.norm());
  const double share = largest > most ? most / largest : 1;
  for (size_t j = 0; j < kRigJoints; ++j) state.pose[j] += share * moves[j];
  return largest;
}

Pose RigidFit::fit(const Pose& target) const {
  static const Weights base = base_weights();
  const Pose first = nearest_by_directions(target);
  State state{first, base, {}, {}};
  Pose pull;
  measure(state);
  for (int round = 0; round < kFitRounds; ++round) {
    for (size_t j = 0; j < kRigJoints; ++j) pull[j] = target[j] - state.pose[j];
    if (round > 0) gain_weight(target, state.pose, base, state.weights);
    const double moved = step(state, pull, kLargestMove);
    measure(state);
    if (moved < kConverged) break;
  }
  pull.fill(Vec3::Zero());
  const auto worst = [&] {
    double largest = 0;
    for (const double error : state.errors) largest = std::max(largest, std::abs(error));
    return largest;
  };
  for (int round = 0; round < kSettleRounds && worst() > kRodTolerance; ++round) {
    step(state, pull, kLargestMove);
    measure(state);
  }
  // Joints in a heap have no pose near them; the directions of their bones still are one.
  constexpr double kFailed = 1e-4;
  return worst() < kFailed ? state.pose : first;
}

}  // namespace remomask::rig
