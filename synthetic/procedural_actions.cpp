// Motions of the upper body on the spot.
#include "synthetic/procedural_actions.h"

#include <cmath>
#include <functional>
#include <numbers>

#include "synthetic/procedural_gait.h"
#include "synthetic/procedural_pose_tools.h"

namespace remomask::synthetic {

namespace {

double full_turns(double cycles) { return std::sin(2 * std::numbers::pi * cycles); }

/// A stand with one foot ahead, as for a punch or a throw; the feet stay.
void stagger_feet(BodyPose& pose, int front) {
  pose.feet[front].ball += Vec3(0.03 * side_sign(front), 0, 0.20);
  pose.feet[1 - front].ball += Vec3(0.05 * side_sign(1 - front), 0, -0.16);
  pose.feet[1 - front].yaw += 30 * side_sign(1 - front);
  pose.pelvis.y() -= 0.05;
  pose.pelvis.z() += 0.02;
}

}  // namespace

ArmPose waving_arm(const ArmPose& rest, double time, double from, double to, double amplitude) {
  ArmPose raised;
  raised.flex = 10;
  raised.abduct = 68 + 14 * amplitude;
  raised.twist = 84;
  const double waving = pulse(time, from + 0.4, to - 0.4, 0.4);
  raised.elbow = 82 + 24 * amplitude * waving * full_turns(1.5 * (time - from));
  return mix(rest, raised, pulse(time, from, to, 0.8));
}

Poses make_stand(const ProceduralParameters& p) {
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    // Weight goes slowly from foot to foot; a breath every four seconds.
    const double shift = full_turns(t / 5.5);
    pose.pelvis.x() += 0.018 * p.amplitude * shift;
    pose.roll = 1.5 * shift;
    pose.lean = -1.5 * shift;
    pose.bend += 1.2 * full_turns(t / 4);
    pose.look += 7 * p.amplitude * full_turns(t / 7);
  });
}

Poses make_wave(const ProceduralParameters& p, ActionSide which) {
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    for (int side = 0; side < 2; ++side) {
      if (!uses_side(which, side)) continue;
      pose.arms[side] = waving_arm(pose.arms[side], t, 0.3, p.duration - 0.3, p.amplitude);
    }
  });
}

Poses make_raise(const ProceduralParameters& p, ActionSide which) {
  const bool sideways = p.variation % 2 == 1;
  const double ramp = 0.32 * p.duration;
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    ArmPose raised;
    (sideways ? raised.abduct : raised.flex) = 158 * std::min(1.05, 0.75 + 0.25 * p.amplitude);
    if (!sideways) raised.abduct = 6;
    raised.elbow = 8;
    const double weight = pulse(t, 0.2, p.duration - 0.2, ramp);
    for (int side = 0; side < 2; ++side) {
      if (uses_side(which, side)) pose.arms[side] = mix(pose.arms[side], raised, weight);
    }
    pose.bend -= 3 * weight;
  });
}

Poses make_point(const ProceduralParameters& p, ActionSide which) {
  const int side = static_cast<int>(which);
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    ArmPose pointing;
    pointing.flex = 86 + 4 * p.amplitude;
    pointing.across = -5;
    pointing.elbow = 4;
    const double weight = pulse(t, 0.3, p.duration - 0.3, 0.7);
    pose.arms[side] = mix(pose.arms[side], pointing, weight);
    pose.twist -= 8 * weight * side_sign(side);  // the shoulder goes along
    pose.look -= pose.twist;
  });
}

Poses make_clap(const ProceduralParameters& p) {
  const double period = 0.55 / style_tempo(p.style), start = 0.9;
  const double duration = start + p.count * period + 1.0;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    const Repetition rep = repetition(t, start, period, p.count);
    // Closed once in the middle of every repetition.
    const double closed = rep.active ? std::pow(std::sin(std::numbers::pi * rep.phase), 2) : 0;
    ArmPose ready;
    ready.flex = 42;
    ready.abduct = 8;
    ready.twist = -31 * closed + 10 * p.amplitude * (1 - closed);
    ready.across = 2 + 6 * closed;
    ready.elbow = 72;
    const double weight = pulse(t, 0.1, duration - 0.1, 0.75);
    for (ArmPose& arm : pose.arms) arm = mix(arm, ready, weight);
    pose.nod += 6 * weight;
  });
}

Poses make_throw(const ProceduralParameters& p, ActionSide which) {
  const int side = static_cast<int>(which);
  const double s = side_sign(side), tempo = style_tempo(p.style);
  const double wind = 0.3, back = wind + 0.8 / tempo, release = back + 0.28 / tempo;
  const double through = release + 0.3, duration = through + 1.2;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    stagger_feet(pose, 1 - side);
    ArmPose drawn, thrown, low;
    drawn.abduct = 88;
    drawn.twist = 70;
    drawn.elbow = 105;
    drawn.across = -15;
    thrown.flex = 118;
    thrown.across = -22;  // forward in spite of the turned chest
    thrown.elbow = 14;
    low.flex = 42;
    low.across = 22;
    low.elbow = 28;
    ArmPose arm = mix(pose.arms[side], drawn, ease(t, wind, back));
    arm = mix(arm, thrown, ease(t, back, release));
    arm = mix(arm, low, ease(t, release, through));
    pose.arms[side] = mix(arm, pose.arms[side], ease(t, through + 0.1, duration - 0.1));
    ArmPose balance;
    balance.flex = 55;
    balance.across = 8;
    balance.elbow = 25;
    pose.arms[1 - side] = mix(pose.arms[1 - side], balance, pulse(t, wind, through, 0.5));
    const double drawn_back = ease(t, wind, back) - ease(t, back, release);
    const double forward = ease(t, back, release) - ease(t, through, duration - 0.1);
    pose.twist += s * p.amplitude * (34 * drawn_back - 26 * forward);
    pose.yaw += s * (8 * drawn_back - 10 * forward);
    pose.bend += -8 * drawn_back + 16 * p.amplitude * forward;
    pose.pelvis.z() += -0.07 * drawn_back + 0.09 * forward;
    pose.look -= pose.twist;
  });
}

