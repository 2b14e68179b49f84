#include "synthetic/procedural_gait.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/time.h"

namespace remomask::synthetic {

namespace {

constexpr double kPathRate = 400;   // samples a second of the integrated path
constexpr double kToeAhead = 0.10;  // of the pelvis, of a foot in the middle of its stance
constexpr double kToeOut = 7;       // degrees

struct PathPoint {
  double x = 0, z = 0, yaw = 0;
};

struct GaitStep {
  int side = 0;
  double lift = 0, land = 0;
  Vec3 target = Vec3::Zero();
  double yaw = 0;
};

double to_radians(double degrees) { return degrees * std::numbers::pi / 180; }

class Walker {
 public:
  explicit Walker(const GaitPlan& plan) : plan_(plan) {
    integrate_path();
    plan_steps();
  }

  BodyPose pose_at(double t) const {
    BodyPose pose = standing_pose(plan_.half_width);
    const PathPoint here = path_at(t);
    const double active = plan_.activity(t);
    const Swing swing = swing_at(t);
    const PathVelocity v = plan_.velocity(t);
    const bool running = plan_.duty < 0.5;
    // Walking is highest over the standing leg, running in the air.
    const double bob = -std::cos(2 * std::numbers::pi * swing.phase) * (running ? -1 : 1);
    const double sway =
        plan_.sway * side_sign(swing.side) * std::sin(std::numbers::pi * swing.phase);
    const double yaw = to_radians(here.yaw);
    pose.pelvis = Vec3(here.x + std::cos(yaw) * sway * active,
                       standing_height() + plan_.height * active + plan_.bob * (bob - 0.3) * active,
                       here.z - std::sin(yaw) * sway * active);
    const double ahead = std::clamp(v.forward / 0.5, -1.0, 1.0) * swing.left_ahead * active;
    pose.yaw = here.yaw - 5 * ahead;
    pose.roll = -2.5 * side_sign(swing.side) * std::sin(std::numbers::pi * swing.phase) * active;
    pose.lean = -pose.roll;
    pose.twist = 11 * ahead;
    pose.look = -6 * ahead;
    pose.pitch = 0.4 * plan_.bend * active;
    pose.bend = plan_.bend * active;
    for (int side = 0; side < 2; ++side) {
      const double forward = -side_sign(side) * ahead;
      ArmPose& arm = pose.arms[side];
      arm.flex += plan_.arm_swing * forward + 0.6 * plan_.bend * active;
      arm.elbow += (plan_.elbow - arm.elbow) * active + plan_.elbow_swing * forward;
      pose.feet[side] = foot_at(t, side);
    }
    return pose;
  }

 private:
  struct Swing {
    int side = 0;           // of the foot that landed last
    double phase = 0;       // 0 at its landing, 1 at the next
    double left_ahead = 0;  // 1 when the left foot lands, -1 when the right one does
  };

  void integrate_path() {
    const int samples = static_cast<int>(plan_.duration * kPathRate) + 2;
    PathPoint p;
    for (int i = 0; i < samples; ++i) {
      path_.push_back(p);
      const PathVelocity v = plan_.velocity((i + 0.5) / kPathRate);
      const double yaw = to_radians(p.yaw + v.turn / kPathRate / 2);
      p.x += (std::cos(yaw) * v.left + std::sin(yaw) * v.forward) / kPathRate;
      p.z += (-std::sin(yaw) * v.left + std::cos(yaw) * v.forward) / kPathRate;
      p.yaw += v.turn / kPathRate;
    }
  }

  PathPoint path_at(double t) const {
    const double at = std::clamp(t * kPathRate, 0.0, static_cast<double>(path_.size() - 1));
    const size_t i = std::min(static_cast<size_t>(at), path_.size() - 2);
    const double u = at - static_cast<double>(i);
    const PathPoint &a = path_[i], &b = path_[i + 1];
    return {a.x + (b.x - a.x) * u, a.z + (b.z - a.z) * u, a.yaw + (b.yaw - a.yaw) * u};
  }

  void place(GaitStep& step, double t) const {
    const PathPoint p = path_at(t);
    // Sideways the leading foot steps wider and the other one closes up.
    const double half = plan_.half_width + std::abs(plan_.velocity(t).left) * plan_.half_period / 2;
    const double out = side_sign(step.side) * half, yaw = to_radians(p.yaw);
    step.target = Vec3(p.x + std::cos(yaw) * out + std::sin(yaw) * kToeAhead, 0,
                       p.z - std::sin(yaw) * out + std::cos(yaw) * kToeAhead);
    step.yaw = p.yaw + kToeOut * side_sign(step.side);
  }

  void plan_steps() {
    for (int side = 0; side < 2; ++side) {  // where the feet stand before the first step
      GaitStep step;
      step.side = side;
      step.lift = step.land = -1;
      place(step, 0);
      feet_[side].push_back(step);
    }
    const double full_swing = 2 * plan_.half_period * (1 - plan_.duty);
    double land = 0;
    for (int k = 0; k < plan_.steps; ++k) {
      GaitStep step;
      step.side = (plan_.first_side + k) % 2;
      // From and into a stand a foot is never in the air together with the other one.
      const bool edge = k == 0 || k + 1 == plan_.steps;
      const double swing = edge ? std::min(full_swing, 0.9 * plan_.half_period) : full_swing;
      // The body hurries over a lame leg: the other foot lands early.
      const double hurry = step.side == plan_.limp_side ? plan_.limp : -plan_.limp;
      land = k == 0 ? plan_.first_lift + swing : land + plan_.half_period * (1 + hurry);
      step.land = land;
      step.lift = std::max(land - swing, feet_[step.side].back().land + 0.06);
      landings_.push_back(step);
      feet_[step.side].push_back(step);
    }
    for (std::vector<GaitStep>& steps : feet_) {
      for (size_t i = 1; i < steps.size(); ++i) {
        const bool last = i + 1 == steps.size();
        place(steps[i], last ? plan_.duration : (steps[i].land + steps[i + 1].lift) / 2);
      }
    }
  }

