#include "formats/npy.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <regex>

#include "base/file.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxNpyHeader = 1 << 16;

struct NpyHeader {
  std::string text;
  size_t data_start = 0;
};

NpyHeader read_npy_header(std::string_view content, const std::string& path) {
  if (content.size() < 10 || content.substr(0, 6) != "\x93NUMPY") {
    throw FileError(path, 0, "is not a NumPy .npy file (save it with numpy.save)");
  }
  const int version = static_cast<unsigned char>(content[6]);
  if (version < 1 || version > 3) {
    throw FileError(path, 0, fmt::format("has .npy format {}; formats 1 to 3 are known", version));
  }
  const size_t size_bytes = version == 1 ? 2 : 4;
  size_t length = 0;
  if (content.size() >= 8 + size_bytes) {
    for (size_t i = 0; i < size_bytes; ++i) {
      length |= static_cast<size_t>(static_cast<unsigned char>(content[8 + i])) << (8 * i);
    }
  }
  const size_t start = 8 + size_bytes;
  if (length == 0 || length > kMaxNpyHeader || start + length > content.size()) {
    throw FileError(path, 0, "the .npy header is truncated; copy or save the file again");
  }
  return {std::string(content.substr(start, length)), start + length};
}

std::string npy_field(const NpyHeader& header, const std::string& pattern, const char* name,
                      const std::string& path) {
  std::smatch match;
  if (!std::regex_search(header.text, match, std::regex(pattern))) {
    throw FileError(path, 0, fmt::format("the .npy header has no readable {}", name));
  }
  return match[1];
}

std::vector<size_t> npy_shape(const std::string& text, const std::string& path) {
  std::vector<size_t> shape;
  const std::regex number("[0-9]+");
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) {
    if (it->length() > 12 || shape.size() == 8) {
      throw FileError(
          path, 0,
          "the .npy shape (" + text.substr(0, 80) + ") is not plausible; save the file again");
    }
    shape.push_back(std::stoull(it->str()));
  }
  return shape;
}

template <typename Number>
void copy_numbers(const char* data, const std::vector<size_t>& shape, bool fortran,
                  std::vector<float>& out) {
  std::vector<size_t> stride(shape.size(), 1);  // of the source, in numbers
  for (size_t i = 1; i < shape.size(); ++i) {
    if (fortran) {
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
    Number number;
    std::memcpy(&number, data + source * sizeof number, sizeof number);
    value = static_cast<float>(number);
    for (size_t axis = shape.size(); axis-- > 0;) {
      if (++index[axis] < shape[axis]) break;
      index[axis] = 0;
    }
  }
}

}  // namespace

NpyArray parse_npy(std::string_view content, const std::string& path) {
  const NpyHeader header = read_npy_header(content, path);
  const std::string type =
      npy_field(header, "'descr'\\s*:\\s*'([^']*)'", "number type ('descr')", path);
  if (!type.empty() && type[0] == '>') {
    throw FileError(path, 0,
                    "holds big-endian numbers (" + type + "); save it with array.astype('<f4')");
  }
  const bool wide = type == "<f8" || type == "=f8";
  if (!wide && type != "<f4" && type != "=f4") {
    throw FileError(
        path, 0,
        "holds numbers of type " + type + "; float32 or float64 is needed: array.astype('<f4')");
  }
  const bool fortran =
      npy_field(header, "'fortran_order'\\s*:\\s*(True|False)", "'fortran_order'", path) == "True";
  NpyArray array;
  array.shape =
      npy_shape(npy_field(header, "'shape'\\s*:\\s*\\(([^)]*)\\)", "'shape'", path), path);
  const size_t bytes = wide ? 8 : 4;
  const size_t there = (content.size() - header.data_start) / bytes;
  size_t count = 1;
  for (const size_t extent : array.shape) {
    if (extent != 0 && count > there / extent) {
      count = there + 1;
      break;
    }
    count *= extent;
  }
  if (count > there) {
    throw FileError(path, 0,
                    "holds fewer numbers than its shape (" +
                        fmt::format("{}", fmt::join(array.shape, ", ")) +
                        ") says; it is truncated, copy or save it again");
  }
  array.values.resize(count);
  const char* data = content.data() + header.data_start;
  if (wide) {
    copy_numbers<double>(data, array.shape, fortran, array.values);
  } else {
    copy_numbers<float>(data, array.shape, fortran, array.values);
  }
  return array;
}

NpyArray read_npy(const std::string& path) {
  const std::string content = read_file(path);
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
