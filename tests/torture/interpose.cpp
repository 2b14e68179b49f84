// Loaded before libc into the program under test: counts the calls that change files, and lets
// one of them fail. REMOMASK_CALL=N chooses the N-th call, REMOMASK_FAULT what happens there:
// "kill" (SIGKILL with half of a write done) or "full" (this and all later writes find the disk
// full). REMOMASK_CALLS names a file for the number of calls. REMOMASK_CLOCK_STEP=SECONDS lets the
// clock go on by so much at every look at it.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

template <typename Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

long chosen_call() {
  static const char* text = std::getenv("REMOMASK_CALL");
  static const long number = text != nullptr ? std::atol(text) : -1;
  return number;
}

bool is_full_disk() {
  static const char* fault = std::getenv("REMOMASK_FAULT");
  return fault != nullptr && std::strcmp(fault, "full") == 0;
}

bool is_file(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

/// True if this call is to fail for lack of space; does not return if the program is to die here.
template <typename Half>
bool meets_fault(bool writes, const Half& half) {
  const long call = ++calls;
  if (chosen_call() < 0) return false;
  if (is_full_disk()) return writes && call >= chosen_call();
  if (call != chosen_call()) return false;
  half();
  kill(getpid(), SIGKILL);
  pause();
  return false;
}

void nothing() {}

struct Report {
  ~Report() {
    const char* path = std::getenv("REMOMASK_CALLS");
    if (path == nullptr) return;
    const long count = calls;
    if (FILE* file = std::fopen(path, "w")) {
      std::fprintf(file, "%ld", count);
      std::fclose(file);
    }
  }
} report;

ssize_t checked_pwrite(const char* name, int descriptor, const void* data, size_t size,
                       off_t offset) {
  using Call = ssize_t(int, const void*, size_t, off_t);
  static Call* const call = original<Call>(name);
  if (is_file(descriptor) && meets_fault(true, [&] { call(descriptor, data, size / 2, offset); })) {
    errno = ENOSPC;
    return -1;
  }
  return call(descriptor, data, size, offset);
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* data, size_t size) {
  using Call = ssize_t(int, const void*, size_t);
  static Call* const call = original<Call>("write");
  if (is_file(descriptor) && meets_fault(true, [&] { call(descriptor, data, size / 2); })) {
    errno = ENOSPC;
    return -1;
  }
  return call(descriptor, data, size);
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  return checked_pwrite("pwrite", descriptor, data, size, offset);
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off_t offset) {
  return checked_pwrite("pwrite64", descriptor, data, size, offset);
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
  using Call = ssize_t(int, const iovec*, int);
  static Call* const call = original<Call>("writev");
  if (is_file(descriptor) && meets_fault(true, [&] { call(descriptor, pieces, count / 2); })) {
    errno = ENOSPC;
    return -1;
  }
  return call(descriptor, pieces, count);
}

int ftruncate(int descriptor, off_t size) {
  using Call = int(int, off_t);
  static Call* const call = original<Call>("ftruncate");
  meets_fault(false, nothing);
  return call(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) {
  using Call = int(int, off64_t);
  static Call* const call = original<Call>("ftruncate64");
  meets_fault(false, nothing);
  return call(descriptor, size);
}

int mkdir(const char* path, mode_t mode) {
  using Call = int(const char*, mode_t);
  static Call* const call = original<Call>("mkdir");
  meets_fault(false, nothing);
  return call(path, mode);
}

int unlinkat(int folder, const char* path, int flags) {
  using Call = int(int, const char*, int);
  static Call* const call = original<Call>("unlinkat");
  meets_fault(false, nothing);
  return call(folder, path, flags);
}

int remove(const char* path) {
  using Call = int(const char*);
  static Call* const call = original<Call>("remove");
  meets_fault(false, nothing);
  return call(path);
}

int clock_gettime(clockid_t clock, timespec* time) {
  using Call = int(clockid_t, timespec*);
  static Call* const call = original<Call>("clock_gettime");
  static const char* text = std::getenv("REMOMASK_CLOCK_STEP");
  static const long step = text != nullptr ? std::atol(text) : 0;
  static std::atomic<long> looks{0};
  const int result = call(clock, time);
  if (step > 0 && clock == CLOCK_MONOTONIC) time->tv_sec += step * ++looks;
  return result;
}

int fsync(int descriptor) {
  using Call = int(int);
  static Call* const call = original<Call>("fsync");
  meets_fault(false, nothing);
  return call(descriptor);
}

int fdatasync(int descriptor) {
  using Call = int(int);
  static Call* const call = original<Call>("fdatasync");
  meets_fault(false, nothing);
  return call(descriptor);
}

int rename(const char* from, const char* to) {
  using Call = int(const char*, const char*);
  static Call* const call = original<Call>("rename");
  meets_fault(false, nothing);
  return call(from, to);
}

int unlink(const char* path) {
  using Call = int(const char*);
  static Call* const call = original<Call>("unlink");
  meets_fault(false, nothing);
  return call(path);
}

}  // extern "C"