Poses make_stretch(const ProceduralParameters& p) {
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    ArmPose up;
    up.flex = 168;
    up.abduct = 4;
    up.elbow = 14;
    const double weight = pulse(t, 0.2, p.duration - 0.2, 0.3 * p.duration);
    for (ArmPose& arm : pose.arms) arm = mix(arm, up, weight);
    const double held = pulse(t, 0.3 * p.duration, 0.7 * p.duration, 0.1 * p.duration);
    pose.bend -= 10 * p.amplitude * weight;
    pose.lean += 14 * p.amplitude * held * full_turns((t / p.duration - 0.3) / 0.4);
    pose.nod -= 14 * weight;
    for (FootPose& foot : pose.feet) foot.pitch = 12 * p.amplitude * held;
    pose.pelvis.y() += 0.025 * p.amplitude * held;
  });
}

Poses make_bow(const ProceduralParameters& p, double degrees) {
  const double tempo = style_tempo(p.style), period = (1.6 + degrees / 60) / tempo;
  const double start = 0.4, duration = start + p.count * period + 0.4;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    const Repetition rep = repetition(t, start, period, p.count);
    const double weight = rep.active ? pulse(rep.phase, 0, 1, 0.4) : 0;
    const double bent = degrees * std::min(p.amplitude, 1.1) * weight;
    pose.pitch += 0.55 * bent;
    pose.bend += 0.45 * bent;
    pose.nod += 0.15 * bent;
    pose.pelvis.z() -= 0.0022 * bent;  // the weight stays over the feet
    for (ArmPose& arm : pose.arms) {
      arm.flex += 0.7 * bent;
      arm.abduct -= 3 * weight;
    }
  });
}

Poses make_sway(const ProceduralParameters& p) {
  const double beat = 0.62 * style_tempo(p.style);
  return make_poses(p.duration, [&](double t, BodyPose& pose) {
    const double in = pulse(t, 0.1, p.duration - 0.1, 0.8) * p.amplitude;
    const double swing = full_turns(beat * t), late = full_turns(beat * t - 0.12);
    pose.feet[0].ball.x() += 0.05;
    pose.feet[1].ball.x() -= 0.05;
    pose.pelvis.x() += 0.075 * in * swing;
    pose.pelvis.y() -= 0.03 + 0.03 * in * (1 - std::abs(swing));
    pose.roll += 5 * in * swing;
    pose.lean += -9 * in * late;
    pose.yaw += 8 * in * late;
    pose.twist += 10 * in * late;
    pose.nod += 5 * in * full_turns(2 * beat * t);
    for (int side = 0; side < 2; ++side) {
      const double own = side_sign(side) * late;
      ArmPose dancing;
      dancing.flex = 22 + 14 * own;
      dancing.abduct = 24 + 12 * own;
      dancing.twist = -20;
      dancing.elbow = 72 - 18 * own;
      pose.arms[side] = mix(pose.arms[side], dancing, std::min(in, 1.0));
    }
  });
}

Poses make_punch(const ProceduralParameters& p, ActionSide which, bool alternate) {
  const double tempo = style_tempo(p.style), period = (alternate ? 0.6 : 0.9) / tempo;
  const double start = 0.9, duration = start + p.count * period + 1.0;
  return make_poses(duration, [&](double t, BodyPose& pose) {
    stagger_feet(pose, 0);
    const double guarded = pulse(t, 0.1, duration - 0.1, 0.7);
    ArmPose guard;
    guard.flex = 38;
    guard.abduct = 10;
    guard.twist = -16;
    guard.elbow = 128;
    for (ArmPose& arm : pose.arms) arm = mix(arm, guard, guarded);
    pose.bend += 7 * guarded;
    pose.pelvis.y() -= 0.03 * guarded;
    const Repetition rep = repetition(t, start, period, p.count);
    if (!rep.active) return;
    const int side =
        alternate ? (static_cast<int>(which) + rep.index) % 2 : static_cast<int>(which);
    const double out = ease(rep.phase, 0.05, 0.38) - ease(rep.phase, 0.46, 0.98);
    ArmPose punch;
    punch.flex = 86;
    punch.across = 2 - 26 * p.amplitude;  // forward in spite of the turned chest
    punch.twist = -45;
    punch.elbow = 7;
    pose.arms[side] = mix(pose.arms[side], punch, out);
    pose.twist -= side_sign(side) * 26 * p.amplitude * out;
    pose.yaw -= side_sign(side) * 7 * out;
    pose.look += side_sign(side) * 26 * p.amplitude * out;
    pose.pelvis.z() += 0.04 * out;
  });
}

}  // namespace remomask::synthetic
