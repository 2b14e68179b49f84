#include "synthetic/procedural.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/hash.h"
#include "motion/heading.h"
#include "remomask/error.h"

namespace remomask {
namespace {

enum { kRoot = 0, kHead = 15, kShoulder = 16, kWrist = 20, kKnee = 4, kAnkle = 7, kToe = 10 };

const std::vector<synthetic::ProceduralClip>& default_clips() {
  static const std::vector<synthetic::ProceduralClip> clips = synthetic::make_procedural_clips();
  return clips;
}

synthetic::ProceduralClip neutral_clip(const std::string& kind, int count = 1,
                                       double duration = 4) {
  synthetic::ProceduralParameters p;
  p.count = count;
  p.duration = duration;
  p.variation = 7;
  return synthetic::make_procedural_clip(kind, p);
}

std::string positions_hash(const Motion& motion) {
  return content_hash({reinterpret_cast<const char*>(motion.positions.data()),
                       motion.positions.size() * sizeof(float)});
}

/// Degrees turned to the left from the first to the last frame.
double turned_degrees(const Motion& motion) {
  const motion::Headings h =
      motion::find_headings(motion, humanml_skeleton(), motion::FeatureMode::fixed);
  return (h.angles.back() - h.angles.front()) * 180 / std::numbers::pi;
}

Vec3 travelled(const Motion& motion) {
  return joint_position(motion, motion.frames - 1, kRoot) - joint_position(motion, 0, kRoot);
}

double highest(const Motion& motion, int joint) {
  double best = -1e9;
  for (int f = 0; f < motion.frames; ++f)
    best = std::max(best, joint_position(motion, f, joint).y());
  return best;
}

double lowest(const Motion& motion, int joint) {
  double best = 1e9;
  for (int f = 0; f < motion.frames; ++f)
    best = std::min(best, joint_position(motion, f, joint).y());
  return best;
}

/// Lower of the two toes, at the frame where it is highest.
double flight_height(const Motion& motion) {
  double best = 0;
  for (int f = 0; f < motion.frames; ++f) {
    best = std::max(best, std::min(joint_position(motion, f, kToe).y(),
                                   joint_position(motion, f, kToe + 1).y()));
  }
  return best;
}

/// How often `measure(frame)` rises over `high` after having been below `low`.
template <class Measure>
int count_rises(const Motion& motion, Measure&& measure, double low, double high) {
  int rises = 0;
  bool ready = true;
  for (int f = 0; f < motion.frames; ++f) {
    const double value = measure(f);
    if (ready && value > high) {
      ++rises;
      ready = false;
    }
    if (value < low) ready = true;
  }
  return rises;
}

TEST(Procedural, SameSeedSameClipsOtherSeedOtherClips) {
  const auto again = synthetic::make_procedural_clips({70, 1}),
             other = synthetic::make_procedural_clips({70, 2});
  for (size_t i = 0; i < again.size(); ++i) {
    const synthetic::ProceduralClip& first = default_clips()[i];
    EXPECT_EQ(positions_hash(again[i].motion), positions_hash(first.motion)) << first.name;
    EXPECT_EQ(again[i].captions, first.captions);
    EXPECT_EQ(again[i].labels, first.labels);
    EXPECT_NE(positions_hash(other[i].motion), positions_hash(first.motion)) << first.name;
  }
}

TEST(Procedural, DefaultSetHasEveryKindAndUsableSplits) {
  ASSERT_EQ(default_clips().size(), 360u);
  std::set<std::string> kinds, names, motions;
  std::map<std::string, int> splits;
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    kinds.insert(clip.labels.at("content").get<std::string>());
    names.insert(clip.name);
    motions.insert(positions_hash(clip.motion));
    ++splits[clip.split];
    EXPECT_EQ(clip.labels.at("source"), "procedural");
    EXPECT_FALSE(clip.labels.at("actions").empty());
    EXPECT_GE(clip.motion.frames, 40) << clip.name;
    EXPECT_LE(clip.motion.frames, 196) << clip.name;
  }
  EXPECT_EQ(kinds.size(), synthetic::procedural_kinds().size());
  EXPECT_EQ(names.size(), 360u);
  EXPECT_EQ(motions.size(), 360u);
  EXPECT_EQ(splits.size(), 3u);
  EXPECT_NEAR(splits["train"], 288, 25);
  EXPECT_GT(splits["val"], 12);
  EXPECT_GT(splits["test"], 22);
}

TEST(Procedural, BonesKeepTheUniformLengths) {
  const Skeleton& skeleton = humanml_skeleton();
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    double worst = 0;
    for (int f = 0; f < clip.motion.frames; ++f) {
      for (int j = 1; j < skeleton.joints(); ++j) {
        const double length = (joint_position(clip.motion, f, j) -
                               joint_position(clip.motion, f, skeleton.parents[j]))
                                  .norm();
        const double off = std::abs(length - skeleton.bone_lengths[j]);
        worst = std::isfinite(off) ? std::max(worst, off) : 1e9;
      }
    }
    EXPECT_LT(worst, 1e-5) << clip.name;
  }
}

