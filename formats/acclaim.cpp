#include "formats/acclaim.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numbers>

#include "base/bounded_file.h"
#include "formats/acclaim_lines.h"
#include "formats/asf_skeleton.h"
#include "formats/bvh_scanner.h"
#include "formats/motion_reading.h"
#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::formats {

namespace {

namespace fs = std::filesystem;

constexpr double kMetresPerInch = 0.0254;
/// Joints times frames; more would take more than a gigabyte.
constexpr size_t kMaxJointFrames = size_t{1} << 25;

/// Reads the frames of an .amc file: a line with the number of the frame, then a line a bone.
class AmcParser {
 public:
  AmcParser(const AsfSkeleton& skeleton, std::string_view text, const std::string& path)
      : skeleton_(skeleton), lines_(text, path), path_(path), degrees_(skeleton.degrees) {}

  AcclaimMotion parse() {
    describe_joints();
    while (lines_.next()) {
      const std::string_view word = lines_.words()[0];
      if (word.starts_with(':')) {
        read_keyword(word);
      } else if (is_frame_number()) {
        finish_frame();
        begin_frame();
      } else if (result_.source.frames == 0) {
        lines_.fail(fmt::format("expected the number of a frame, found {}", in_quotes(word)));
      } else {
        read_bone(word);
      }
    }
    finish_frame();
    if (result_.source.frames == 0) lines_.fail("there are no frames in it");
    if (stretched_) warn("changes of the bones' lengths (degree of freedom \"l\") are left out");
    return std::move(result_);
  }

 private:
  void warn(const std::string& message) {
    result_.warnings.emplace_back(FileError(path_, 0, message).what());
  }

  void describe_joints() {
    rig::SourceMotion& source = result_.source;
    std::vector<bool> has_child(skeleton_.bones.size(), false);
    for (const AsfBone& bone : skeleton_.bones) {
      if (bone.parent >= 0) has_child[static_cast<size_t>(bone.parent)] = true;
    }
    for (size_t b = 0; b < skeleton_.bones.size(); ++b) {
      const AsfBone& bone = skeleton_.bones[b];
      rig::SourceJoint joint;
      joint.name = bone.name;
      joint.parent = bone.parent;
      // A joint is where its bone starts: at the tip of the bone before it.
      joint.offset = bone.parent < 0 ? skeleton_.position
                                     : skeleton_.bones[static_cast<size_t>(bone.parent)].tip;
      if (bone.parent < 0) joint.rotation = bone.axes;
      if (!has_child[b] && bone.tip.norm() > 0) joint.end_site = bone.tip;
      source.joints.push_back(joint);
    }
    if (skeleton_.length_unit != 1) source.metres_per_unit = kMetresPerInch / skeleton_.length_unit;
  }

  void read_keyword(std::string_view word) {
    if (same_word(word, ":RADIANS")) degrees_ = false;
    if (same_word(word, ":DEGREES")) degrees_ = true;
    if (same_word(word, ":SAMPLES-PER-SECOND")) {
      result_.source.fps = lines_.number(1, "SAMPLES-PER-SECOND");
      if (!(result_.source.fps > 0)) lines_.fail("the frame rate must be above zero");
    }
  }

  bool is_frame_number() const {
    const std::string_view word = lines_.words()[0];
    return lines_.words().size() == 1 &&
           std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
  }

  void begin_frame() {
    rig::SourceMotion& source = result_.source;
    const size_t joints = skeleton_.bones.size();
    if ((static_cast<size_t>(source.frames) + 1) * joints > kMaxJointFrames) {
      lines_.fail("the motion is too long to be read at once; cut it into shorter clips");
    }
    ++source.frames;
    seen_.assign(joints, false);
    for (const rig::SourceJoint& joint : source.joints) {
      append_pose(joint.rotation, joint.offset);
    }
  }

  void append_pose(const Quat& rotation, const Vec3& translation) {
    rig::SourceMotion& source = result_.source;
    source.rotations.resize(source.rotations.size() + 4);
    source.translations.resize(source.translations.size() + 3);
    set_pose(source.translations.size() / 3 - 1, rotation, translation);
  }

  void set_pose(size_t place, const Quat& rotation, const Vec3& translation) {
    float* q = result_.source.rotations.data() + 4 * place;
    float* t = result_.source.translations.data() + 3 * place;
    for (long i = 0; i < 4; ++i) q[i] = static_cast<float>(rotation.coeffs()[i]);
    for (long i = 0; i < 3; ++i) t[i] = static_cast<float>(translation[i]);
  }

