#pragma once

#include <string>

#include "remomask/progress.h"

namespace remomask::exchange {

/// Whether the name ends in .tar, .tar.xz, .tar.gz and so on.
bool is_archive_name(const std::string& path);

/// The name of an archive without folder and extensions ("bandai2").
std::string archive_stem(const std::string& path);

/// A tar archive, unpacked into a private temporary folder that is removed with this
/// object. Nothing is written outside of it: entries with absolute paths or
/// "..", links and devices are refused, and so is an archive that does not fit
/// on the disk.
class UnpackedArchive {
 public:
  /// Throws FileError for a damaged or malicious archive, and Interrupted if stopped.
  UnpackedArchive(const std::string& path, const Monitor& monitor);
  ~UnpackedArchive();
  UnpackedArchive(const UnpackedArchive&) = delete;
  UnpackedArchive& operator=(const UnpackedArchive&) = delete;

  /// The folder with the files: the only folder at the top level if there is exactly one.
  const std::string& folder() const { return folder_; }

 private:
  void unpack(const std::string& path, const Monitor& monitor);

  std::string temporary_, folder_;
};

}  // namespace remomask::exchange
