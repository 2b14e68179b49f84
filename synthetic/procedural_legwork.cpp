// Motions on the spot that the legs make: squat, sit, kick, jump.
#include <cmath>
#include <numbers>

#include "synthetic/procedural_actions.h"
#include "synthetic/procedural_pose_tools.h"

namespace remomask::synthetic {

namespace {

constexpr double kGravity = 9.81;

/// Heights over time of one jump: constant push, free flight, constant braking,
/// so that position and speed are continuous.
struct JumpCurve {
  double crouch_depth, rise, takeoff_speed;
  double crouch_end, takeoff, landing, absorbed, end;

  JumpCurve(double height, double depth, double tempo)
      : crouch_depth(depth), rise(0.06), takeoff_speed(std::sqrt(2 * kGravity * height)) {
    crouch_end = 0.55 / tempo;
    takeoff = crouch_end + 2 * (depth + rise) / takeoff_speed;
    landing = takeoff + 2 * takeoff_speed / kGravity;
    absorbed = landing + 2 * (0.7 * depth + rise) / takeoff_speed;
    end = absorbed + 0.6 / tempo;
  }
  double flight(double t) const {  // height of the feet
    if (t <= takeoff || t >= landing) return 0;
    const double u = t - takeoff;
    return takeoff_speed * u - kGravity / 2 * u * u;
  }
  double pelvis(double t) const {  // over the stand
    if (t < crouch_end) return -crouch_depth * ease(t, 0, crouch_end);
    if (t < takeoff) {
      const double u = (t - crouch_end) / (takeoff - crouch_end);
      return -crouch_depth + (crouch_depth + rise) * u * u;
    }
    if (t < landing) return rise + flight(t);
    const double low = -0.7 * crouch_depth;
    if (t < absorbed) {
      const double u = (absorbed - t) / (absorbed - landing);
      return low + (rise - low) * u * u;
    }
    return low * (1 - ease(t, absorbed, end));
  }
  double tiptoe(double t) const {  // heel lift, degrees
    const double push = takeoff - crouch_end;
    return 34 * (ease(t, crouch_end + 0.3 * push, takeoff) - ease(t, landing, absorbed));
  }
};

}  // namespace

double style_tempo(const std::string& style) {
  return style == "energetic" ? 1.15 : style == "tired" ? 0.85 : style == "old" ? 0.75 : 1.0;
}

Poses make_squat(const ProceduralParameters& p) {
  const double period = 2.2 / style_tempo(p.style), start = 0.4;
  const double duration = start + p.count * period + 0.4;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    const Repetition rep = repetition(t, start, period, p.count);
    const double down = rep.active ? pulse(rep.phase, 0, 1, 0.44) * p.amplitude : 0;
    for (int side = 0; side < 2; ++side) {
      pose.feet[side].ball.x() += 0.07 * side_sign(side);
      pose.feet[side].yaw += 10 * side_sign(side);
      ArmPose forward;
      forward.flex = 96;
      forward.elbow = 8;
      pose.arms[side] = mix(pose.arms[side], forward, std::min(down, 1.0));
    }
    pose.pelvis.y() -= 0.36 * down;
    pose.pelvis.z() -= 0.17 * down;
    pose.pitch += 28 * down;
    pose.bend += 10 * down;
    pose.nod -= 18 * down;
  });
}

Poses make_sit(const ProceduralParameters& p, bool stand_up) {
  const double ramp = 1.6 / style_tempo(p.style), start = 0.3;
  const double rise = p.duration - 0.3 - ramp;
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    double seated = ease(t, start, start + ramp), leaning = pulse(t, start, start + ramp, ramp / 2);
    if (stand_up) {
      seated -= ease(t, rise, rise + ramp);
      leaning += pulse(t, rise, rise + ramp, ramp / 2);
    }
    pose.pelvis.y() -= 0.38 * seated;
    pose.pelvis.z() -= 0.36 * seated;
    pose.pitch += 36 * leaning - 4 * seated;
    pose.bend += 12 * leaning + 6 * seated;
    pose.nod -= 16 * leaning;
    ArmPose resting;
    resting.flex = 15;
    resting.abduct = 6;
    resting.twist = -14;
    resting.elbow = 48;
    for (ArmPose& arm : pose.arms) {
      arm = mix(arm, resting, seated);
      arm.flex += 30 * leaning;
    }
  });
}

