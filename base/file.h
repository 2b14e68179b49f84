#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace remomask {

/// Whole content of a file. Throws FileError if it cannot be read.
std::string read_file(const std::string& path);

/// Whether the call that writes a file waits until it is on the disk. Either way a kill
/// leaves the old or the new file; without the wait a power cut may truncate it, which
/// is acceptable for files that can be made again and whose damage is noticed.
enum class Durability { power_cuts, kills };

/// Writes `content` so that `path` holds either its old content or all of the
/// new content, whatever happens in between: temporary file beside it, fsync,
/// rename. Throws FileError (disk full, no permission); the old file stays.
void write_file_atomically(const std::string& path, std::string_view content,
                           Durability durability = Durability::power_cuts);

/// The same for a library that writes to a path itself: write to
/// `temporary_path()`, then `commit()`. Without commit the temporary is removed. The first one in a
/// folder also removes the temporary files that killed processes left there.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  const std::string& temporary_path() const { return temporary_; }
  void commit(Durability durability = Durability::power_cuts);

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

}  // namespace remomask
