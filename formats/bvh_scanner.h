#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::formats {

inline bool is_bvh_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }
inline bool is_line_end(char c) { return c == '\n' || c == '\r'; }

/// Words and lines of a BVH file with the number of the line: LF, CR LF and CR end one.
class BvhScanner {
 public:
  struct Place {
    const char* position;
    long line;
  };

  BvhScanner(std::string_view text, const std::string& path, std::vector<std::string>& warnings)
      : p_(text.data()), end_(text.data() + text.size()), path_(path), warnings_(warnings) {}

  /// Next word; empty at the end of the file. A brace is a word of its own.
  std::string_view next_word();
  /// The rest of the line up to an opening brace, without blanks around it.
  std::string_view rest_of_line();
  /// Letters of the line up to a colon (which is passed) or a number, in lower case: "frametime".
  std::string header_label();
  /// Whether only blanks follow in this line.
  bool at_line_end() {
    while (p_ < end_ && is_bvh_blank(*p_)) ++p_;
    return p_ == end_ || is_line_end(*p_);
  }
  /// The next word must be `wanted`, in any case.
  void expect(std::string_view wanted, std::string_view where);
  double read_number(const char* what);

  /// Moves to the next character that is not a blank; false at the end of the file.
  bool skip_blank_lines() {
    while (p_ < end_ && (is_bvh_blank(*p_) || is_line_end(*p_))) pass_blank();
    return p_ < end_;
  }

  [[noreturn]] void fail(const std::string& message) const;
  void warn(long line, const std::string& message);

  Place place() const { return {p_, line_}; }
  void go_back(const Place& place) {
    p_ = place.position;
    line_ = place.line;
  }
  const char* position() const { return p_; }
  void move_to(const char* position) { p_ = position; }  ///< in the same line
  const char* end() const { return end_; }
  size_t bytes_left() const { return static_cast<size_t>(end_ - p_); }
  bool at_end() const { return p_ == end_; }
  long line() const { return line_; }
  const std::string& path() const { return path_; }

 private:
  void pass_blank() {
    // Of CR LF, LF counts.
    if (*p_ == '\n' || (*p_ == '\r' && (p_ + 1 == end_ || p_[1] != '\n'))) ++line_;
    ++p_;
  }

  const char* p_;
  const char* end_;
  const std::string& path_;
  std::vector<std::string>& warnings_;
  long line_ = 1;
};

constexpr double kMaxBvhValue = 1e9;

/// ASCII without regard to case.
bool same_word(std::string_view a, std::string_view b);

/// Text of a file as a message may show it: short, without control characters or broken UTF-8.
std::string shown_text(std::string_view text);
std::string in_quotes(std::string_view text);
/// What an error about a number says if the number has a decimal comma; else empty.
std::string about_decimal_comma(std::string_view word);

}  // namespace remomask::formats