  Swing swing_at(double t) const {
    Swing swing;
    size_t next = 0;
    while (next < landings_.size() && landings_[next].land <= t) ++next;
    const double from = next > 0 ? landings_[next - 1].land : landings_[0].land - plan_.half_period;
    const double to = next < landings_.size() ? landings_[next].land : from + plan_.half_period;
    swing.side = next > 0 ? landings_[next - 1].side : 1 - landings_[0].side;
    swing.phase = std::clamp((t - from) / (to - from), 0.0, 1.0);
    swing.left_ahead = side_sign(swing.side) * std::cos(std::numbers::pi * swing.phase);
    return swing;
  }

  double heel_when_leaving(double lift) const {
    return plan_.heel * (0.35 + 0.65 * plan_.activity(lift));
  }

  FootPose foot_at(double t, int side) const {
    const std::vector<GaitStep>& steps = feet_[side];
    size_t i = 0;
    while (i + 1 < steps.size() && steps[i + 1].lift <= t) ++i;
    const GaitStep& step = steps[i];
    FootPose foot;
    if (t < step.land) {
      foot = swinging_foot(steps[i - 1], step, t);
    } else {
      foot.ball = step.target;
      foot.yaw = step.yaw;
      const double until = i + 1 < steps.size() ? steps[i + 1].lift : 1e9;
      const double stance = std::min(until - step.land, 1.0);
      foot.pitch = -toe_when_landing(step) * (1 - ease(t, step.land, step.land + 0.3 * stance));
      if (until < 1e8) {
        foot.pitch +=
            heel_when_leaving(until) *
            std::pow(std::clamp((t - until + 0.5 * stance) / (0.5 * stance), 0.0, 1.0), 2);
      }
    }
    foot.pitch = std::max(foot.pitch, plan_.tiptoe * plan_.activity(t));
    return foot;
  }

  double toe_when_landing(const GaitStep& step) const {
    return step.lift < 0 ? 0 : plan_.toe * plan_.activity(step.land);
  }

  FootPose swinging_foot(const GaitStep& from, const GaitStep& to, double t) const {
    FootPose foot;
    foot.planted = false;
    const double u = (t - to.lift) / (to.land - to.lift);
    // The foot is off the floor before it goes forward and above its place before it lands.
    const double going = std::clamp((u - 0.07) / 0.86, 0.0, 1.0);
    const double smooth =
        going * going * (3 - 2 * going);  // slower at its fastest than minimum jerk
    const size_t index =
        static_cast<size_t>(std::find_if(landings_.begin(), landings_.end(),
                                         [&](const GaitStep& s) { return s.land == to.land; }) -
                            landings_.begin());
    const double clearance =
        plan_.clearance * (0.5 + 0.5 * plan_.activity((to.lift + to.land) / 2)) +
        (plan_.extra_clearance ? plan_.extra_clearance(static_cast<int>(index)) : 0.0);
    foot.ball = from.target + (to.target - from.target) * smooth;
    foot.ball.y() = clearance * std::pow(std::sin(std::numbers::pi * std::pow(u, 0.85)), 2);
    foot.yaw = from.yaw + (to.yaw - from.yaw) * smooth;
    const double heel = heel_when_leaving(to.lift), toe = toe_when_landing(to);
    foot.pitch = heel + (-toe - heel) * min_jerk(u * 1.15);
    return foot;
  }

  GaitPlan plan_;
  std::vector<PathPoint> path_;
  std::vector<GaitStep> landings_;
  std::vector<GaitStep> feet_[2];
};

}  // namespace

double last_landing(const GaitPlan& plan) {
  const double swing = 2 * plan.half_period * (1 - plan.duty);
  return plan.first_lift + std::min(swing, 0.9 * plan.half_period) +
         (plan.steps - 1) * plan.half_period * (1 + std::abs(plan.limp));
}

std::vector<BodyPose> walk_poses(const GaitPlan& plan) {
  const Walker walker(plan);
  std::vector<BodyPose> poses;
  const int frames = frames_in(plan.duration);
  for (int f = 0; f < frames; ++f)
    poses.push_back(walker.pose_at(seconds_of(static_cast<size_t>(f))));
  return poses;
}

BodyPose standing_pose(double half_width) {
  BodyPose pose;
  pose.pelvis = Vec3(0, standing_height(), 0);
  for (int side = 0; side < 2; ++side) {
    pose.feet[side].ball = Vec3(side_sign(side) * half_width, 0, kToeAhead);
    pose.feet[side].yaw = kToeOut * side_sign(side);
    pose.arms[side].flex = 2;
    pose.arms[side].abduct = 9;
    pose.arms[side].twist = -20;
    pose.arms[side].elbow = 14;
  }
  return pose;
}

}  // namespace remomask::synthetic
