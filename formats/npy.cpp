#include "formats/npy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/bounded_file.h"
#include "formats/npy_header.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr uint64_t kMaxNpyBytes = uint64_t{1} << 29;
constexpr size_t kMaxNpyNumbers = size_t{1} << 27;

float float_of_half(uint16_t half) {
  const int exponent = half >> 10 & 31;
  const int fraction = half & 1023;
  float value = exponent == 0    ? std::ldexp(static_cast<float>(fraction), -24)
                : exponent == 31 ? (fraction == 0 ? HUGE_VALF : NAN)
                                 : std::ldexp(static_cast<float>(fraction + 1024), exponent - 25);
  return half >> 15 ? -value : value;
}

template <typename Number>
Number number_at(const char* data, bool big_endian) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, data, sizeof bytes);
  if (big_endian) std::reverse(bytes, bytes + sizeof bytes);
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

template <typename Number, typename Convert>
void copy_numbers(const char* data, const NpyHeader& header, std::vector<float>& out,
                  Convert convert) {
  const std::vector<size_t>& shape = header.shape;
  std::vector<size_t> stride(shape.size(), 1);  // of the source, in numbers
  for (size_t i = 1; i < shape.size(); ++i) {
    if (header.fortran) {
      stride[i] = stride[i - 1] * shape[i - 1];
    } else {
      const size_t axis = shape.size() - 1 - i;
      stride[axis] = stride[axis + 1] * shape[axis + 1];
    }
  }
  std::vector<size_t> index(shape.size(), 0);
  for (float& value : out) {
    size_t source = 0;
    for (size_t axis = 0; axis < shape.size(); ++axis) source += index[axis] * stride[axis];
    value = convert(number_at<Number>(data + source * sizeof(Number), header.big_endian));
    for (size_t axis = shape.size(); axis-- > 0;) {
      if (++index[axis] < shape[axis]) break;
      index[axis] = 0;
    }
  }
}

template <typename Number>
void copy_plain(const char* data, const NpyHeader& header, std::vector<float>& out) {
  copy_numbers<Number>(data, header, out, [](Number number) { return static_cast<float>(number); });
}

void copy_values(const char* data, const NpyHeader& header, std::vector<float>& out) {
  const size_t bytes = header.item_bytes;
  if (header.kind == 'f') {
    if (bytes == 2) return copy_numbers<uint16_t>(data, header, out, float_of_half);
    return bytes == 4 ? copy_plain<float>(data, header, out)
                      : copy_plain<double>(data, header, out);
  }
  if (header.kind == 'i') {
    return bytes == 1   ? copy_plain<int8_t>(data, header, out)
           : bytes == 2 ? copy_plain<int16_t>(data, header, out)
           : bytes == 4 ? copy_plain<int32_t>(data, header, out)
                        : copy_plain<int64_t>(data, header, out);
  }
  return bytes == 1   ? copy_plain<uint8_t>(data, header, out)
         : bytes == 2 ? copy_plain<uint16_t>(data, header, out)
         : bytes == 4 ? copy_plain<uint32_t>(data, header, out)
                      : copy_plain<uint64_t>(data, header, out);
}

/// Numbers of an array of this shape; more than `there` if it has more.
size_t number_count(const std::vector<size_t>& shape, size_t there) {
  size_t count = 1;
  for (const size_t extent : shape) {
    if (extent != 0 && count > there / extent) return there + 1;
    count *= extent;
  }
  return count;
}

}  // namespace

NpyArray parse_npy(std::string_view content, const std::string& path) {
  const NpyHeader header = read_npy_header(content, path);
  const size_t there = (content.size() - header.data_start) / header.item_bytes;
  const size_t count = number_count(header.shape, there);
  if (count > there) {
    throw FileError(path, 0,
                    fmt::format("holds fewer numbers than its shape ({}) says; it is truncated, "
                                "copy or save it again",
                                fmt::join(header.shape, ", ")));
  }
  if (count > kMaxNpyNumbers) {
    throw FileError(path, 0,
                    fmt::format("holds more than {} million numbers; cut it into shorter clips",
                                kMaxNpyNumbers / 1'000'000));
  }
  NpyArray array;
  array.shape = header.shape;
  array.values.resize(count);
  copy_values(content.data() + header.data_start, header, array.values);
  return array;
}

NpyArray read_npy(const std::string& path) {
  const std::string content = read_bounded_file(path, kMaxNpyBytes);
  return parse_npy(content, path);
}

std::string format_npy(const NpyArray& array) {
  std::string shape;
  for (const size_t extent : array.shape) shape += fmt::format("{}, ", extent);
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  if (array.shape.size() == 1) shape.resize(shape.size() - 1);
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string content = "\x93NUMPY";
  content += '\x01';
  content += '\0';
  content += static_cast<char>(header.size() & 255);
  content += static_cast<char>(header.size() >> 8);
  content += header;
  content.append(reinterpret_cast<const char*>(array.values.data()),
                 array.values.size() * sizeof(float));
  return content;
}

}  // namespace remomask::formats