Poses make_kick(const ProceduralParameters& p, ActionSide which, bool sideways) {
  const int side = static_cast<int>(which), other = 1 - side;
  const double s = side_sign(side), period = 2.1 / style_tempo(p.style), start = 0.4;
  const double duration = start + p.count * period + 0.3;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    const Repetition rep = repetition(t, start, period, p.count);
    if (!rep.active) return;
    const double weight = pulse(rep.phase, 0, 1, 0.22);  // on the standing leg
    const double knee = pulse(rep.phase, 0.18, 0.84, 0.2);
    const double out = pulse(rep.phase, 0.36, 0.64, 0.12);
    const Vec3 floor = pose.feet[side].ball;
    const Vec3 bent = sideways ? Vec3(s * 0.30, 0.42, 0.12) : Vec3(s * 0.10, 0.42, 0.34);
    const Vec3 kicked = sideways ? Vec3(s * 0.90, 0.40 + 0.32 * p.amplitude, 0.08)
                                 : Vec3(s * 0.07, 0.42 + 0.36 * p.amplitude, 0.84);
    FootPose& foot = pose.feet[side];
    foot.planted = knee < 1e-9;
    foot.ball = floor + (bent - floor) * knee + (kicked - bent) * out;
    foot.pitch = 30 * knee - (sideways ? 45 : 75) * out;
    pose.pelvis.x() -= s * 0.085 * weight;
    pose.pelvis.y() -= 0.02 * weight;
    if (sideways) {
      pose.roll -= s * 14 * out;
      pose.lean -= s * 16 * out;
    } else {
      pose.pitch -= 10 * out;
      pose.bend += 4 * out;
    }
    ArmPose balance;
    balance.flex = 34;
    balance.abduct = 22;
    balance.elbow = 74;
    for (ArmPose& arm : pose.arms) arm = mix(arm, balance, weight);
    pose.arms[other].flex += 14 * out;
  });
}

Poses make_jump(const ProceduralParameters& p, double height, double distance) {
  const double depth = std::min(0.34, 0.14 + 0.5 * height);
  const JumpCurve curve(height * p.amplitude, depth, style_tempo(p.style));
  const double start = 0.3, duration = start + p.count * curve.end + 0.2;
  return make_poses(duration, [&](double time, BodyPose& pose) {
    const Repetition rep = repetition(time, start, curve.end, p.count);
    const double before = distance * (rep.active ? rep.index : time < start ? 0 : p.count);
    const double t = rep.active ? rep.phase * curve.end : 0;
    const double flown =
        std::clamp((t - curve.takeoff) / (curve.landing - curve.takeoff), 0.0, 1.0);
    const bool in_air = flown > 0 && flown < 1;
    const double crouched = std::max(0.0, -curve.pelvis(t));
    pose.pelvis.y() += curve.pelvis(t);
    pose.pelvis.z() += before + distance * ease(t, 0.45 * curve.crouch_end, curve.absorbed + 0.25);
    pose.pitch += 75 * crouched;
    pose.bend += 55 * crouched;
    pose.nod -= 35 * crouched;
    for (FootPose& foot : pose.feet) {
      foot.planted = !in_air;
      foot.ball.y() =
          curve.flight(t) + (distance > 0 ? 0.10 * std::sin(std::numbers::pi * flown) : 0);
      foot.ball.z() += before + distance * flown;
      foot.pitch = curve.tiptoe(t);
    }
    const double back = pulse(t, 0.05, curve.takeoff, 0.4 * curve.takeoff);
    const double up = ease(t, curve.crouch_end, curve.takeoff + 0.08) -
                      ease(t, curve.landing - 0.05, curve.absorbed + 0.3);
    for (ArmPose& arm : pose.arms) {
      arm.flex += -38 * back + (60 + 150 * std::min(height, 0.4)) * up;
      arm.elbow += 26 * (back + up);
    }
  });
}

Poses make_jumping_jacks(const ProceduralParameters& p) {
  const double half = 0.5 / style_tempo(p.style), start = 0.4;
  const double duration = start + p.count * 2 * half + 0.65;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    const Repetition rep = repetition(t, start, half, 2 * p.count);
    const bool closing = rep.index % 2 == 1;
    const double u = rep.phase;
    const double leave = 0.22, arrive = 0.66;
    const double flown = std::clamp((u - leave) / (arrive - leave), 0.0, 1.0);
    double open = rep.active ? min_jerk(flown) : 0, arms = rep.active ? ease(u, 0.05, 0.8) : 0;
    if (closing) open = 1 - open, arms = 1 - arms;
    const double lift = rep.active ? 0.07 * 4 * flown * (1 - flown) : 0;
    const double dip =
        rep.active ? pulse(u, 0, leave + 0.08, 0.12) + pulse(u, arrive - 0.06, 1, 0.16) : 0;
    for (int side = 0; side < 2; ++side) {
      FootPose& foot = pose.feet[side];
      foot.planted = lift <= 0;
      foot.ball += Vec3(side_sign(side) * 0.20 * p.amplitude * open, lift, 0);
      foot.pitch = rep.active ? 26 * pulse(u, 0.05, 0.85, 0.2) : 0;
      pose.arms[side].abduct += (150 - pose.arms[side].abduct) * arms;
      pose.arms[side].twist *= 1 - arms;
    }
    pose.pelvis.y() += lift - 0.05 * dip - 0.05 * open * p.amplitude;
    pose.bend += 3 * dip;
  });
}

}  // namespace remomask::synthetic
