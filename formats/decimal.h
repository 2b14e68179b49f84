#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace remomask::formats {

inline bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

/// Whether a number beyond the range of a double is nearly zero rather than huge.
inline bool is_tiny(std::string_view number) {
  const size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) return number.substr(exponent + 1).starts_with('-');
  return number.find('.') < 300;
}

/// Decimal number at `p`; null if there is none. Numbers of up to 15 digits and small exponents
/// (everything that motion files hold) are exact products of two exact doubles, so the result is
/// rounded correctly; other numbers take the slow path. Too large a number is infinite.
inline const char* parse_number(const char* p, const char* end, double& value) {
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
    value = is_tiny({start, static_cast<size_t>(next - start)}) ? 0 : HUGE_VAL;
    return next;
  }
  return error == std::errc() ? next : nullptr;
}

}  // namespace remomask::formats
