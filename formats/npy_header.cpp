#include "formats/npy_header.h"

#include <fmt/format.h>

#include <charconv>

#include "formats/bvh_scanner.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxNpyHeader = 1 << 16;
constexpr size_t kMaxNpyAxes = 8;

/// The Python dictionary at the start of a .npy file, which is looked up without being evaluated.
class NpyDictionary {
 public:
  NpyDictionary(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  std::string_view quoted_value(const char* key) const {
    const std::string_view value = value_of(key);
    const size_t end = value.empty() ? value.npos : value.find(value[0], 1);
    if ((value[0] != '\'' && value[0] != '"') || end == value.npos) fail(key);
    return value.substr(1, end - 1);
  }

  bool truth(const char* key) const {
    const std::string_view value = value_of(key);
    if (!value.starts_with("True") && !value.starts_with("False")) fail(key);
    return value.starts_with("True");
  }

  std::vector<size_t> sizes(const char* key) const {
    const std::string_view value = value_of(key);
    const size_t end = value.find(')');
    if (value[0] != '(' || end == value.npos) fail(key);
    std::vector<size_t> sizes;
    const char* last = value.data() + end;
    for (const char* p = value.data() + 1; p < last;) {
      if (*p == ' ' || *p == ',' || *p == 'L') {  // Python 2 wrote 60L
        ++p;
        continue;
      }
      size_t size = 0;
      const auto [next, error] = std::from_chars(p, last, size);
      if (error == std::errc::invalid_argument) fail(key);
      if (error != std::errc() || size > 1'000'000'000'000 || sizes.size() == kMaxNpyAxes) {
        throw FileError(path_, 0,
                        fmt::format("the .npy shape {} is not plausible; save the file again",
                                    shown_text(value.substr(0, end + 1))));
      }
      sizes.push_back(size);
      p = next;
    }
    return sizes;
  }

  /// A field of the value of `descr` makes it a list.
  bool is_list(const char* key) const { return value_of(key)[0] == '['; }

 private:
  /// Text from the first character of the value on; not empty.
  std::string_view value_of(const char* key) const {
    for (const char quote : {'\'', '"'}) {
      const std::string name = quote + std::string(key) + quote;
      size_t at = text_.find(name);
      if (at == text_.npos) continue;
      at = text_.find_first_not_of(" \t", at + name.size());
      if (at == text_.npos || text_[at] != ':') continue;
      at = text_.find_first_not_of(" \t", at + 1);
      if (at != text_.npos) return text_.substr(at);
    }
    fail(key);
  }

  [[noreturn]] void fail(const char* key) const {
    throw FileError(path_, 0, fmt::format("the .npy header has no readable '{}'", key));
  }

  std::string_view text_;
  const std::string& path_;
};

void read_number_type(std::string_view type, NpyHeader& header, const std::string& path) {
  if (type == "|O" || type == "O") {
    throw FileError(path, 0,
                    "holds Python objects (a pickle), which run code when they are loaded; nothing "
                    "of it was executed. Save the array of numbers alone, for instance from MDM's "
                    "results.npy: d = numpy.load(FILE, allow_pickle=True).item(); "
                    "numpy.save(\"motion.npy\", d[\"motion\"][0])");
  }
  const std::string_view order = type.substr(0, 1);
  const std::string_view rest = type.substr(order.find_first_of("<>=|") == order.npos ? 0 : 1);
  header.big_endian = order == ">";
  header.kind = rest.empty() ? '?' : rest[0];
  header.item_bytes = 0;
  if (rest.size() == 2) header.item_bytes = static_cast<size_t>(rest[1] - '0');
  const size_t bytes = header.item_bytes;
  const bool is_float = header.kind == 'f' && (bytes == 2 || bytes == 4 || bytes == 8);
  const bool is_whole = (header.kind == 'i' || header.kind == 'u') &&
                        (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
  if (!is_float && !is_whole) {
    throw FileError(path, 0,
                    fmt::format("holds values of the type {}; numbers such as float32 are needed: "
                                "array.astype('float32')",
                                shown_text(type)));
  }
}

}  // namespace

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
  const NpyDictionary dictionary(content.substr(start, length), path);
  NpyHeader header;
  header.data_start = start + length;
  if (dictionary.is_list("descr")) {
    throw FileError(path, 0,
                    "holds records with named fields; save the field of positions alone, as an "
                    "array of float32");
  }
  read_number_type(dictionary.quoted_value("descr"), header, path);
  header.fortran = dictionary.truth("fortran_order");
  header.shape = dictionary.sizes("shape");
  return header;
}

}  // namespace remomask::formats
