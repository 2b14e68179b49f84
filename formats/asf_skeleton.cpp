#include "formats/asf_skeleton.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formats/acclaim_lines.h"
#include "formats/bvh_scanner.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxAsfBones = 10'000;

std::optional<AsfChannel> asf_channel(std::string_view word) {
  static constexpr std::string_view kNames[] = {"rx", "ry", "rz", "tx", "ty", "tz", "l"};
  for (size_t i = 0; i < std::size(kNames); ++i) {
    if (same_word(word, kNames[i])) return static_cast<AsfChannel>(i);
  }
  return std::nullopt;
}

/// Reads the sections of an .asf file, which begin with a word behind a colon.
class AsfParser {
 public:
  AsfParser(std::string_view text, const std::string& path) : lines_(text, path) {}

  AsfSkeleton parse() {
    AsfBone root;
    root.name = "root";
    bones_.push_back(root);
    parents_.push_back(-1);
    while (lines_.next()) read_section_line();
    if (bones_.size() < 2) lines_.fail("the skeleton has no bones; this is no .asf file");
    return sorted();
  }

 private:
  void read_section_line() {
    const std::vector<std::string_view>& words = lines_.words();
    if (words[0].starts_with(':')) {
      section_ = words[0];
      if (same_word(section_, ":root")) {
        read_root();
      } else if (same_word(section_, ":bonedata")) {
        read_bones();
      } else if (same_word(section_, ":hierarchy")) {
        read_hierarchy();
      }
    } else if (same_word(section_, ":units")) {
      read_unit();
    }
  }

  /// The next line of the section; false at its end.
  bool next_in_section() {
    if (!lines_.next()) return false;
    if (!lines_.words()[0].starts_with(':')) return true;
    lines_.unread();
    return false;
  }

  void read_unit() {
    const std::vector<std::string_view>& words = lines_.words();
    if (same_word(words[0], "length") && words.size() > 1) {
      result_.length_unit = lines_.number(1, "length");
      if (!(result_.length_unit > 0)) lines_.fail("the unit of lengths must be above zero");
    } else if (same_word(words[0], "angle") && words.size() > 1) {
      if (!words[1].empty() && (words[1][0] == 'r' || words[1][0] == 'R')) result_.degrees = false;
    }
  }

  void read_root() {
    std::array<double, 3> orientation{};
    std::string order = "XYZ";
    while (next_in_section()) {
      const std::vector<std::string_view>& words = lines_.words();
      if (same_word(words[0], "order")) {
        bones_[0].channels = channels_of(words);
      } else if (same_word(words[0], "axis") && words.size() > 1) {
        order = words[1];
      } else if (same_word(words[0], "position")) {
        for (size_t i = 0; i < 3; ++i) {
          result_.position[static_cast<long>(i)] = lines_.number(i + 1, "position");
        }
      } else if (same_word(words[0], "orientation")) {
        for (size_t i = 0; i < 3; ++i) orientation[i] = lines_.number(i + 1, "orientation");
      }
    }
    bones_[0].axes = axes_of(orientation, order);
  }

  void read_bones() {
    while (next_in_section()) {
      if (!same_word(lines_.words()[0], "begin")) {
        lines_.fail(
            fmt::format("expected \"begin\" of a bone, found {}", in_quotes(lines_.words()[0])));
      }
      read_bone();
    }
  }

  void read_bone() {
    AsfBone bone;
    Vec3 direction = Vec3::Zero();
    double length = 0;
    while (true) {
      if (!lines_.next()) lines_.fail("the file ends inside a bone; it is truncated");
      const std::vector<std::string_view>& words = lines_.words();
      if (same_word(words[0], "end")) break;
      if (same_word(words[0], "name") && words.size() > 1) {
        bone.name = words[1];
      } else if (same_word(words[0], "direction")) {
        for (size_t i = 0; i < 3; ++i) {
          direction[static_cast<long>(i)] = lines_.number(i + 1, "direction");
        }
      } else if (same_word(words[0], "length")) {
        length = lines_.number(1, "length");
      } else if (same_word(words[0], "axis")) {
        std::array<double, 3> angles{};
        for (size_t i = 0; i < 3; ++i) angles[i] = lines_.number(i + 1, "axis");
        bone.axes = axes_of(angles, words.size() > 4 ? std::string(words[4]) : "XYZ");
      } else if (same_word(words[0], "dof")) {
        bone.channels = channels_of(words);
      }
    }
    if (bone.name.empty()) lines_.fail("a bone has no name");
    if (bones_.size() >= kMaxAsfBones) lines_.fail("more bones than a body can have");
    if (direction.norm() > 0) bone.tip = length * direction.normalized();
    if (number_of(bone.name) >= 0) {
      lines_.fail(fmt::format("two bones are named {}; names must differ", in_quotes(bone.name)));
    }
    result_.numbers.emplace(bone.name, static_cast<int>(bones_.size()));
    bones_.push_back(std::move(bone));
    parents_.push_back(-1);
  }

