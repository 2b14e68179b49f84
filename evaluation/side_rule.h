#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "db/database.h"
#include "remomask/motion.h"

namespace remomask::evaluation {

enum class Side { left, right };
enum class SideKind { hand, turn };

/// What a caption asks for when it names one side.
struct AskedSide {
  SideKind kind = SideKind::hand;
  Side side = Side::left;
};

/// "left" or "right" (not both, nor "both") before hand, arm, fist, wrist, elbow,
/// palm or punch asks for that hand; in a sentence about turning (turn, corner,
/// circle, rotate, spin, pivot) for that turn, unless a leg follows; "clockwise"
/// is a turn to the right. Nothing for every other caption.
std::optional<AskedSide> asked_side(const std::string& caption);

/// Which side a motion shows. hand: the wrist whose path relative to its shoulder
/// is longer, by a tenth at least. turn: the sign of the heading's change from
/// the first to the last frame (hips and shoulders seen from above, unwrapped),
/// of 15 degrees at least. Nothing below these bounds.
std::optional<Side> shown_side(const Motion& motion, const Skeleton& skeleton, SideKind kind);

const char* side_name(Side side);

/// Motions whose caption names one side, and how many show it.
struct SideCount {
  int asked = 0, right = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SideCount, asked, right)

struct SideCounts {
  SideCount hands, turns;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SideCounts, hands, turns)

/// Counts one motion of a caption; `shown` is side_name() of what it shows, or "".
void count_side(const std::string& caption, const std::string& shown, SideCounts& counts);

/// side_name() of what a motion shows of what its caption asks for; "" when that
/// is nothing.
std::string shown_side_name(const std::string& caption, const Motion& motion,
                            const Skeleton& skeleton);

/// The rule on the real clips of a split, each with its first caption that asks
/// for a side: how far the rule (and the captions) can be trusted.
SideCounts count_real_sides(const db::Database& database, const std::string& split);

}  // namespace remomask::evaluation
