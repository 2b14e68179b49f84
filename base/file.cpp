#include "base/file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

#include "base/bounded_file.h"
#include "base/leftovers.h"
#include "remomask/error.h"

namespace remomask {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t kFirstPiece = 4096;
constexpr uint64_t kMaxPipeBytes = uint64_t{1} << 28;
constexpr int kWriterMilliseconds = 3000;

std::string errno_text() { return std::strerror(errno); }

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// First byte of a pipe that was opened without waiting, nothing if it is empty. Reads block again
/// from here on: a writer that is there has the time that it needs.
std::string first_of_pipe(int descriptor, const std::string& path) {
  pollfd wait{descriptor, POLLIN, 0};
  ::poll(&wait, 1, kWriterMilliseconds);
  char byte = 0;
  const ssize_t count = ::read(descriptor, &byte, 1);
  if (count == 0 && (wait.revents & POLLHUP) == 0) {
    throw FileError(path, 0, "is a pipe into which nothing writes; start its writer first");
  }
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  return count == 1 ? std::string(1, byte) : std::string();
}

void sync_path(const std::string& path, int flags) {
  Descriptor descriptor(::open(path.c_str(), flags));
  if (descriptor.get() >= 0) ::fsync(descriptor.get());
}

}  // namespace

std::string read_bounded_file(const std::string& path, uint64_t max_bytes) {
  // Opening a pipe would wait for its writer, who may never come.
  Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (descriptor.get() < 0) throw FileError(path, 0, "cannot open: " + errno_text());
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0 || S_ISDIR(status.st_mode)) {
    throw FileError(path, 0, "is not a readable file");
  }
  // A file has an end; a device or a pipe may not have one.
  if (!S_ISREG(status.st_mode)) max_bytes = std::min(max_bytes, kMaxPipeBytes);
  const auto refuse = [&] {
    throw FileError(path, 0,
                    "holds more than " + std::to_string(max_bytes >> 20) +
                        " MiB, the most that is read of one file of this kind; cut it into "
                        "shorter pieces");
  };
  const auto stated = static_cast<uint64_t>(std::max<off_t>(status.st_size, 0));
  if (stated > max_bytes) refuse();
  // One byte more than is there finds the end without another allocation.
  std::string content(std::max<uint64_t>(stated + 1, kFirstPiece), '\0');
  size_t done = 0;
  if (S_ISFIFO(status.st_mode)) {
    const std::string first = first_of_pipe(descriptor.get(), path);
    content.replace(0, first.size(), first);
    done = first.size();
  }
  while (true) {
    if (done == content.size()) {
      content.resize(done + std::min<uint64_t>(done, max_bytes - done + 1));
    }
    const ssize_t count = ::read(descriptor.get(), content.data() + done, content.size() - done);
    if (count < 0) {
      if (errno == EINTR) continue;
      throw FileError(path, 0, "cannot read: " + errno_text());
    }
    if (count == 0) break;
    done += static_cast<size_t>(count);
    if (done > max_bytes) refuse();
  }
  content.resize(done);
  return content;
}

std::string read_file(const std::string& path) {
  return read_bounded_file(path, std::numeric_limits<uint64_t>::max());
}

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  const fs::path parent = fs::path(path_).parent_path();
  if (!parent.empty() && !fs::is_directory(parent)) {
    throw FileError(path_, 0, "the folder does not exist; create it or choose another output");
  }
  remove_leftovers(parent.empty() ? "." : parent.string(), kTemporaryMarker);
  temporary_ = path_ + kTemporaryMarker + process_tag();
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  // SQLite makes further files beside a database that is written to the temporary name.
  for (const char* ending : {"", "-journal", "-wal", "-shm"}) {
    ::unlink((temporary_ + ending).c_str());
  }
}

void AtomicFile::commit(Durability durability) {
  if (durability == Durability::power_cuts) sync_path(temporary_, O_RDONLY);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) {
    throw FileError(path_, 0, "cannot replace: " + errno_text());
  }
  committed_ = true;
  if (durability == Durability::kills) return;
  const fs::path parent = fs::path(path_).parent_path();
  sync_path(parent.empty() ? "." : parent.string(), O_RDONLY | O_DIRECTORY);
}

void write_file_atomically(const std::string& path, std::string_view content,
                           Durability durability) {
  AtomicFile file(path);
  {
    Descriptor descriptor(
        ::open(file.temporary_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
    if (descriptor.get() < 0) throw FileError(path, 0, "cannot write: " + errno_text());
    size_t done = 0;
    while (done < content.size()) {
      const ssize_t count = ::write(descriptor.get(), content.data() + done, content.size() - done);
      if (count < 0) {
        if (errno == EINTR) continue;
        throw FileError(path, 0, "cannot write: " + errno_text() + "; the old file was kept");
      }
      done += static_cast<size_t>(count);
    }
  }
  file.commit(durability);
}

}  // namespace remomask
