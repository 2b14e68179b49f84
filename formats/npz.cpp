#include "formats/npz.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxNpzEntries = 10'000;
constexpr size_t kReadBlock = size_t{1} << 16;

struct ZipCloser {
  void operator()(struct archive* reader) const { archive_read_free(reader); }
};
using ZipReader = std::unique_ptr<struct archive, ZipCloser>;

[[noreturn]] void refuse_zip(const ZipReader& zip, const std::string& path) {
  const char* why = archive_error_string(zip.get());
  throw FileError(path, 0,
                  fmt::format("cannot be read as .npz: {}; the file is damaged or another format, "
                              "copy or save it again",
                              why ? why : "unknown reason"));
}

ZipReader open_zip(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw FileError(path, 0, "is not a readable file");
  ZipReader zip(archive_read_new());
  if (!zip) throw FileError(path, 0, "there is not enough memory to read it");
  // By the directory at the end of the file, so that a truncated file is noticed.
  archive_read_support_format_zip_seekable(zip.get());
  if (archive_read_open_filename(zip.get(), path.c_str(), kReadBlock) != ARCHIVE_OK) {
    refuse_zip(zip, path);
  }
  return zip;
}

/// Unpacked bytes of the entry that was just begun; at most `max_bytes`.
std::string unpack_entry(const ZipReader& zip, const std::string& path, uint64_t max_bytes) {
  std::string content;
  std::vector<char> block(kReadBlock);
  while (true) {
    const la_ssize_t count = archive_read_data(zip.get(), block.data(), block.size());
    if (count < 0) refuse_zip(zip, path);
    if (count == 0) return content;
    content.append(block.data(), static_cast<size_t>(count));
    if (content.size() > max_bytes) {
      throw FileError(path, 0,
                      fmt::format("unpacks to more than {} MiB, the most that is read; cut it into "
                                  "shorter clips",
                                  max_bytes >> 20));
    }
  }
}

/// "poses" for "poses.npy"; empty for other entries.
std::string array_name(struct archive_entry* entry) {
  const char* path = archive_entry_pathname_utf8(entry);
  if (!path) path = archive_entry_pathname(entry);
  std::string name = path ? path : "";
  if (!name.ends_with(".npy")) return "";
  name.resize(name.size() - 4);
  return name;
}

}  // namespace

const NpyArray* NpzArrays::find(const std::string& name) const {
  const auto place = arrays.find(name);
  return place == arrays.end() ? nullptr : &place->second;
}

const NpyArray* NpzArrays::find_any(const std::vector<std::string>& wanted) const {
  for (const std::string& name : wanted) {
    if (const NpyArray* array = find(name)) return array;
  }
  return nullptr;
}

NpzArrays read_npz(const std::string& path, const std::vector<std::string>& wanted,
                   const NpzLimits& limits) {
  const ZipReader zip = open_zip(path);
  NpzArrays result;
  uint64_t left = limits.file_bytes;
  struct archive_entry* entry = nullptr;
  int code = ARCHIVE_OK;
  while ((code = archive_read_next_header(zip.get(), &entry)) == ARCHIVE_OK ||
         code == ARCHIVE_WARN) {
    if (result.names.size() == kMaxNpzEntries) {
      throw FileError(path, 0, "holds too many arrays to be a motion");
    }
    const std::string name = array_name(entry);
    if (name.empty()) continue;
    result.names.push_back(name);
    const bool is_wanted = std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    if (!is_wanted || result.arrays.contains(name)) continue;
    const std::string content = unpack_entry(zip, path, std::min(left, limits.array_bytes));
    left -= content.size();
    result.arrays.emplace(name, parse_npy(content, path + ": " + name));
  }
  if (code != ARCHIVE_EOF) refuse_zip(zip, path);
  return result;
}

}  // namespace remomask::formats
