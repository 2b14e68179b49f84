#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace remomask {

/// Whole content of a file. Throws FileError when it cannot be read.
std::string read_file(const std::string& path);

/// Writes `content` so that `path` holds either its old content or all of the
/// new one, whatever happens meanwhile: temporary name beside it, fsync,
/// rename. Throws FileError (disk full, no permission); the old file stays.
void write_file_atomically(const std::string& path, std::string_view content);

/// The same for a library that writes to a path itself: write to
/// `temporary_path()`, then `commit()`. Without commit the temporary is removed.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& temporary_path() const { return temporary_; }
  void commit();

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

}  // namespace remomask
