#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/bounded_file.h"
#include "formats/bvh.h"
#include "formats/bvh_hierarchy.h"
#include "formats/decimal.h"
#include "formats/motion_reading.h"
#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::formats {

namespace {

constexpr double kMinFrameTime = 1e-5, kMaxFrameTime = 10;

/// Reads the MOTION section: the rows of numbers that make up nearly all of a file.
class BvhMotionParser {
 public:
  BvhMotionParser(BvhScanner& scanner, const BvhHierarchy& hierarchy, const BvhReading& reading,
                  Bvh& bvh)
      : scanner_(scanner), hierarchy_(hierarchy), reading_(reading), bvh_(bvh) {}

  void parse() {
    read_header();
    if (hierarchy_.all_columns_used()) {
      read_rows<true>();
    } else {
      read_rows<false>();
    }
    compare_counts();
  }

 private:
  void read_header() {
    bool frame_time_seen = false;
    while (!frame_time_seen || announced_.empty()) {
      const BvhScanner::Place before = scanner_.place();
      const std::string label = scanner_.header_label();
      if (label == "frames") {
        announced_line_ = scanner_.line();
        announced_ = scanner_.at_line_end() ? "nothing" : scanner_.next_word();
      } else if (label == "frametime") {
        read_frame_time();
        frame_time_seen = true;
      } else if (label.empty() && !scanner_.at_end()) {
        scanner_.go_back(before);
        break;
      } else if (label.empty()) {
        scanner_.fail("the file ends behind MOTION; it is truncated, export it again");
      } else {
        scanner_.fail(fmt::format("expected \"Frames:\" or \"Frame Time:\" after MOTION, found {}",
                                  in_quotes(label)));
      }
    }
    if (!frame_time_seen && !reading_.frame_time_known) {
      scanner_.fail("there is no line \"Frame Time:\"; give the frame rate with --fps");
    }
  }

  void read_frame_time() {
    const std::string_view word =
        scanner_.at_line_end() ? std::string_view("nothing") : scanner_.next_word();
    double value = 0;
    const char* end = word.data() + word.size();
    const bool plausible = parse_number(word.data(), end, value) == end && value >= kMinFrameTime &&
                           value <= kMaxFrameTime;
    if (plausible) {
      bvh_.frame_time = value;
    } else if (!reading_.frame_time_known) {
      scanner_.fail(
          fmt::format("Frame Time: {} is not a time between frames in seconds (30 frames a second "
                      "are 0.033333){}; correct it, or give the frame rate with --fps",
                      shown_text(word), about_decimal_comma(word)));
    }
  }

  /// Value of the line "Frames:", if it is a whole number.
  std::optional<size_t> announced_frames() const {
    size_t count = 0;
    const char* end = announced_.data() + announced_.size();
    const auto [next, error] = std::from_chars(announced_.data(), end, count);
    if (error != std::errc() || next != end) return std::nullopt;
    return count;
  }

  template <bool kAllColumns>
  void read_rows() {
    const size_t width = static_cast<size_t>(bvh_.channels);
    // A value takes at least two bytes, which bounds what a wrong number of frames can allocate.
    const size_t max_rows = scanner_.bytes_left() / (2 * hierarchy_.columns()) + 1;
    size_t rows = std::clamp<size_t>(announced_frames().value_or(1), 1, max_rows);
    bvh_.values.resize(rows * width);
    size_t frame = 0;
    while (scanner_.skip_blank_lines()) {
      if (frame == rows) {
        rows = std::min(max_rows, 2 * rows);
        bvh_.values.resize(rows * width);
      }
      read_row<kAllColumns>(bvh_.values.data() + frame * width);
      ++frame;
    }
    if (frame == 0) scanner_.fail("the file holds no frames, only the rest pose");
    bvh_.frames = static_cast<int>(frame);
    bvh_.values.resize(frame * width);
    if (rows > 2 * frame) bvh_.values.shrink_to_fit();
  }

