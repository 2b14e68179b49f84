#include "evaluation/side_rule.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/evaluation/evaluator_test_tools.h"

namespace remomask {
namespace {

std::string asked_text(const std::string& caption) {
  const auto asked = evaluation::asked_side(caption);
  if (!asked) return "nothing";
  return std::string(asked->kind == evaluation::SideKind::hand ? "hand " : "turn ") +
         evaluation::side_name(asked->side);
}

TEST(AskedSide, OfCaptions) {
  EXPECT_EQ(asked_text("A person waves with the LEFT hand."), "hand left");
  EXPECT_EQ(asked_text("lift your right arm, then lower the right arm"), "hand right");
  EXPECT_EQ(asked_text("throw two right punches"), "hand right");
  EXPECT_EQ(asked_text("someone turns left and keeps walking"), "turn left");
  EXPECT_EQ(asked_text("a walk around a corner to the right"), "turn right");
  EXPECT_EQ(asked_text("spinning counterclockwise"), "turn left");
  EXPECT_EQ(asked_text("a person turns clockwise"), "turn right");
  EXPECT_EQ(asked_text("turns around and waves the right hand"), "hand right");
  for (const char* caption :
       {"a person walks", "walks diagonally to the left", "kicks with the right leg while turning",
        "waves the left hand, then the right hand", "both hands, the left arm first",
        "turns left and waves with the left hand", "the lefthand side"}) {
    EXPECT_EQ(asked_text(caption), "nothing") << caption;
  }
}

/// Turns the body around +Y by `degrees` over all frames; to the left is positive.
Motion turning_body(double degrees) {
  Motion motion = standing_body(20);
  for (int frame = 0; frame < motion.frames; ++frame) {
    const double angle = degrees * std::numbers::pi / 180 * frame / (motion.frames - 1);
    const Quat turn(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    for (int joint = 0; joint < motion.joints; ++joint) {
      set_joint_position(motion, frame, joint, turn * joint_position(motion, frame, joint));
    }
  }
  return motion;
}

std::string shown_text(const Motion& motion, evaluation::SideKind kind) {
  const auto shown = evaluation::shown_side(motion, humanml_skeleton(), kind);
  return shown ? evaluation::side_name(*shown) : "none";
}

TEST(ShownSide, OfTurns) {
  EXPECT_EQ(shown_text(turning_body(90), evaluation::SideKind::turn), "left");
  EXPECT_EQ(shown_text(turning_body(-90), evaluation::SideKind::turn), "right");
  EXPECT_EQ(shown_text(turning_body(350), evaluation::SideKind::turn),
            "left");  // not a turn by -10
  EXPECT_EQ(shown_text(turning_body(-720), evaluation::SideKind::turn), "right");
  EXPECT_EQ(shown_text(turning_body(10), evaluation::SideKind::turn), "none");
}

TEST(ShownSide, OfHands) {
  // The wrists go with the body: neither moves relative to its shoulder by itself.
  EXPECT_EQ(shown_text(standing_body(10), evaluation::SideKind::hand), "none");
  EXPECT_EQ(shown_text(turning_body(90), evaluation::SideKind::hand), "none");
  Motion motion = turning_body(90);
  for (int frame = 0; frame < motion.frames; ++frame) {
    motion.at(frame, 21)[1] += 0.1f * static_cast<float>(frame % 2);
  }
  EXPECT_EQ(shown_text(motion, evaluation::SideKind::hand), "right");
  for (int frame = 0; frame < motion.frames; ++frame) {
    motion.at(frame, 20)[1] += 0.2f * static_cast<float>(frame % 2);
  }
  EXPECT_EQ(shown_text(motion, evaluation::SideKind::hand), "left");
  EXPECT_EQ(evaluation::shown_side_name("the right hand", motion, humanml_skeleton()), "left");
  EXPECT_EQ(evaluation::shown_side_name("walks", motion, humanml_skeleton()), "");
}

TEST(SideCounts, CountWhatIsAsked) {
  evaluation::SideCounts counts;
  count_side("waves the left hand", "left", counts);
  count_side("waves the left hand", "right", counts);
  count_side("turns right", "", counts);
  count_side("walks", "left", counts);
  EXPECT_EQ(counts.hands.asked, 2);
  EXPECT_EQ(counts.hands.right, 1);
  EXPECT_EQ(counts.turns.asked, 1);
  EXPECT_EQ(counts.turns.right, 0);
}

}  // namespace
}  // namespace remomask
