#include "exchange/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/leftovers.h"
#include "remomask/error.h"

namespace remomask::exchange {

namespace {

namespace fs = std::filesystem;

constexpr const char* kUnpackedMarker = "remomask_import-";
constexpr uint64_t kMaxUnpackedBytes = uint64_t{64} << 30;
constexpr uint64_t kSpareDiskBytes = uint64_t{256} << 20;
constexpr const char* kArchiveEndings[] = {".tar", ".tar.xz",  ".tar.gz", ".tgz",
                                           ".txz", ".tar.zst", ".tar.bz2"};

struct ArchiveCloser {
  void operator()(struct archive* reader) const { archive_read_free(reader); }
};
using ArchiveReader = std::unique_ptr<struct archive, ArchiveCloser>;

/// A file that is written piece by piece.
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::string& path)
      : path_(path),
        descriptor_(
            ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0) fail();
  }
  ~UnpackedFile() { ::close(descriptor_); }
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;

  void write(const char* data, size_t size, int64_t offset) {
    while (size > 0) {
      const ssize_t count = ::pwrite(descriptor_, data, size, offset);
      if (count < 0) {
        if (errno == EINTR) continue;
        fail();
      }
      data += count;
      size -= static_cast<size_t>(count);
      offset += count;
    }
  }

 private:
  [[noreturn]] void fail() const {
    const int code = errno;
    throw FileError(path_, 0,
                    std::string("cannot unpack: ") + std::strerror(code) +
                        (code == EEXIST ? ": the archive holds this name twice; pack it anew"
                                        : "; free some space, or set TMPDIR to a larger disk"));
  }

  std::string path_;
  int descriptor_;
};

std::string entry_name(struct archive_entry* entry) {
  const char* name = archive_entry_pathname_utf8(entry);
  if (!name) name = archive_entry_pathname(entry);
  return name ? name : "";
}

/// Refuses everything but files and folders below the place of unpacking.
void check_entry(const std::string& archive, struct archive_entry* entry, const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    throw FileError(
        archive, 0,
        "entry '" + name + "' " + why +
            "; nothing of this archive is imported. Unpack it yourself if you trust it");
  };
  const fs::path path(name);
  if (name.empty()) refuse("has no readable name");
  if (path.is_absolute()) refuse("has an absolute path");
  if (std::find(path.begin(), path.end(), "..") != path.end()) refuse("leads out of the folder");
  if (archive_entry_hardlink(entry) || archive_entry_symlink(entry)) refuse("is a link");
  const auto type = archive_entry_filetype(entry);
  if (type != AE_IFREG && type != AE_IFDIR) refuse("is neither a file nor a folder");
}

}  // namespace

bool is_archive_name(const std::string& path) {
  return std::any_of(std::begin(kArchiveEndings), std::end(kArchiveEndings),
                     [&](const char* ending) { return path.ends_with(ending); });
}

std::string archive_stem(const std::string& path) {
  std::string name = fs::path(path).filename().string();
  for (const char* ending : kArchiveEndings) {
    if (name.ends_with(ending)) return name.substr(0, name.size() - std::strlen(ending));
  }
  return name;
}

UnpackedArchive::UnpackedArchive(const std::string& path, const Monitor& monitor) {
  if (!fs::is_regular_file(path)) throw FileError(path, 0, "there is no such archive");
  const fs::path folder = fs::temp_directory_path();
  remove_leftovers(folder.string(), kUnpackedMarker);
  std::string temporary = (folder / (kUnpackedMarker + process_tag() + "-XXXXXX")).string();
  if (!::mkdtemp(temporary.data())) {
    throw FileError(temporary, 0,
                    std::string("cannot make a temporary folder: ") + std::strerror(errno) +
                        "; set TMPDIR to a folder that you may write");
  }
  temporary_ = temporary;
  try {
    unpack(path, monitor);
    folder_ = temporary_;
    const fs::directory_iterator top(temporary_), end;
    if (std::distance(top, end) == 1) {
      const fs::directory_entry only = *fs::directory_iterator(temporary_);
      if (only.is_directory()) folder_ = only.path().string();
    }
  } catch (...) {
    fs::remove_all(temporary_);
    throw;
  }
}

UnpackedArchive::~UnpackedArchive() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void UnpackedArchive::unpack(const std::string& path, const Monitor& monitor) {
  ArchiveReader reader(archive_read_new());
  if (!reader) throw FileError(path, 0, "there is not enough memory to read it");
  archive_read_support_filter_all(reader.get());
  archive_read_support_format_tar(reader.get());
  const auto broken = [&] {
    const char* why = archive_error_string(reader.get());
    throw FileError(path, 0,
                    std::string("cannot be unpacked: ") + (why ? why : "unknown reason") +
                        "; the file is damaged or not a tar archive, get it anew");
  };
  if (archive_read_open_filename(reader.get(), path.c_str(), size_t{1} << 20) != ARCHIVE_OK) {
    broken();
  }
  const uint64_t free_bytes = fs::space(temporary_).available;
  const uint64_t most =
      std::min(kMaxUnpackedBytes, free_bytes > kSpareDiskBytes ? free_bytes - kSpareDiskBytes : 0);
  const double megabytes = 1e-6 * static_cast<double>(fs::file_size(path));
  uint64_t unpacked = 0;
  struct archive_entry* entry = nullptr;
  int code;
  while ((code = archive_read_next_header(reader.get(), &entry)) == ARCHIVE_OK ||
         code == ARCHIVE_WARN) {
    const std::string name = entry_name(entry);
    check_entry(path, entry, name);
    const fs::path target = fs::path(temporary_) / name;
    if (archive_entry_filetype(entry) == AE_IFDIR) {
      fs::create_directories(target);
      continue;
    }
    fs::create_directories(target.parent_path());
    UnpackedFile file(target.string());
    const void* data = nullptr;
    size_t size = 0;
    la_int64_t offset = 0;
    while ((code = archive_read_data_block(reader.get(), &data, &size, &offset)) == ARCHIVE_OK) {
      // The offset counts too: a sparse file claims space without data.
      unpacked += size;
      if (std::max(unpacked, static_cast<uint64_t>(offset) + size) > most) {
        throw FileError(path, 0,
                        "unpacks to more than the " + std::to_string(most >> 20) +
                            " MiB that may be used in " + temporary_ +
                            "; free some space, or set TMPDIR to a larger disk");
      }
      file.write(static_cast<const char*>(data), size, offset);
      if (monitor.stop_requested()) {
        throw Interrupted("stopped while unpacking " + path +
                          "; run the same import again to go on");
      }
    }
    if (code != ARCHIVE_EOF) broken();
    monitor.report({"unpack " + archive_stem(path),
                    1e-6 * static_cast<double>(archive_filter_bytes(reader.get(), -1)), megabytes,
                    "MB"});
  }
  if (code != ARCHIVE_EOF) broken();
}

}  // namespace remomask::exchange