  template <bool kAllColumns>
  void read_row(float* out) {
    const char* p = scanner_.position();
    const char* const end = scanner_.end();
    const size_t columns = hierarchy_.columns();
    for (size_t i = 0; i < columns; ++i) {
      while (p < end && is_bvh_blank(*p)) ++p;
      if (p == end || is_line_end(*p)) {
        scanner_.fail(fmt::format(
            "the frame has {} values, the hierarchy has {} channels; {}", i, columns,
            p == end ? "the file is truncated, export it again" : "correct or remove this line"));
      }
      double value = 0;
      const char* next = parse_number(p, end, value);
      if (!next || (next < end && !is_bvh_blank(*next) && !is_line_end(*next))) {
        const char* last = p;
        while (last < end && !is_bvh_blank(*last) && !is_line_end(*last)) ++last;
        const std::string_view word(p, static_cast<size_t>(last - p));
        scanner_.fail(fmt::format("value {} of the frame is {}, not a finite number{}", i + 1,
                                  in_quotes(word), about_decimal_comma(word)));
      }
      if (!(std::abs(value) <= kMaxBvhValue)) {
        scanner_.fail(fmt::format("value {} of the frame is too large to be a motion", i + 1));
      }
      if (kAllColumns || hierarchy_.column_used(i)) *out++ = static_cast<float>(value);
      p = next;
    }
    while (p < end && is_bvh_blank(*p)) ++p;
    if (p < end && !is_line_end(*p)) {
      scanner_.fail(
          fmt::format("the frame has more values than the hierarchy's {} channels", columns));
    }
    scanner_.move_to(p);
  }

  void compare_counts() {
    if (announced_.empty()) {
      scanner_.warn(scanner_.line(),
                    fmt::format("there is no line \"Frames:\"; the {} frames that are there are "
                                "read",
                                bvh_.frames));
    } else if (announced_frames() != static_cast<size_t>(bvh_.frames)) {
      scanner_.warn(announced_line_, fmt::format("Frames: says {}, the file holds {}, which are "
                                                 "read; correct that number if the file is whole",
                                                 shown_text(announced_), bvh_.frames));
    }
  }

  BvhScanner& scanner_;
  const BvhHierarchy& hierarchy_;
  const BvhReading& reading_;
  Bvh& bvh_;
  std::string announced_;  ///< as the file writes it
  long announced_line_ = 0;
};

/// The end of a file as old tools leave it: zeros that fill a block, and the sign that ended files
/// of DOS.
std::string_view without_padding(std::string_view text) {
  constexpr char kEndOfDosFile = 0x1a;
  while (!text.empty() && (text.back() == 0 || text.back() == kEndOfDosFile)) text.remove_suffix(1);
  return text;
}

Bvh parse_utf8_bvh(std::string_view file, const std::string& path, const BvhReading& reading) {
  const std::string_view text = without_padding(file);
  Bvh bvh;
  BvhScanner scanner(text, path, bvh.warnings);
  BvhHierarchy hierarchy(scanner, reading.root);
  hierarchy.parse();
  bvh.joints = hierarchy.take_joints();
  for (const BvhJoint& joint : bvh.joints) bvh.channels += static_cast<int>(joint.channels.size());
  if (bvh.channels == 0) scanner.fail("no joint has a channel, so nothing can move");
  BvhMotionParser(scanner, hierarchy, reading, bvh).parse();
  return bvh;
}

}  // namespace

Bvh parse_bvh(std::string_view text, const std::string& path, const BvhReading& reading) {
  return parse_utf8_bvh(text::utf8_text(std::string(text)), path, reading);
}

Bvh read_bvh(const std::string& path, const BvhReading& reading) {
  const std::string text = text::utf8_text(read_bounded_file(path, kMaxMotionText));
  return parse_utf8_bvh(text, path, reading);
}

}  // namespace remomask::formats