TEST(Procedural, NothingLiesBelowTheFloorAndSomethingTouchesIt) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    double low = 1e9;
    for (int j = 0; j < 22; ++j) low = std::min(low, lowest(clip.motion, j));
    EXPECT_NEAR(low, 0, 1e-5) << clip.name;
  }
}

TEST(Procedural, ToesOnTheFloorDoNotSlide) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    double worst = 0;
    for (int f = 1; f < clip.motion.frames; ++f) {
      for (int toe = kToe; toe <= kToe + 1; ++toe) {
        const Vec3 now = joint_position(clip.motion, f, toe),
                   before = joint_position(clip.motion, f - 1, toe);
        if (now.y() > 0.005 || before.y() > 0.005) continue;
        worst = std::max(worst, std::hypot(now.x() - before.x(), now.z() - before.z()));
      }
    }
    EXPECT_LT(worst, 0.01) << clip.name;
  }
}

TEST(Procedural, JointsStayBelow14MetresASecondAndMoveSmoothly) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    double fastest = 0;
    for (int f = 1; f < clip.motion.frames; ++f) {
      for (int j = 0; j < 22; ++j) {
        fastest = std::max(
            fastest,
            20 *
                (joint_position(clip.motion, f, j) - joint_position(clip.motion, f - 1, j)).norm());
      }
    }
    EXPECT_LT(fastest, 14) << clip.name;
  }
}

TEST(Procedural, KneesNeverBendBackwards) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    int backwards = 0;
    for (int f = 0; f < clip.motion.frames; ++f) {
      for (int side = 0; side < 2; ++side) {
        const Vec3 hip = joint_position(clip.motion, f, 1 + side);
        const Vec3 knee = joint_position(clip.motion, f, kKnee + side);
        const Vec3 ankle = joint_position(clip.motion, f, kAnkle + side);
        // The knee lies in front of the line from hip to ankle, or above it.
        const Vec3 line = (ankle - hip).normalized();
        const Vec3 out = (knee - hip) - line * line.dot(knee - hip);
        const Vec3 right = motion::across_body(clip.motion, f, humanml_skeleton());
        const Vec3 front = Vec3(right.z(), 0, -right.x()).normalized();
        if (out.dot(front + Vec3(0, 0.5, 0)) < -0.02) ++backwards;
      }
    }
    EXPECT_EQ(backwards, 0) << clip.name;
  }
}

TEST(Procedural, StartsAtTheOriginFacingFront) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    const Vec3 root = joint_position(clip.motion, 0, kRoot);
    EXPECT_NEAR(root.x(), 0, 1e-5) << clip.name;
    EXPECT_NEAR(root.z(), 0, 1e-5) << clip.name;
    const Vec3 across = motion::across_body(clip.motion, 0, humanml_skeleton());
    EXPECT_LT(across.x(), 0) << clip.name;  // its right is at -X
    EXPECT_NEAR(across.z(), 0, 1e-4) << clip.name;
  }
}

