#include "index/described_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>

#include "base/hash.h"
#include "base/json.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

constexpr const char* kDescriptionChecksum = "description_checksum";

static_assert(std::endian::native == std::endian::little, "index files are little-endian");

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    const std::string reason = std::strerror(errno);
    if (descriptor >= 0) ::close(descriptor);
    throw FileError(path, 0, "cannot open: " + reason);
  }
  size_ = static_cast<size_t>(status.st_size);
  void* data = nullptr;
  if (size_ > 0) data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const std::string reason = std::strerror(errno);
  ::close(descriptor);
  if (data == MAP_FAILED) throw FileError(path, 0, "cannot read: " + reason);
  data_ = static_cast<const char*>(data);
}

MappedFile::~MappedFile() {
  if (size_ > 0) ::munmap(const_cast<char*>(data_), size_);
}

std::string describe(nlohmann::json description, std::string_view magic) {
  description["version"] = kIndexFormat;
  description[kDescriptionChecksum] = content_hash(description.dump());
  std::string text = description.dump();
  const uint64_t length = text.size();
  text.append(reinterpret_cast<const char*>(&length), sizeof length);
  return text.append(magic);
}

DescribedContent split_described(const std::string& path, std::string_view content,
                                 std::string_view magic, const std::string& remedy) try {
  const size_t end = sizeof(uint64_t) + magic.size();
  if (content.size() < end || !content.ends_with(magic)) {
    throw FileError(path, 0, "is not an index file, or is truncated; " + remedy);
  }
  uint64_t length = 0;
  std::memcpy(&length, content.data() + content.size() - end, sizeof length);
  const FileError damaged(path, 0, "the index is damaged; " + remedy);
  if (length > content.size() - end) throw damaged;
  const size_t start = content.size() - end - static_cast<size_t>(length);
  DescribedContent parts{content.substr(0, start),
                         try_parse_json(content.substr(start, static_cast<size_t>(length)))};
  if (!parts.description.is_object()) throw damaged;
  const int version = parts.description.value("version", 0);
  if (version > kIndexFormat) {
    throw FileError(path, 0, "was made by a newer version of remomask; " + remedy);
  }
  if (version == 1) return parts;  // the first format has no checksum here
  const std::string checksum = parts.description.value(kDescriptionChecksum, "");
  parts.description.erase(kDescriptionChecksum);
  if (checksum != content_hash(parts.description.dump())) throw damaged;
  return parts;
} catch (const nlohmann::json::exception&) {  // a field of another type than it should be
  throw FileError(path, 0, "the index is damaged; " + remedy);
}

}  // namespace remomask::index
