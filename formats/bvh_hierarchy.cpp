#include "formats/bvh_hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxBvhJoints = 10000;
constexpr size_t kMaxRenamingWarnings = 5;
constexpr int kChannelKinds = 6, kMaxChannels = 9;
constexpr std::string_view kChannelNames[] = {"Xposition", "Yposition", "Zposition",
                                              "Xrotation", "Yrotation", "Zrotation",
                                              "Xscale",    "Yscale",    "Zscale"};

/// `name`, or what Blender would call a second and third of this name: "name.001".
std::string unused_name(const std::string& name, std::unordered_set<std::string>& taken) {
  if (taken.insert(name).second) return name;
  for (int i = 1;; ++i) {
    std::string candidate = fmt::format("{}.{:03}", name, i);
    if (taken.insert(candidate).second) return candidate;
  }
}

}  // namespace

void BvhHierarchy::parse() {
  if (!scanner_.skip_blank_lines()) scanner_.fail("the file is empty; export it again");
  if (!same_word(scanner_.next_word(), "HIERARCHY")) {
    scanner_.fail("a BVH file starts with HIERARCHY; this is another format");
  }
  while (true) {
    const std::string_view word = scanner_.next_word();
    if (same_word(word, "ROOT")) {
      read_skeleton();
    } else if (word.empty() && skeletons_.empty()) {
      scanner_.fail("the file ends where \"ROOT\" was expected; it is truncated, export it again");
    } else if (word.empty()) {
      scanner_.fail("there is no MOTION section; the file is truncated or a rest pose only");
    } else if (same_word(word, "MOTION") && !skeletons_.empty()) {
      break;
    } else {
      scanner_.fail(fmt::format("expected \"ROOT\"{} after HIERARCHY, found {}",
                                skeletons_.empty() ? "" : " or \"MOTION\"", in_quotes(word)));
    }
  }
  keep_skeleton(chosen_skeleton());
  rename_duplicates();
  warn_of_scales();
}

void BvhHierarchy::read_skeleton() {
  const size_t first = joints_.size();
  const long line = scanner_.line();
  open_joint(-1);
  std::vector<int> open = {static_cast<int>(first)};
  while (!open.empty()) {
    const int joint = open.back();
    const std::string_view word = scanner_.next_word();
    if (same_word(word, "OFFSET")) {
      BvhJoint& moved = joints_[static_cast<size_t>(joint)];
      for (int axis = 0; axis < 3; ++axis) moved.offset[axis] = scanner_.read_number("OFFSET");
      has_offset_[static_cast<size_t>(joint)] = true;
    } else if (same_word(word, "CHANNELS")) {
      read_channels(joint);
    } else if (same_word(word, "JOINT")) {
      require_offset(joint);
      open.push_back(static_cast<int>(joints_.size()));
      open_joint(joint);
    } else if (same_word(word, "End") || same_word(word, "EndSite")) {
      require_offset(joint);
      read_end_site(joint);
    } else if (word == "}") {
      require_offset(joint);
      open.pop_back();
    } else if (word.empty()) {
      scanner_.fail("the file ends inside the hierarchy; it is truncated, export it again");
    } else {
      scanner_.fail(
          fmt::format("expected OFFSET, CHANNELS, JOINT, End Site or a closing brace, found {}",
                      in_quotes(word)));
    }
  }
  std::unordered_set<std::string> labels;
  for (const Skeleton& skeleton : skeletons_) labels.insert(skeleton.label);
  skeletons_.push_back({first, joints_.size(), unused_name(joints_[first].name, labels), line});
}

void BvhHierarchy::open_joint(int parent) {
  const std::string_view name = scanner_.rest_of_line();
  if (name.empty()) scanner_.fail("a joint has no name; give every joint a name of its own");
  if (joints_.size() >= kMaxBvhJoints) {
    scanner_.fail(
        fmt::format("more than {} joints; this is not a motion capture file", kMaxBvhJoints));
  }
  BvhJoint joint;
  joint.name = name;
  joint.parent = parent;
  lines_.push_back(scanner_.line());
  has_offset_.push_back(false);
  has_channels_.push_back(false);
  joints_.push_back(std::move(joint));
  scanner_.expect("{", "after the joint's name");
}

void BvhHierarchy::require_offset(int joint) {
  const auto j = static_cast<size_t>(joint);
  if (has_offset_[j]) return;
  scanner_.fail(
      fmt::format("expected \"OFFSET\" after the opening brace of {}", in_quotes(joints_[j].name)));
}

