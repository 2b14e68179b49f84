#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "base/file.h"
#include "formats/bvh.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxBvhBytes = size_t{1} << 30;
constexpr int kMaxBvhJoints = 10000;
constexpr double kMaxBvhValue = 1e9;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// Decimal number at `p`; null if there is none. Numbers of up to 15 digits and small exponents
/// (everything that BVH files hold) are exact products of two exact doubles, so the result is
/// rounded correctly; other numbers take the slow path.
const char* parse_number(const char* p, const char* end, double& value) {
  static constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                       1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* start = p;
  const bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+')) ++p;
  const char* after_sign = p;
  uint64_t mantissa = 0;
  int digits = 0, exponent = 0;
  for (; p < end && is_digit(*p); ++p, ++digits) mantissa = mantissa * 10 + (*p - '0');
  if (p < end && *p == '.') {
    ++p;
    const char* fraction = p;
    for (; p < end && is_digit(*p); ++p, ++digits) mantissa = mantissa * 10 + (*p - '0');
    exponent = -static_cast<int>(p - fraction);
  }
  if (digits == 0) return nullptr;
  const bool plain = p == end || (*p != 'e' && *p != 'E');
  if (plain && digits <= 15 && exponent >= -22) {
    const double magnitude = static_cast<double>(mantissa) / kPowers[-exponent];
    value = negative ? -magnitude : magnitude;
    return p;
  }
  const auto [next, error] = std::from_chars(*start == '+' ? after_sign : start, end, value);
  if (error == std::errc::result_out_of_range) {
    value = HUGE_VAL;
    return next;
  }
  return error == std::errc() ? next : nullptr;
}

