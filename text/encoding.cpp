#include "text/encoding.h"

#include <cstdint>

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

}  // namespace

std::string utf8_text(std::string bytes) {
  const Encoding encoding = encoding_of(bytes);
  if (encoding != Encoding::bytes) {
    return from_utf16(bytes, encoding == Encoding::utf16_big_endian);
  }
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  return bytes;
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

}  // namespace remomask::text