  void finish_frame() {
    if (result_.source.frames == 0) return;
    for (size_t b = 0; b < skeleton_.bones.size(); ++b) {
      if (seen_[b] || skeleton_.bones[b].channels.empty()) continue;
      lines_.fail(
          fmt::format("the frame before this line has no values of {}; the file is "
                      "truncated or belongs to another .asf",
                      in_quotes(skeleton_.bones[b].name)));
    }
  }

  void read_bone(std::string_view name) {
    const auto found = skeleton_.numbers.find(std::string(name));
    if (found == skeleton_.numbers.end()) {
      lines_.fail(
          fmt::format("the skeleton has no bone {}; is this its .asf file?", in_quotes(name)));
    }
    const auto b = static_cast<size_t>(found->second);
    const AsfBone& bone = skeleton_.bones[b];
    if (seen_[b]) lines_.fail(fmt::format("{} is there twice in a frame", in_quotes(name)));
    seen_[b] = true;
    if (lines_.words().size() - 1 != bone.channels.size()) {
      lines_.fail(fmt::format("{} has {} values, its skeleton has {} degrees of freedom",
                              in_quotes(name), lines_.words().size() - 1, bone.channels.size()));
    }
    const double unit = degrees_ ? std::numbers::pi / 180 : 1;
    Quat turn = Quat::Identity();
    Vec3 move = Vec3::Zero();
    for (size_t i = 0; i < bone.channels.size(); ++i) {
      const double value = lines_.number(i + 1, name);
      const AsfChannel channel = bone.channels[i];
      if (channel <= AsfChannel::rotate_z) {
        turn = asf_rotation(channel, value * unit) * turn;
      } else if (channel <= AsfChannel::move_z) {
        move[static_cast<int>(channel) - static_cast<int>(AsfChannel::move_x)] += value;
      } else {
        stretched_ = true;
      }
    }
    const rig::SourceJoint& joint = result_.source.joints[b];
    // The root's axes are its first heading, those of other bones only what they turn about.
    const Quat rotation =
        bone.parent < 0 ? bone.axes * turn : bone.axes * turn * bone.axes.inverse();
    set_pose((static_cast<size_t>(result_.source.frames) - 1) * skeleton_.bones.size() + b,
             rotation.normalized(), joint.offset + move);
  }

  const AsfSkeleton& skeleton_;
  AcclaimLines lines_;
  const std::string& path_;
  bool degrees_;
  bool stretched_ = false;
  std::vector<bool> seen_;  ///< bones of the frame
  AcclaimMotion result_;
};

bool is_asf(const fs::path& path) { return same_word(path.extension().string(), ".asf"); }

}  // namespace

std::string find_asf(const std::string& amc_path) {
  const fs::path amc(amc_path);
  const fs::path folder = amc.has_parent_path() ? amc.parent_path() : fs::path(".");
  const std::string stem = amc.stem().string();
  std::vector<std::string> skeletons;
  std::string by_prefix;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!is_asf(entry.path())) continue;
    const std::string name = entry.path().stem().string();
    if (same_word(name, stem)) return entry.path().string();
    if (same_word(name, stem.substr(0, stem.rfind('_')))) by_prefix = entry.path().string();
    skeletons.push_back(entry.path().string());
  }
  if (!by_prefix.empty()) return by_prefix;
  if (skeletons.size() == 1) return skeletons[0];
  throw FileError(amc_path, 0,
                  fmt::format("its skeleton is missing: there {} in {}; put the .asf file beside "
                              "it as {}.asf",
                              skeletons.empty() ? "is no .asf file"
                                                : fmt::format("are {} .asf files of other names",
                                                              skeletons.size()),
                              folder.string(), stem));
}

AcclaimMotion parse_acclaim(const std::string& asf, const std::string& asf_path,
                            const std::string& amc, const std::string& amc_path) {
  const AsfSkeleton skeleton = parse_asf(asf, asf_path);
  return AmcParser(skeleton, amc, amc_path).parse();
}

AcclaimMotion read_amc(const std::string& path) {
  const auto read = [](const std::string& file) {
    return text::utf8_text(read_bounded_file(file, kMaxMotionText));
  };
  const std::string amc = read(path);
  const std::string asf_path = find_asf(path);
  return parse_acclaim(read(asf_path), asf_path, amc, path);
}

}  // namespace remomask::formats
