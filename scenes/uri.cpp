#include "scenes/uri.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace remomask::scenes {

namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

int base64_value(char c) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const size_t at = kDigits.find(c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

}  // namespace

std::string decode_percent(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(text[i + 2]) : -1;
    if (low >= 0) {
      result += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

bool decode_data_uri(const std::string& uri, std::string& bytes) {
  constexpr std::string_view kMark = ";base64,";
  const size_t mark = uri.find(kMark);
  if (!uri.starts_with("data:") || mark == std::string::npos) return false;
  bytes.clear();
  bytes.reserve((uri.size() - mark) * 3 / 4);
  uint32_t bits = 0;
  int held = 0;
  for (size_t i = mark + kMark.size(); i < uri.size() && uri[i] != '='; ++i) {
    const int value = base64_value(uri[i]);
    if (value < 0) return false;
    bits = bits << 6 | static_cast<uint32_t>(value);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xFF);
  }
  return true;
}

bool is_name_inside_folder(const std::string& path) {
  const std::filesystem::path name(path);
  if (path.empty() || name.is_absolute() || path.find('\\') != std::string::npos ||
      path.find(':') != std::string::npos) {
    return false;
  }
  if (std::any_of(path.begin(), path.end(), [](char c) { return c >= 0 && c < ' '; })) return false;
  return std::none_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
}

}  // namespace remomask::scenes