TEST(Procedural, WalksGoWhereTheySay) {
  for (const char* kind : {"walk-forward", "walk-slow", "walk-fast", "jog", "run", "sprint",
                           "tiptoe", "sneak", "march", "crouch-walk", "limp-left", "step-over"}) {
    synthetic::ProceduralParameters p;
    p.from_stand = true;
    const synthetic::ProceduralClip clip = synthetic::make_procedural_clip(kind, p);
    const double seconds = (clip.motion.frames - 1) / 20.0;
    const double mean = travelled(clip.motion).z() / seconds;
    const double speed = clip.labels["parameters"]["speed"];
    EXPECT_GT(mean, 0.35 * speed) << kind;  // from and to a stand
    EXPECT_LT(mean, speed) << kind;
    EXPECT_LT(std::abs(travelled(clip.motion).x()), 0.1) << kind;
    // In the middle it has full speed, measured over one cycle or so.
    const int middle = clip.motion.frames / 2;
    const double now = (joint_position(clip.motion, middle + 8, kRoot).z() -
                        joint_position(clip.motion, middle - 8, kRoot).z()) /
                       0.8;
    EXPECT_NEAR(now, speed, 0.2 * speed) << kind;
  }
  EXPECT_LT(travelled(neutral_clip("walk-backward").motion).z(), -0.8);
  EXPECT_GT(travelled(neutral_clip("walk-sideways-left").motion).x(), 0.5);
  EXPECT_LT(travelled(neutral_clip("walk-sideways-right").motion).x(), -0.5);
}

TEST(Procedural, ManneredGaitsShowTheirManner) {
  const auto knee = [](const char* kind) { return highest(neutral_clip(kind).motion, kKnee); };
  EXPECT_GT(knee("march"), knee("walk-forward") + 0.12);
  EXPECT_GT(knee("step-over"), knee("walk-forward") + 0.10);
  const Motion tiptoe = neutral_clip("tiptoe").motion;
  EXPECT_GT(
      std::min(joint_position(tiptoe, 40, kAnkle).y(), joint_position(tiptoe, 40, kAnkle + 1).y()),
      0.10);
  EXPECT_LT(joint_position(neutral_clip("crouch-walk").motion, 40, kRoot).y(), 0.75);
}

TEST(Procedural, CutGaitHasItsSpeedThroughout) {
  synthetic::ProceduralParameters p;
  p.from_stand = false;
  p.duration = 8;
  p.speed = 1.2;
  const Motion motion = synthetic::make_procedural_clip("walk-forward", p).motion;
  EXPECT_NEAR(travelled(motion).norm() / ((motion.frames - 1) / 20.0), 1.2, 0.06);
}

TEST(Procedural, TurnsTurnToTheSideTheySay) {
  EXPECT_NEAR(turned_degrees(neutral_clip("turn-90-left").motion), 90, 8);
  EXPECT_NEAR(turned_degrees(neutral_clip("turn-90-right").motion), -90, 8);
  EXPECT_NEAR(turned_degrees(neutral_clip("turn-180-left").motion), 180, 8);
  EXPECT_NEAR(turned_degrees(neutral_clip("turn-360-right").motion), -360, 8);
  EXPECT_NEAR(turned_degrees(neutral_clip("walk-turn-left", 1, 6).motion), 90, 8);
  EXPECT_NEAR(turned_degrees(neutral_clip("walk-turn-right", 1, 6).motion), -90, 8);
  const Motion circle = neutral_clip("walk-circle-left", 1, 8).motion;
  EXPECT_NEAR(turned_degrees(circle), 360, 10);
  EXPECT_LT(travelled(circle).norm(), 0.25);  // it closes
}

