#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace remomask::index {

/// The content of a file, mapped: nothing is read before it is used. The file must only ever be
/// replaced by renaming, as base/file.h does.
class MappedFile {
 public:
  /// Throws FileError if the file cannot be read.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::string_view content() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  size_t size_ = 0;
};

/// Version of the index files that this program writes, and the newest it reads.
constexpr int kIndexFormat = 2;

/// A file of the index: a body of binary data, a JSON object that describes it, the length of that
/// object (8 bytes, little-endian), and 8 bytes of magic. The description comes last so that other
/// programs can read the body by itself.
struct DescribedContent {
  std::string_view body;
  nlohmann::json description;
};

/// What follows the body: the description, with the version and a checksum of itself added.
std::string describe(nlohmann::json description, std::string_view magic);

/// Splits the content of such a file; the body is not checked. Throws FileError that ends with
/// `remedy` if the file is truncated, its description is damaged, or its version is newer.
DescribedContent split_described(const std::string& path, std::string_view content,
                                 std::string_view magic, const std::string& remedy);

}  // namespace remomask::index