  void read_hierarchy() {
    while (next_in_section()) {
      const std::vector<std::string_view>& words = lines_.words();
      if (same_word(words[0], "begin")) continue;
      if (same_word(words[0], "end")) continue;
      const int parent = known_bone(words[0]);
      for (size_t i = 1; i < words.size(); ++i) {
        const int child = known_bone(words[i]);
        if (child == 0 || parents_[static_cast<size_t>(child)] >= 0) {
          lines_.fail(fmt::format("{} has two parents", in_quotes(words[i])));
        }
        parents_[static_cast<size_t>(child)] = parent;
      }
    }
  }

  int number_of(const std::string& name) const {
    if (name == "root") return 0;
    const auto place = result_.numbers.find(name);
    return place == result_.numbers.end() ? -1 : place->second;
  }

  int known_bone(std::string_view name) const {
    const int number = number_of(std::string(name));
    if (number < 0) lines_.fail(fmt::format("there is no bone {}", in_quotes(name)));
    return number;
  }

  std::vector<AsfChannel> channels_of(const std::vector<std::string_view>& words) const {
    std::vector<AsfChannel> channels;
    for (size_t i = 1; i < words.size(); ++i) {
      const std::optional<AsfChannel> channel = asf_channel(words[i]);
      if (!channel) {
        lines_.fail(fmt::format("unknown degree of freedom {}; known are rx, ry, rz, tx, ty, tz, l",
                                in_quotes(words[i])));
      }
      channels.push_back(*channel);
    }
    return channels;
  }

  /// The first letter of the order is the first rotation that is applied.
  Quat axes_of(const std::array<double, 3>& angles, const std::string& order) const {
    const double unit = result_.degrees ? std::numbers::pi / 180 : 1;
    Quat rotation = Quat::Identity();
    if (order.size() != 3) lines_.fail(fmt::format("unknown order of axes {}", in_quotes(order)));
    for (size_t i = 0; i < 3; ++i) {
      const char axis = static_cast<char>(std::toupper(static_cast<unsigned char>(order[i])));
      if (axis < 'X' || axis > 'Z') {
        lines_.fail(fmt::format("unknown order of axes {}", in_quotes(order)));
      }
      rotation = asf_rotation(static_cast<AsfChannel>(axis - 'X'), angles[i] * unit) * rotation;
    }
    return rotation;
  }

  /// Bones that hang on the root, parents first.
  AsfSkeleton sorted() {
    std::vector<std::vector<size_t>> children(bones_.size());
    for (size_t b = 1; b < bones_.size(); ++b) {
      if (parents_[b] >= 0) children[static_cast<size_t>(parents_[b])].push_back(b);
    }
    std::vector<size_t> open = {0};
    std::vector<int> place(bones_.size(), -1);
    result_.numbers.clear();
    while (!open.empty()) {
      const size_t b = open.back();
      open.pop_back();
      place[b] = static_cast<int>(result_.bones.size());
      AsfBone bone = bones_[b];
      bone.parent = parents_[b] < 0 ? -1 : place[static_cast<size_t>(parents_[b])];
      result_.numbers.emplace(bone.name, place[b]);
      result_.bones.push_back(std::move(bone));
      open.insert(open.end(), children[b].rbegin(), children[b].rend());
    }
    for (size_t b = 1; b < bones_.size(); ++b) {
      if (place[b] < 0) {
        lines_.fail(fmt::format("the bone {} hangs on no other in the section :hierarchy",
                                in_quotes(bones_[b].name)));
      }
    }
    return std::move(result_);
  }

  AcclaimLines lines_;
  std::string section_;
  AsfSkeleton result_;
  std::vector<AsfBone> bones_;
  std::vector<int> parents_;
};

}  // namespace

Quat asf_rotation(AsfChannel channel, double angle) {
  const Vec3 axis = channel == AsfChannel::rotate_x   ? Vec3::UnitX()
                    : channel == AsfChannel::rotate_y ? Vec3::UnitY()
                                                      : Vec3::UnitZ();
  return Quat(Eigen::AngleAxisd(angle, axis));
}

AsfSkeleton parse_asf(std::string_view text, const std::string& path) {
  return AsfParser(text, path).parse();
}

}  // namespace remomask::formats
