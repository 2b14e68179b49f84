#include "evaluation/side_rule.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "evaluation/word_classes.h"
#include "motion/heading.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "text/words.h"

namespace remomask::evaluation {

namespace {

constexpr double kMinPathRatio = 1.1;
constexpr double kMinTurn = 15 * std::numbers::pi / 180;

bool is_form_of(const std::string& word, const std::set<std::string>& listed) {
  const auto forms = base_forms(word);
  return std::any_of(forms.begin(), forms.end(),
                     [&](const std::string& form) { return listed.contains(form); });
}

int joint_named(const Skeleton& skeleton, const std::string& name) {
  const auto& names = skeleton.joint_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Error("the skeleton '" + skeleton.name + "' has no joint '" + name + "'");
  }
  return static_cast<int>(found - names.begin());
}

/// Length of the wrist's path relative to the shoulder, m.
double wrist_path(const Motion& motion, const Skeleton& skeleton, const std::string& side) {
  const int wrist = joint_named(skeleton, side + "_wrist");
  const int shoulder = joint_named(skeleton, side + "_shoulder");
  const auto offset = [&](int frame) -> Vec3 {
    return joint_position(motion, frame, wrist) - joint_position(motion, frame, shoulder);
  };
  double path = 0;
  for (int frame = 0; frame + 1 < motion.frames; ++frame) {
    path += (offset(frame + 1) - offset(frame)).norm();
  }
  return path;
}

/// Change of the heading in radians; to the left is positive.
double heading_change(const Motion& motion, const Skeleton& skeleton) {
  double change = 0, before = 0;
  for (int frame = 0; frame < motion.frames; ++frame) {
    const Vec3 across = motion::across_body(motion, frame, skeleton);
    // Only differences count: which way `across` points does not matter.
    const double angle = std::atan2(-across.z(), across.x());
    if (frame > 0) change += std::remainder(angle - before, 2 * std::numbers::pi);
    before = angle;
  }
  return change;
}

}  // namespace

std::optional<AskedSide> asked_side(const std::string& caption) {
  static const std::set<std::string> hands = {"hand",  "arm",  "fist", "wrist",
                                              "elbow", "palm", "punch"};
  static const std::set<std::string> legs = {"foot", "feet", "leg", "knee"};
  static const std::set<std::string> turns = {"turn",   "corner", "circle",
                                              "rotate", "spin",   "pivot"};
  const auto words = text::split_words(text::normalise_caption(caption));
  bool left = false, right = false, turning = false, hand = false, other = false;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "both") return std::nullopt;
    if (is_form_of(word, turns)) turning = true;
    const bool is_left = word == "left", is_right = word == "right";
    if (word == "clockwise") right = turning = true;
    if (word == "counterclockwise" || word == "anticlockwise") left = turning = true;
    if (!is_left && !is_right) continue;
    (is_left ? left : right) = true;
    const bool last = i + 1 == words.size();
    if (!last && is_form_of(words[i + 1], hands)) {
      hand = true;
    } else {
      other = true;
      if (!last && is_form_of(words[i + 1], legs)) return std::nullopt;
    }
  }
  if (left == right || (hand && other) || (!hand && !turning)) return std::nullopt;
  return AskedSide{hand ? SideKind::hand : SideKind::turn, left ? Side::left : Side::right};
}

std::optional<Side> shown_side(const Motion& motion, const Skeleton& skeleton, SideKind kind) {
  if (kind == SideKind::turn) {
    const double change = heading_change(motion, skeleton);
    if (std::abs(change) < kMinTurn) return std::nullopt;
    return change > 0 ? Side::left : Side::right;
  }
  const double left = wrist_path(motion, skeleton, "left"),
               right = wrist_path(motion, skeleton, "right");
  if (std::max(left, right) <= kMinPathRatio * std::min(left, right)) return std::nullopt;
  return left > right ? Side::left : Side::right;
}

const char* side_name(Side side) { return side == Side::left ? "left" : "right"; }

void count_side(const std::string& caption, const std::string& shown, SideCounts& counts) {
  const auto asked = asked_side(caption);
  if (!asked) return;
  SideCount& count = asked->kind == SideKind::hand ? counts.hands : counts.turns;
  ++count.asked;
  count.right += shown == side_name(asked->side);
}

std::string shown_side_name(const std::string& caption, const Motion& motion,
                            const Skeleton& skeleton) {
  const auto asked = asked_side(caption);
  if (!asked) return "";
  const auto shown = shown_side(motion, skeleton, asked->kind);
  return shown ? side_name(*shown) : "";
}

SideCounts count_real_sides(const db::Database& database, const std::string& split) {
  SideCounts counts;
  for (const db::Clip& clip : database.clips()) {
    if (clip.split != split || clip.skeleton != humanml_skeleton().name) continue;
    const auto caption =
        std::find_if(clip.captions.begin(), clip.captions.end(),
                     [](const std::string& text) { return asked_side(text).has_value(); });
    if (caption == clip.captions.end()) continue;
    const Motion motion = database.motion(clip.id);
    count_side(*caption, shown_side_name(*caption, motion, humanml_skeleton()), counts);
  }
  return counts;
}

}  // namespace remomask::evaluation