class BvhParser {
 public:
  BvhParser(std::string_view text, const std::string& path)
      : p_(text.data()), end_(text.data() + text.size()), path_(path) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") p_ += 3;
  }

  Bvh parse() {
    read_hierarchy();
    read_motion_header();
    read_frames();
    return std::move(bvh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_, line_, message);
  }

  /// Next word; empty at the end of the file. Newlines are counted.
  std::string_view next_word() {
    while (p_ < end_ && (is_blank(*p_) || *p_ == '\n')) {
      if (*p_++ == '\n') ++line_;
    }
    const char* start = p_;
    if (p_ < end_ && (*p_ == '{' || *p_ == '}')) {
      ++p_;
    } else {
      while (p_ < end_ && !is_blank(*p_) && *p_ != '\n' && *p_ != '{' && *p_ != '}') ++p_;
    }
    return {start, static_cast<size_t>(p_ - start)};
  }

  /// The rest of the line up to an opening brace, without blanks around it.
  std::string_view rest_of_line() {
    while (p_ < end_ && is_blank(*p_)) ++p_;
    const char* start = p_;
    while (p_ < end_ && *p_ != '\n' && *p_ != '{') ++p_;
    const char* last = p_;
    while (last > start && is_blank(last[-1])) --last;
    return {start, static_cast<size_t>(last - start)};
  }

  void expect(std::string_view wanted, std::string_view where) {
    const std::string_view word = next_word();
    if (word == wanted) return;
    if (word.empty()) {
      fail(
          fmt::format("the file ends where \"{}\" was expected ({}); it is truncated, export it "
                      "again",
                      wanted, where));
    }
    fail(fmt::format("expected \"{}\" {}, found \"{}\"", wanted, where, shown(word)));
  }

  static std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
    }
    return word.size() > 40 ? text + "..." : text;
  }

  double read_number(const char* what) {
    const std::string_view word = next_word();
    double value = 0;
    if (word.empty()) fail(fmt::format("the file ends inside {}; it is truncated", what));
    if (parse_number(word.data(), word.data() + word.size(), value) != word.data() + word.size()) {
      fail(fmt::format("{} needs a number, found \"{}\"", what, shown(word)));
    }
    if (!(std::abs(value) <= kMaxBvhValue)) {
      fail(fmt::format("{} holds {}, which is not a plausible size", what, shown(word)));
    }
    return value;
  }

  Vec3 read_offset() {
    expect("OFFSET", "after the opening brace");
    Vec3 offset;
    for (int axis = 0; axis < 3; ++axis) offset[axis] = read_number("OFFSET");
    return offset;
  }

  void read_channels(BvhJoint& joint) {
    const double count = read_number("CHANNELS");
    if (count != std::floor(count) || count < 0 || count > 6) {
      fail(
          fmt::format("a joint has 0 to 6 channels, \"{}\" asks for {}", shown(joint.name), count));
    }
    static constexpr std::string_view kNames[] = {"Xposition", "Yposition", "Zposition",
                                                  "Xrotation", "Yrotation", "Zrotation"};
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string_view word = next_word();
      int channel = 0;
      while (channel < 6 && kNames[channel] != word) ++channel;
      if (channel == 6) {
        fail(
            fmt::format("unknown channel \"{}\"; BVH knows Xposition, Yposition, Zposition, "
                        "Xrotation, Yrotation, Zrotation",
                        shown(word)));
      }
      for (const BvhChannel before : joint.channels) {
        if (before == channel) {
          fail(fmt::format("channel {} of \"{}\" is listed twice", word, shown(joint.name)));
        }
      }
      joint.channels.push_back(static_cast<BvhChannel>(channel));
    }
  }

  void open_joint(int parent) {
    const std::string_view name = rest_of_line();
    if (name.empty()) fail("a joint has no name; give every joint a name of its own");
    BvhJoint joint;
    joint.name = name;
    joint.parent = parent;
    if (!names_.insert(joint.name).second) {
      fail(fmt::format("two joints are named \"{}\"; names must differ", shown(name)));
    }
    if (static_cast<int>(bvh_.joints.size()) >= kMaxBvhJoints) {
      fail(fmt::format("more than {} joints; this is not a motion capture file", kMaxBvhJoints));
    }
    expect("{", "after the joint's name");
    joint.offset = read_offset();
    bvh_.joints.push_back(std::move(joint));
  }

  void read_hierarchy() {
    if (next_word() != "HIERARCHY") {
      fail("a BVH file starts with HIERARCHY; this is another format");
    }
    expect("ROOT", "after HIERARCHY");
    open_joint(-1);
    std::vector<int> open = {0};
    while (!open.empty()) {
      const std::string_view word = next_word();
      if (word == "CHANNELS") {
        BvhJoint& joint = bvh_.joints[open.back()];
        if (!joint.channels.empty()) {
          fail(fmt::format("\"{}\" has two CHANNELS lines", shown(joint.name)));
        }
        joint.first_channel = bvh_.channels;
        read_channels(joint);
        // Columns follow the order of the CHANNELS lines; a joint whose children came first would
        // be read against the order of the frames.
        if (open.back() + 1 != static_cast<int>(bvh_.joints.size())) {
          fail("CHANNELS must come before the joint's children");
        }
        bvh_.channels += static_cast<int>(joint.channels.size());
      } else if (word == "JOINT") {
        open_joint(open.back());
        open.push_back(static_cast<int>(bvh_.joints.size()) - 1);
      } else if (word == "End") {
        expect("Site", "after End");
        expect("{", "after End Site");
        const Vec3 end_site = read_offset();
        if (!bvh_.joints[open.back()].end_site) bvh_.joints[open.back()].end_site = end_site;
        expect("}", "after the End Site's OFFSET");
      } else if (word == "}") {
        open.pop_back();
      } else if (word.empty()) {
        fail("the file ends inside the hierarchy; it is truncated, export it again");
      } else {
        fail(fmt::format("expected CHANNELS, JOINT, End Site or a closing brace, found \"{}\"",
                         shown(word)));
      }
    }
    if (bvh_.channels == 0) fail("no joint has a channel, so nothing can move");
  }

  void read_motion_header() {
    const std::string_view word = next_word();
    if (word.empty()) fail("there is no MOTION section; the file is truncated or a rest pose only");
    if (word == "ROOT") fail("a second ROOT; only files with one skeleton can be read");
    if (word != "MOTION") fail(fmt::format("expected MOTION, found \"{}\"", shown(word)));
    expect("Frames:", "after MOTION");
    const double frames = read_number("Frames:");
    if (frames != std::floor(frames) || frames < 1) {
      fail("the file holds no frames; Frames: must be a whole number above zero");
    }
    // A value takes at least two bytes, which bounds what is allocated below.
    const double room = static_cast<double>(end_ - p_) / 2 + 1;
    if (frames * bvh_.channels > room) {
      fail(
          fmt::format("Frames: says {}, but the file is too short for that many; it is truncated "
                      "or the number is wrong",
                      frames));
    }
    bvh_.frames = static_cast<int>(frames);
    expect("Frame", "after the number of frames");
    expect("Time:", "after Frame");
    bvh_.frame_time = read_number("Frame Time:");
    if (!(bvh_.frame_time >= 1e-5 && bvh_.frame_time <= 10)) {
      fail(
          fmt::format("Frame Time: {} is not a time between frames in seconds; 30 frames a second "
                      "are 0.033333",
                      bvh_.frame_time));
    }
  }

  void read_frames() {
    bvh_.values.resize(static_cast<size_t>(bvh_.frames) * bvh_.channels);
    float* out = bvh_.values.data();
    int frame = 0;
    while (true) {
      while (p_ < end_ && (is_blank(*p_) || *p_ == '\n')) {
        if (*p_++ == '\n') ++line_;
      }
      if (p_ == end_) break;
      if (frame == bvh_.frames) {
        fail(
            fmt::format("more frames than Frames: {} announces; correct that number or remove "
                        "the surplus lines",
                        bvh_.frames));
      }
      out = read_row(out);
      ++frame;
    }
    if (frame < bvh_.frames) {
      fail(
          fmt::format("Frames: announces {}, the file holds {}; it is truncated, or correct that "
                      "number",
                      bvh_.frames, frame));
    }
  }

  float* read_row(float* out) {
    const char* p = p_;
    for (int i = 0; i < bvh_.channels; ++i) {
      while (p < end_ && is_blank(*p)) ++p;
      if (p == end_ || *p == '\n') {
        fail(fmt::format("the frame has {} values, the hierarchy has {} channels{}", i,
                         bvh_.channels, p == end_ ? "; the file is truncated" : ""));
      }
      double value = 0;
      const char* next = parse_number(p, end_, value);
      if (!next || (next < end_ && !is_blank(*next) && *next != '\n')) {
        const char* last = p;
        while (last < end_ && !is_blank(*last) && *last != '\n') ++last;
        fail(fmt::format("value {} of the frame is \"{}\", not a finite number", i + 1,
                         shown({p, static_cast<size_t>(last - p)})));
      }
      if (!(std::abs(value) <= kMaxBvhValue)) {
        fail(fmt::format("value {} of the frame is too large to be a motion", i + 1));
      }
      *out++ = static_cast<float>(value);
      p = next;
    }
    while (p < end_ && is_blank(*p)) ++p;
    if (p < end_ && *p != '\n') {
      fail(
          fmt::format("the frame has more values than the hierarchy's {} channels", bvh_.channels));
    }
    p_ = p;
    return out;
  }

  const char* p_;
  const char* end_;
  const std::string& path_;
  long line_ = 1;
  Bvh bvh_;
  std::unordered_set<std::string> names_;
};

}  // namespace

Bvh parse_bvh(std::string_view text, const std::string& path) {
  return BvhParser(text, path).parse();
}

Bvh read_bvh(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxBvhBytes) {
    throw FileError(path, 0, "is larger than 1 GiB; cut it into shorter clips");
  }
  const std::string text = read_file(path);
  return parse_bvh(text, path);
}

}  // namespace remomask::formats
