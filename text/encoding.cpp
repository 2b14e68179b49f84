#include "text/encoding.h"

#include <cstdint>
#include <utility>

#include "base/bounded_file.h"
#include "text/utf8.h"

namespace remomask::text {

namespace {

constexpr uint64_t kMaxTextBytes = uint64_t{1} << 30;
constexpr char32_t kReplacement = 0xFFFD;

enum class Encoding { bytes, utf16_little_endian, utf16_big_endian };

/// By the byte order mark, or by the zero byte that UTF-16 has beside the first ASCII character.
Encoding encoding_of(const std::string& bytes) {
  if (bytes.size() < 2) return Encoding::bytes;
  const auto first = static_cast<unsigned char>(bytes[0]);
  const auto second = static_cast<unsigned char>(bytes[1]);
  if (first == 0xFF && second == 0xFE) return Encoding::utf16_little_endian;
  if (first == 0xFE && second == 0xFF) return Encoding::utf16_big_endian;
  if (first != 0 && first < 128 && second == 0) return Encoding::utf16_little_endian;
  if (first == 0 && second != 0 && second < 128) return Encoding::utf16_big_endian;
  return Encoding::bytes;
}

std::string from_utf16(const std::string& bytes, bool big_endian) {
  const size_t count = bytes.size() / 2;
  const auto unit = [&](size_t i) {
    const auto a = static_cast<unsigned char>(bytes[2 * i]);
    const auto b = static_cast<unsigned char>(bytes[2 * i + 1]);
    return static_cast<char32_t>(big_endian ? a << 8 | b : b << 8 | a);
  };
  std::string text;
  text.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    char32_t code = unit(i);
    if (i == 0 && code == 0xFEFF) continue;
    if (code >= 0xD800 && code < 0xDC00 && i + 1 < count) {
      const char32_t low = unit(i + 1);
      if (low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        ++i;
      }
    }
    append_utf8(text, code >= 0xD800 && code < 0xE000 ? kReplacement : code);
  }
  return text;
}

/// What Windows-1252 has where Latin-1 has control characters.
constexpr char32_t kWindows1252[32] = {
    0x20AC, 0x81,   0x201A, 0x192,  0x201E, 0x2026, 0x2020, 0x2021, 0x2C6,  0x2030, 0x160,
    0x2039, 0x152,  0x8D,   0x17D,  0x8F,   0x90,   0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x2DC,  0x2122, 0x161,  0x203A, 0x153,  0x9D,   0x17E,  0x178};

void append_line(std::string& text, std::string_view line) {
  if (is_utf8(line)) {
    text += line;
    return;
  }
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    append_utf8(text, byte >= 0x80 && byte < 0xA0 ? kWindows1252[byte - 0x80] : byte);
  }
}

}  // namespace

std::string utf8_text(std::string bytes) {
  const Encoding encoding = encoding_of(bytes);
  if (encoding != Encoding::bytes) {
    return from_utf16(bytes, encoding == Encoding::utf16_big_endian);
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  return bytes;
}

std::string utf8_lines(std::string bytes) {
  const std::string decoded = utf8_text(std::move(bytes));
  std::string text;
  text.reserve(decoded.size());
  std::string_view rest = decoded;
  while (true) {
    const size_t end = rest.find_first_of("\r\n");
    append_line(text, rest.substr(0, end));
    if (end == std::string_view::npos) return text;
    text += '\n';
    rest.remove_prefix(end + (rest.substr(end).starts_with("\r\n") ? 2 : 1));
  }
}

bool is_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const size_t length = first < 0x80                     ? 1
                          : first >= 0xC2 && first < 0xE0  ? 2
                          : first >= 0xE0 && first < 0xF0  ? 3
                          : first >= 0xF0 && first <= 0xF4 ? 4
                                                           : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80) return false;
    }
    i += length;
  }
  return true;
}

std::string read_text_file(const std::string& path) {
  return utf8_text(read_bounded_file(path, kMaxTextBytes));
}

std::string read_lines_file(const std::string& path) {
  return utf8_lines(read_bounded_file(path, kMaxTextBytes));
}

}  // namespace remomask::text
