#pragma once

#include <stdexcept>
#include <string>

#include "remomask/export.h"

namespace remomask {

/// An error that a user can cause and mend: a broken file, a wrong option, a
/// full disk. The message says what happened, where (file, line, clip), and
/// what to do. Programming errors are assertions instead.
class REMOMASK_API Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : std::runtime_error(message) {}
};

/// Bad content of a file; `line` counts from 1, 0 means that no line applies.
class REMOMASK_API FileError : public Error {
 public:
  FileError(std::string path, long line, const std::string& message)
      : Error(path + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + message),
        path_(std::move(path)),
        line_(line) {}
  const std::string& path() const { return path_; }
  long line() const { return line_; }

 private:
  std::string path_;
  long line_;
};

/// The caller asked to stop. Work up to the last checkpoint is kept. Not an Error, so that code
/// that reports errors and continues does not continue after a stop.
class REMOMASK_API Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace remomask