TEST(Procedural, NamedHandsGoUpAndTheOthersStayDown) {
  for (const char* action : {"wave", "raise", "walk-wave"}) {
    for (int side = 0; side < 2; ++side) {
      const std::string kind = std::string(action) + (side == 0 ? "-left" : "-right");
      const Motion motion = neutral_clip(kind, 1, 6).motion;
      EXPECT_GT(highest(motion, kWrist + side), highest(motion, kShoulder + side) + 0.1) << kind;
      EXPECT_LT(highest(motion, kWrist + 1 - side), 1.1) << kind;
    }
  }
  for (const char* kind : {"wave-both", "raise-both", "stretch"}) {
    const Motion motion = neutral_clip(kind).motion;
    for (int side = 0; side < 2; ++side) {
      EXPECT_GT(highest(motion, kWrist + side), highest(motion, kShoulder + side) + 0.1) << kind;
    }
  }
  for (const synthetic::ProceduralClip& clip : default_clips()) {  // whatever the style
    if (clip.labels["content"].get<std::string>().rfind("raise-", 0) != 0) continue;
    const double wrist = std::max(highest(clip.motion, kWrist), highest(clip.motion, kWrist + 1));
    EXPECT_GT(wrist, lowest(clip.motion, kHead)) << clip.name;
  }
}

TEST(Procedural, JumpsLeaveTheFloorAsOftenAsTheySay) {
  for (int count : {1, 2, 3}) {
    const Motion motion = neutral_clip("jump-small", count).motion;
    EXPECT_EQ(count_rises(
                  motion,
                  [&](int f) {
                    return std::min(joint_position(motion, f, kToe).y(),
                                    joint_position(motion, f, kToe + 1).y());
                  },
                  0.01, 0.05),
              count);
  }
  EXPECT_NEAR(flight_height(neutral_clip("jump-high").motion), 0.34, 0.03);
  EXPECT_GT(flight_height(neutral_clip("jump-forward").motion), 0.15);
  EXPECT_NEAR(travelled(neutral_clip("jump-forward", 2).motion).z(), 1.8, 0.05);
  EXPECT_LT(travelled(neutral_clip("jump-high").motion).norm(), 0.05);
  EXPECT_EQ(flight_height(neutral_clip("walk-forward").motion) > 0.02, false);
  EXPECT_GT(flight_height(neutral_clip("run").motion), 0.03);
}

TEST(Procedural, RepetitionsAreAsManyAsTheCaptionSays) {
  for (int count : {1, 2, 3}) {
    const Motion squat = neutral_clip("squat", count).motion;
    EXPECT_EQ(count_rises(
                  squat, [&](int f) { return -joint_position(squat, f, kRoot).y(); }, -0.85, -0.65),
              count);
    const Motion kick = neutral_clip("kick-front-right", count).motion;
    EXPECT_EQ(count_rises(
                  kick, [&](int f) { return joint_position(kick, f, kAnkle + 1).y(); }, 0.2, 0.7),
              count);
    EXPECT_LT(highest(kick, kAnkle), 0.15);  // the other foot stays
    const Motion punch = neutral_clip("punch-left", count).motion;
    const auto reach = [&](int f) {
      return (joint_position(punch, f, kWrist) - joint_position(punch, f, kShoulder)).z();
    };
    EXPECT_EQ(count_rises(punch, reach, 0.3, 0.42), count);
    const Motion jacks = neutral_clip("jumping-jacks", count).motion;
    EXPECT_EQ(count_rises(
                  jacks, [&](int f) { return joint_position(jacks, f, kWrist).y(); }, 1.0, 1.6),
              count);
  }
  for (int count : {1, 3, 6}) {
    const Motion clap = neutral_clip("clap", count).motion;
    const auto apart = [&](int f) {
      return (joint_position(clap, f, kWrist) - joint_position(clap, f, kWrist + 1)).x();
    };
    EXPECT_EQ(count_rises(
                  clap, [&](int f) { return -apart(f); }, -0.2, -0.12),
              count);
    for (int f = 0; f < clap.frames; ++f) EXPECT_GT(apart(f), 0.02);  // hands never cross
  }
  for (int count : {1, 2}) {
    const Motion bow = neutral_clip("bow-deep", count).motion;
    EXPECT_EQ(count_rises(
                  bow, [&](int f) { return -joint_position(bow, f, kHead).y(); }, -1.4, -1.15),
              count);
  }
}

