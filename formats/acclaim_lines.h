#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::formats {

/// Lines of an .asf or .amc file as words; comments and blank lines are passed over.
class AcclaimLines {
 public:
  AcclaimLines(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  /// To the next line; false at the end of the file.
  bool next();
  /// The next call of next() gives the same line again.
  void unread() { again_ = true; }
  /// Of the line; not empty.
  const std::vector<std::string_view>& words() const { return words_; }
  /// Finite number in a place of the line. Throws FileError; `what` names it.
  double number(size_t place, std::string_view what) const;
  [[noreturn]] void fail(const std::string& message) const;
  long line() const { return line_; }

 private:
  std::string_view rest_;
  const std::string& path_;
  std::vector<std::string_view> words_;
  long line_ = 0;
  bool again_ = false;
};

}  // namespace remomask::formats
