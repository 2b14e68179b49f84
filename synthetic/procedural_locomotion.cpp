// Gaits: what a kind of walk or run means in terms of a GaitPlan.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/time.h"
#include "synthetic/procedural_actions.h"
#include "synthetic/procedural_gait.h"

namespace remomask::synthetic {

namespace {

constexpr double kStandPadding = 0.25;  // seconds of stand before and after the steps

void plan_walk(GaitPlan& plan, double speed) {
  plan.half_period = std::clamp(0.55 * std::pow(1.2 / std::max(speed, 0.3), 0.5), 0.36, 0.85);
  plan.duty = std::clamp(0.66 - 0.04 * speed, 0.57, 0.66);
  plan.heel = 26 + 12 * speed;
  plan.toe = 8 + 7 * speed;
  plan.bob = 0.012 + 0.008 * speed;
  plan.arm_swing = 10 + 13 * speed;
  plan.elbow = 12 + 8 * speed;
  plan.bend = 1 + 2 * speed;
  plan.height = -0.004 - 0.012 * speed;
}

void plan_run(GaitPlan& plan, double speed) {
  plan.half_period = 0.36 * std::pow(3.0 / speed, 0.4);
  plan.duty = std::clamp(0.41 - 0.03 * speed, 0.27, 0.38);
  plan.clearance = 0.10 + 0.05 * speed;
  plan.heel = std::min(58 + 5 * speed, 80.0);
  plan.toe = 6;
  plan.bob = 0.04;
  plan.sway = 0.006;
  plan.half_width = 0.06;
  plan.height = -0.055;
  plan.arm_swing = 26 + 6 * speed;
  plan.elbow = 86;
  plan.elbow_swing = 10;
  plan.bend = 6 + 1.4 * speed;
}

void fit_steps(GaitPlan& plan) {
  plan.first_lift = kStandPadding;
  plan.steps = 2;
  const double end = plan.duration - kStandPadding;
  while (true) {
    ++plan.steps;
    if (last_landing(plan) > end) break;
  }
  --plan.steps;
}

/// Speed up within about two steps, slow down before the last landing.
struct PathRamp {
  double from, to, ramp;
  double operator()(double t) const { return pulse(t, from, to, ramp); }
};

PathRamp ramp_of(const GaitPlan& plan) {
  const double to = last_landing(plan);
  const double length = to - plan.first_lift;
  return {plan.first_lift, to,
          std::min((plan.duty < 0.5 ? 3.2 : 2.0) * plan.half_period, length / 2.5)};
}

void lift_arms_for_sneaking(BodyPose& pose, double weight) {
  for (ArmPose& arm : pose.arms) {
    ArmPose careful = arm;
    careful.flex += 38;
    careful.abduct += 6;
    careful.elbow = 82;
    arm = mix(arm, careful, weight);
  }
}

void crouch_trunk(BodyPose& pose, double weight) {
  pose.pitch += 18 * weight;
  pose.bend += 16 * weight;
  pose.nod -= 24 * weight;
  for (ArmPose& arm : pose.arms) {
    arm.flex += 30 * weight;
    arm.elbow += 30 * weight;
  }
}

}  // namespace

Poses make_gait(const ProceduralParameters& p, GaitKind kind, ActionSide which) {
  const int side = which == ActionSide::both ? 1 : static_cast<int>(which);
  const double s = side_sign(side), speed = p.speed;
  GaitPlan plan;
  plan.duration = p.duration;
  plan.first_side = static_cast<int>(p.variation / 2 % 2);
  if (kind == GaitKind::run)
    plan_run(plan, speed);
  else
    plan_walk(plan, speed);
  plan.arm_swing *= p.amplitude;
  double crouch = 0, careful = 0;
  switch (kind) {
    case GaitKind::backward:
      plan.heel = 12;
      plan.toe = -14;  // the toe lands first
      plan.arm_swing *= 0.6;
      break;
    case GaitKind::sideways:
      plan.first_side = side;
      plan.heel = 14;
      plan.toe = 3;
      plan.half_width = 0.085;
      break;
    case GaitKind::tiptoe:
      plan.tiptoe = 40;
      plan.height = 0.055;
      plan.heel = 55;
      plan.toe = -40;
      plan.bend = 1;
      plan.arm_swing *= 0.5;
      break;
    case GaitKind::limp:
      plan.limp = 0.24;
      plan.limp_side = side;
      plan.heel = 22;
      break;
    case GaitKind::sneak:
      plan.half_period *= 1.15;
      plan.clearance = 0.17;
      plan.toe = -16;
      plan.height = -0.10;
      plan.bend = 16;
      plan.arm_swing *= 0.3;
      careful = 1;
      break;
    case GaitKind::march:
      plan.half_period = 0.52;
      plan.clearance = 0.42 * p.amplitude;
      plan.heel = 34;
      plan.arm_swing = 40 * p.amplitude;
      plan.elbow = 30;
      plan.bend = 0;
      break;
    case GaitKind::crouch:
      plan.height = -0.24;
      plan.heel = 20;
      plan.clearance = 0.05;
      plan.arm_swing *= 0.6;
      crouch = 1;
      break;
    default:
      break;
  }
  double moving_until = p.duration;
  if (kind == GaitKind::stop) moving_until = 0.62 * p.duration;
  if (kind == GaitKind::wave_after) moving_until = 0.5 * p.duration;
  plan.duration = moving_until;
  fit_steps(plan);
  plan.duration = p.duration;
  if (kind == GaitKind::step_over) {
    // The obstacle lies in the middle; both feet clear it one after the other.
    const int high = plan.steps / 2;
    plan.extra_clearance = [=](int step) {
      return step == high || step == high + 1 ? 0.47 * p.amplitude : 0.0;
    };
  }
  const PathRamp ramp = ramp_of(plan);
  plan.activity = ramp;
  const double steady = ramp.to - ramp.from - ramp.ramp;  // seconds at full speed, ramps as halves
  plan.velocity = [=](double t) {
    PathVelocity v;
    const double now = speed * ramp(t);
    if (kind == GaitKind::sideways)
      v.left = s * now;
    else
      v.forward = kind == GaitKind::backward ? -now : now;
    if (kind == GaitKind::circle) v.turn = s * 360 * ramp(t) / steady;
    if (kind == GaitKind::turn_after) {
      // A corner, walked through within 1.4 seconds after the middle.
      const double corner = p.duration / 2;
      v.turn = s * 90 * pulse(t, corner - 0.5, corner + 0.9, 0.5) / 0.9;
    }
    return v;
  };
  Poses poses = walk_poses(plan);
  for (size_t f = 0; f < poses.size(); ++f) {
    const double t = seconds_of(f), active = ramp(t);
    BodyPose& pose = poses[f];
    if (crouch > 0) crouch_trunk(pose, active);
    if (careful > 0) lift_arms_for_sneaking(pose, active);
    if (kind == GaitKind::limp) {
      // The trunk falls towards the lame side while that leg bears the weight.
      const double bearing = std::clamp(-pose.roll * s / 2.5, 0.0, 1.0);
      pose.lean += s * 9 * bearing;
      pose.pelvis.y() -= 0.035 * bearing;
    }
    if (kind == GaitKind::wave_after) {
      pose.arms[side] = waving_arm(pose.arms[side], t, moving_until, p.duration - 0.2, p.amplitude);
    }
    if (kind == GaitKind::turn_after || kind == GaitKind::circle) {
      pose.look += std::clamp(plan.velocity(t).turn * 0.18, -16.0, 16.0);
    }
  }
  const bool steady_gait = kind != GaitKind::circle && kind != GaitKind::step_over &&
                           kind != GaitKind::stop && kind != GaitKind::turn_after &&
                           kind != GaitKind::wave_after;  // the others tell a whole story
  if (!p.from_stand && steady_gait) {
    const int first = static_cast<int>(std::ceil((ramp.from + ramp.ramp) * kFps));
    const int last = static_cast<int>((ramp.to - ramp.ramp) * kFps);
    if (last - first >= 40) return Poses(poses.begin() + first, poses.begin() + last);
  }
  return poses;
}

Poses make_turn(const ProceduralParameters& p, ActionSide which, double degrees) {
  const double s = side_sign(static_cast<int>(which));
  GaitPlan plan;
  plan_walk(plan, 0.5);
  plan.half_period = 0.46 / style_tempo(p.style);
  plan.first_side = static_cast<int>(which);
  plan.heel = 16;
  plan.toe = 4;
  plan.clearance = 0.05;
  plan.steps = 2 + static_cast<int>(std::lround(degrees / 45));
  plan.first_lift = 0.4;
  plan.duration = last_landing(plan) + 0.6;
  const PathRamp ramp{plan.first_lift, last_landing(plan), plan.half_period};
  const double steady = ramp.to - ramp.from - ramp.ramp;
  plan.activity = ramp;
  plan.velocity = [=](double t) { return PathVelocity{0, 0, s * degrees * ramp(t) / steady}; };
  Poses poses = walk_poses(plan);
  for (size_t f = 0; f < poses.size(); ++f) {
    // The head leads.
    const double t = seconds_of(f);
    poses[f].look += s * 22 * pulse(t, 0.2, ramp.to - 0.1, 0.6);
    poses[f].twist += s * -7 * pulse(t, 0.3, ramp.to, 0.6);
  }
  return poses;
}

}  // namespace remomask::synthetic