TEST(Procedural, SittingEndsLowAndStandingUpEndsHigh) {
  const Motion sit = neutral_clip("sit-down").motion,
               stand = neutral_clip("sit-stand", 1, 6).motion;
  EXPECT_LT(joint_position(sit, sit.frames - 1, kRoot).y(), 0.65);
  EXPECT_LT(lowest(stand, kRoot), 0.65);
  EXPECT_GT(joint_position(stand, stand.frames - 1, kRoot).y(), 0.88);
}

TEST(Procedural, LeftAndRightAreMirrorImagesUpToTheUnequalBones) {
  const Skeleton& skeleton = humanml_skeleton();
  for (const char* action :
       {"wave", "raise", "point", "throw", "kick-front", "kick-side", "walk-sideways", "turn-90"}) {
    const Motion left = neutral_clip(std::string(action) + "-left").motion;
    const Motion right = neutral_clip(std::string(action) + "-right").motion;
    ASSERT_EQ(left.frames, right.frames);
    double worst = 0;
    for (int f = 0; f < left.frames; ++f) {
      for (int j = 0; j < 22; ++j) {
        Vec3 mirrored = joint_position(right, f, skeleton.mirror[j]);
        mirrored.x() = -mirrored.x();
        worst = std::max(worst, (joint_position(left, f, j) - mirrored).norm());
      }
    }
    EXPECT_LT(worst, 0.15) << action;
  }
}

TEST(Procedural, CaptionsNameTheirSideAndNoOther) {
  for (const synthetic::ProceduralClip& clip : default_clips()) {
    EXPECT_GE(clip.captions.size(), 3u);
    EXPECT_LE(clip.captions.size(), 4u);
    EXPECT_EQ(std::set<std::string>(clip.captions.begin(), clip.captions.end()).size(),
              clip.captions.size())
        << clip.name;
    const auto& parameters = clip.labels.at("parameters");
    const std::string side = parameters.value("side", "");
    for (const std::string& caption : clip.captions) {
      EXPECT_EQ(caption.find_first_of("{}[]"), std::string::npos) << caption;
      EXPECT_EQ(caption.back(), '.');
      if (side.empty()) continue;
      EXPECT_NE(caption.find(side), std::string::npos) << caption;
      EXPECT_EQ(caption.find(side == "left" ? "right" : "left"), std::string::npos) << caption;
    }
  }
}

TEST(Procedural, StylesShow) {
  synthetic::ProceduralParameters p;
  const Motion upright = synthetic::make_procedural_clip("stand", p).motion;
  p.style = "old";
  const synthetic::ProceduralClip old = synthetic::make_procedural_clip("stand", p);
  EXPECT_LT(joint_position(old.motion, 20, kHead).y(),
            joint_position(upright, 20, kHead).y() - 0.05);
  const std::string& caption = old.captions[0];
  EXPECT_TRUE(caption.find("old person") != std::string::npos ||
              caption.find("elderly person") != std::string::npos)
      << caption;
}

TEST(Procedural, WrongRequestsAreToldApart) {
  synthetic::ProceduralParameters p;
  EXPECT_THROW(synthetic::make_procedural_clip("fly", p), Error);
  p.style = "happy";
  EXPECT_THROW(synthetic::make_procedural_clip("stand", p), Error);
  p.style = "old";
  EXPECT_THROW(synthetic::make_procedural_clip("sprint", p), Error);  // has no styles
  p.style = "neutral";
  p.count = 4;
  EXPECT_THROW(synthetic::make_procedural_clip("squat", p), Error);
  p.count = 1;
  p.amplitude = 3;
  EXPECT_THROW(synthetic::make_procedural_clip("squat", p), Error);
}

}  // namespace
}  // namespace remomask