void BvhHierarchy::read_channels(int joint) {
  const auto j = static_cast<size_t>(joint);
  const std::string name = in_quotes(joints_[j].name);
  if (has_channels_[j]) scanner_.fail(fmt::format("{} has two CHANNELS lines", name));
  has_channels_[j] = true;
  // Columns follow the order of the CHANNELS lines; a joint whose children came first would be read
  // against the order of the frames.
  if (j + 1 != joints_.size()) scanner_.fail("CHANNELS must come before the joint's children");
  const double count = scanner_.read_number("CHANNELS");
  if (count != std::floor(count) || count < 0 || count > kMaxChannels) {
    scanner_.fail(
        fmt::format("a joint has 0 to {} channels, {} asks for {}", kMaxChannels, name, count));
  }
  std::vector<bool> seen(kMaxChannels, false);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const std::string_view word = scanner_.next_word();
    size_t channel = 0;
    while (channel < kMaxChannels && !same_word(kChannelNames[channel], word)) ++channel;
    if (channel == kMaxChannels) {
      scanner_.fail(
          fmt::format("unknown channel {}; BVH knows Xposition, Yposition, Zposition, Xrotation, "
                      "Yrotation, Zrotation (and Xscale, Yscale, Zscale, which are left out)",
                      in_quotes(word)));
    }
    if (seen[channel]) {
      scanner_.fail(fmt::format("channel {} of {} is listed twice", shown_text(word), name));
    }
    seen[channel] = true;
    const bool is_scale = channel >= kChannelKinds;
    if (!is_scale) joints_[j].channels.push_back(static_cast<BvhChannel>(channel));
    if (is_scale && first_scale_line_ == 0) first_scale_line_ = scanner_.line();
    column_joints_.push_back(joint);
    used_.push_back(!is_scale);
  }
}

/// What stands between End and the brace is a name that some programs write, or nothing.
void BvhHierarchy::read_end_site(int joint) {
  scanner_.rest_of_line();
  scanner_.expect("{", "after End Site");
  scanner_.expect("OFFSET", "after the opening brace of the End Site");
  Vec3 end_site;
  for (int axis = 0; axis < 3; ++axis) end_site[axis] = scanner_.read_number("OFFSET");
  std::string_view word = scanner_.next_word();
  if (same_word(word, "CHANNELS")) {
    if (scanner_.read_number("CHANNELS") != 0) scanner_.fail("an End Site has no channels");
    word = scanner_.next_word();
  }
  if (word.empty()) {
    scanner_.fail("the file ends inside the hierarchy; it is truncated, export it again");
  }
  if (word != "}") {
    scanner_.fail(
        fmt::format("expected \"}}\" after the End Site's OFFSET, found {}", in_quotes(word)));
  }
  BvhJoint& ended = joints_[static_cast<size_t>(joint)];
  if (!ended.end_site) ended.end_site = end_site;
}

std::string BvhHierarchy::root_list() const {
  std::vector<std::string> labels;
  for (const Skeleton& skeleton : skeletons_) labels.push_back(in_quotes(skeleton.label));
  return fmt::format("{}", fmt::join(labels, ", "));
}

const BvhHierarchy::Skeleton& BvhHierarchy::chosen_skeleton() const {
  if (root_.empty()) {
    if (skeletons_.size() == 1) return skeletons_[0];
    throw FileError(scanner_.path(), skeletons_[1].line,
                    fmt::format("a second ROOT: the file holds {} skeletons, with the roots {}; "
                                "choose one with --root NAME",
                                skeletons_.size(), root_list()));
  }
  const auto chosen = std::find_if(skeletons_.begin(), skeletons_.end(),
                                   [&](const Skeleton& other) { return other.label == root_; });
  if (chosen != skeletons_.end()) return *chosen;
  throw FileError(scanner_.path(), 0,
                  fmt::format("has no skeleton with the root {}; the roots are {}",
                              in_quotes(root_), root_list()));
}

void BvhHierarchy::keep_skeleton(const Skeleton& kept) {
  for (size_t column = 0; column < used_.size(); ++column) {
    const auto joint = static_cast<size_t>(column_joints_[column]);
    if (joint < kept.first || joint >= kept.last) used_[column] = false;
  }
  joints_ = {std::make_move_iterator(joints_.begin() + static_cast<long>(kept.first)),
             std::make_move_iterator(joints_.begin() + static_cast<long>(kept.last))};
  lines_ = {lines_.begin() + static_cast<long>(kept.first),
            lines_.begin() + static_cast<long>(kept.last)};
  int channels = 0;
  for (BvhJoint& joint : joints_) {
    if (joint.parent >= 0) joint.parent -= static_cast<int>(kept.first);
    joint.first_channel = channels;
    channels += static_cast<int>(joint.channels.size());
  }
}

void BvhHierarchy::rename_duplicates() {
  // Names that are there already stay what they are.
  std::unordered_set<std::string> all, taken;
  for (const BvhJoint& joint : joints_) all.insert(joint.name);
  size_t renamed = 0;
  for (size_t j = 0; j < joints_.size(); ++j) {
    std::string& name = joints_[j].name;
    if (taken.insert(name).second) continue;
    const std::string before = name;
    name = unused_name(before, all);
    taken.insert(name);
    if (++renamed > kMaxRenamingWarnings) continue;
    scanner_.warn(lines_[j], fmt::format("a second joint is named {}; it is called {} here",
                                         in_quotes(before), in_quotes(name)));
  }
  if (renamed > kMaxRenamingWarnings) {
    scanner_.warn(0, fmt::format("{} more joints that share a name are renamed in the same way",
                                 renamed - kMaxRenamingWarnings));
  }
}

void BvhHierarchy::warn_of_scales() {
  if (first_scale_line_ == 0) return;
  scanner_.warn(first_scale_line_, "the scale channels of the file are left out");
}

bool BvhHierarchy::all_columns_used() const {
  return std::all_of(used_.begin(), used_.end(), [](bool used) { return used; });
}

}  // namespace remomask::formats
