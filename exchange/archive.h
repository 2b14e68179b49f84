#pragma once

#include <string>

#include "remomask/progress.h"

namespace remomask::exchange {

/// True for names that end in .tar, .tar.xz, .tar.gz and so on.
bool is_archive_name(const std::string& path);

/// Name of an archive without folder and extensions ("bandai2").
std::string archive_stem(const std::string& path);

/// A tar archive, unpacked into a private temporary folder that goes with this
/// object. Nothing is written outside of it: entries with absolute paths or
/// "..", links and devices are refused, and so is an archive that does not fit
/// on the disk.
class UnpackedArchive {
 public:
  /// Throws FileError for a broken or malicious archive, Interrupted on a stop.
  UnpackedArchive(const std::string& path, const Monitor& monitor);
  ~UnpackedArchive();
  UnpackedArchive(const UnpackedArchive&) = delete;
  UnpackedArchive& operator=(const UnpackedArchive&) = delete;

  /// Where the files are: the only folder at the top of the archive, if it is so.
  const std::string& folder() const { return folder_; }

 private:
  void unpack(const std::string& path, const Monitor& monitor);

  std::string temporary_, folder_;
};

}  // namespace remomask::exchange
