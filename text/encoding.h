#pragma once

#include <string>
#include <string_view>

namespace remomask::text {

/// Text of a file as UTF-8 without a byte order mark: what editors and programs on Windows save as
/// "UTF-8 with BOM" or "Unicode" (UTF-16) reads like any other text. Other bytes stay as they are.
std::string utf8_text(std::string bytes);

/// The same of a text that is read line by line: every line ends with LF, whether it ended with LF,
/// CR LF or CR, and a line that is not UTF-8 is read as Windows-1252.
std::string utf8_lines(std::string bytes);

/// Whether the text is UTF-8 throughout.
bool is_utf8(std::string_view text);

/// Whole content of a text file, as utf8_text() gives it. Throws FileError when it cannot be read
/// or is larger than 1 GiB.
std::string read_text_file(const std::string& path);
/// The same, as utf8_lines() gives it.
std::string read_lines_file(const std::string& path);

}  // namespace remomask::text
