#include "db/page_checksums.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

namespace remomask::db {

namespace {

constexpr const char* kName = "remomask-checksums";
constexpr int kExpect = 0x52434b01, kIgnore = 0x52434b02, kIsDamaged = 0x52434b03;
constexpr int kReadsOfPage = 3;
constexpr size_t kMostDamagedPages = 20;

// The header of a database (https://www.sqlite.org/fileformat.html).
constexpr char kMagic[] = "SQLite format 3";
constexpr int kHeaderBytes = 100, kSmallestPage = 512;
constexpr size_t kPageSizeAt = 16, kReservedAt = 20;
// SQLite locks bytes at this place and keeps the page around them empty.
constexpr int64_t kLockedByte = 0x40000000;

/// A file of SQLite that is a database. The file of the layer below follows it in memory.
struct CheckedFile {
  sqlite3_file base;
  int page_size;
  bool has_checksums;
  bool ignores_damage;
};

CheckedFile& checked(sqlite3_file* file) { return *reinterpret_cast<CheckedFile*>(file); }
sqlite3_file* below(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<CheckedFile*>(file) + 1);
}
sqlite3_vfs* below(sqlite3_vfs* vfs) { return static_cast<sqlite3_vfs*>(vfs->pAppData); }

uint64_t checksum(const unsigned char* page, int size, int64_t offset) {
  return XXH3_64bits_withSeed(page, static_cast<size_t>(size - kPageChecksumBytes),
                              static_cast<uint64_t>(offset / size));
}

bool is_intact(const unsigned char* page, int size, int64_t offset) {
  uint64_t stored = 0;
  std::memcpy(&stored, page + size - kPageChecksumBytes, sizeof stored);
  if (stored == checksum(page, size, offset)) return true;
  // A hole that the file system made: SQLite has not yet written this page.
  return std::all_of(page, page + size, [](unsigned char byte) { return byte == 0; });
}

/// Takes what matters from the first bytes of a database. Checksums never go away again, as SQLite
/// never gives back what it has reserved.
void follow_header(CheckedFile& file, const unsigned char* header) {
  if (std::memcmp(header, kMagic, sizeof kMagic) != 0) return;
  const int size = header[kPageSizeAt] << 8 | header[kPageSizeAt + 1];
  file.page_size = size == 1 ? 65536 : size;
  if (header[kReservedAt] == kPageChecksumBytes) file.has_checksums = true;
}

bool is_page(const CheckedFile& file, int count, int64_t offset) {
  return file.page_size > kPageChecksumBytes && count == file.page_size &&
         offset % file.page_size == 0;
}

/// Of a part of a page behind the first one, which some versions of SQLite read.
int check_page_around(sqlite3_file* file, int64_t offset) {
  const int size = checked(file).page_size;
  if (size <= kPageChecksumBytes || offset < size) return SQLITE_OK;
  std::vector<unsigned char> page(static_cast<size_t>(size));
  const int64_t start = offset - offset % size;
  const int code = below(file)->pMethods->xRead(below(file), page.data(), size, start);
  if (code != SQLITE_OK) return code;
  return is_intact(page.data(), size, start) ? SQLITE_OK : SQLITE_IOERR_DATA;
}

int read(sqlite3_file* file, void* target, int count, sqlite3_int64 offset) {
  const int code = below(file)->pMethods->xRead(below(file), target, count, offset);
  if (code != SQLITE_OK) return code;
  CheckedFile& self = checked(file);
  const auto* bytes = static_cast<const unsigned char*>(target);
  if (offset == 0 && count >= kHeaderBytes) follow_header(self, bytes);
  if (!self.has_checksums || self.ignores_damage) return SQLITE_OK;
  if (!is_page(self, count, offset)) return check_page_around(file, offset);
  return is_intact(bytes, count, offset) ? SQLITE_OK : SQLITE_IOERR_DATA;
}

int write(sqlite3_file* file, const void* source, int count, sqlite3_int64 offset) {
  CheckedFile& self = checked(file);
  const auto* bytes = static_cast<const unsigned char*>(source);
  if (offset == 0 && count >= kHeaderBytes) {
    follow_header(self, bytes);
  } else if (!self.has_checksums) {
    // Another program may have upgraded the file since it was opened here.
    unsigned char header[kHeaderBytes];
    if (below(file)->pMethods->xRead(below(file), header, kHeaderBytes, 0) == SQLITE_OK) {
      follow_header(self, header);
    }
  }
  // A copy into a new file writes pages before the header has said how long they are.
  const bool page = self.page_size == 0 ? count >= kSmallestPage : is_page(self, count, offset);
  if (!self.has_checksums || !page) {
    return below(file)->pMethods->xWrite(below(file), source, count, offset);
  }
  thread_local std::vector<unsigned char> copy;
  copy.assign(bytes, bytes + count);
  const uint64_t sum = checksum(copy.data(), count, offset);
  std::memcpy(copy.data() + count - kPageChecksumBytes, &sum, sizeof sum);
  return below(file)->pMethods->xWrite(below(file), copy.data(), count, offset);
}

/// Reads again what does not fit: another program may just be writing it.
bool is_damaged(sqlite3_file* file, int64_t offset) {
  const CheckedFile& self = checked(file);
  std::vector<unsigned char> page(static_cast<size_t>(self.page_size));
  for (int i = 0; i < kReadsOfPage; ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const int code = below(file)->pMethods->xRead(below(file), page.data(), self.page_size, offset);
    if (code == SQLITE_OK && is_intact(page.data(), self.page_size, offset)) return false;
  }
  return true;
}

void find_damaged_pages(sqlite3_file* file, std::vector<int64_t>& pages) {
  const CheckedFile& self = checked(file);
  sqlite3_int64 bytes = 0;
  if (!self.has_checksums || self.page_size <= kPageChecksumBytes ||
      below(file)->pMethods->xFileSize(below(file), &bytes) != SQLITE_OK) {
    return;
  }
  for (int64_t offset = 0; offset < bytes && pages.size() < kMostDamagedPages;
       offset += self.page_size) {
    if (offset <= kLockedByte && kLockedByte < offset + self.page_size) continue;
    if (is_damaged(file, offset)) pages.push_back(offset / self.page_size + 1);
  }
}

int file_control(sqlite3_file* file, int operation, void* argument) {
  switch (operation) {
    case kExpect:
      checked(file).has_checksums = true;
      return SQLITE_OK;
    case kIgnore:
      checked(file).ignores_damage = true;
      return SQLITE_OK;
    case kIsDamaged:
      find_damaged_pages(file, *static_cast<std::vector<int64_t>*>(argument));
      return SQLITE_OK;
    default:
      return below(file)->pMethods->xFileControl(below(file), operation, argument);
  }
}

/// Hands a call to the layer below.
template <auto Member, typename... Arguments>
int pass(sqlite3_file* file, Arguments... arguments) {
  return (below(file)->pMethods->*Member)(below(file), arguments...);
}

template <auto Member, typename Result, typename... Arguments>
Result pass_vfs(sqlite3_vfs* vfs, Arguments... arguments) {
  return (below(vfs)->*Member)(below(vfs), arguments...);
}

int close(sqlite3_file* file) { return pass<&sqlite3_io_methods::xClose>(file); }

/// Version 2 of the methods: without mapped files, of which no read would come through here.
const sqlite3_io_methods& methods() {
  using Methods = sqlite3_io_methods;
  static const Methods all = [] {
    Methods made{};
    made.iVersion = 2;
    made.xClose = close;
    made.xRead = read;
    made.xWrite = write;
    made.xTruncate = pass<&Methods::xTruncate>;
    made.xSync = pass<&Methods::xSync>;
    made.xFileSize = pass<&Methods::xFileSize>;
    made.xLock = pass<&Methods::xLock>;
    made.xUnlock = pass<&Methods::xUnlock>;
    made.xCheckReservedLock = pass<&Methods::xCheckReservedLock>;
    made.xFileControl = file_control;
    made.xSectorSize = pass<&Methods::xSectorSize>;
    made.xDeviceCharacteristics = pass<&Methods::xDeviceCharacteristics>;
    made.xShmMap = pass<&Methods::xShmMap>;
    made.xShmLock = pass<&Methods::xShmLock>;
    made.xShmBarrier = [](sqlite3_file* file) { below(file)->pMethods->xShmBarrier(below(file)); };
    made.xShmUnmap = pass<&Methods::xShmUnmap>;
    return made;
  }();
  return all;
}

int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* flags_out) {
  sqlite3_vfs* const real = below(vfs);
  // Logs and temporary files have no pages, or checksums of their own.
  if ((flags & SQLITE_OPEN_MAIN_DB) == 0) return real->xOpen(real, name, file, flags, flags_out);
  std::memset(file, 0, sizeof(CheckedFile));
  const int code = real->xOpen(real, name, below(file), flags, flags_out);
  // SQLite closes a file that has methods, even if it could not be opened.
  if (below(file)->pMethods != nullptr) file->pMethods = &methods();
  return code;
}

sqlite3_vfs make_vfs() {
  sqlite3_vfs* const real = sqlite3_vfs_find(nullptr);
  sqlite3_vfs vfs{};
  vfs.iVersion = 2;
  vfs.szOsFile = static_cast<int>(sizeof(CheckedFile)) + real->szOsFile;
  vfs.mxPathname = real->mxPathname;
  vfs.zName = kName;
  vfs.pAppData = real;
  using Vfs = sqlite3_vfs;
  vfs.xOpen = open;
  vfs.xDelete = pass_vfs<&Vfs::xDelete, int>;
  vfs.xAccess = pass_vfs<&Vfs::xAccess, int>;
  vfs.xFullPathname = pass_vfs<&Vfs::xFullPathname, int>;
  vfs.xRandomness = pass_vfs<&Vfs::xRandomness, int>;
  vfs.xSleep = pass_vfs<&Vfs::xSleep, int>;
  vfs.xCurrentTime = pass_vfs<&Vfs::xCurrentTime, int>;
  vfs.xGetLastError = pass_vfs<&Vfs::xGetLastError, int>;
  vfs.xCurrentTimeInt64 = pass_vfs<&Vfs::xCurrentTimeInt64, int>;
  return vfs;
}

}  // namespace

const char* page_checksum_vfs() {
  static sqlite3_vfs vfs = make_vfs();
  static const int registered = sqlite3_vfs_register(&vfs, /*makeDflt=*/0);
  return registered == SQLITE_OK ? kName : nullptr;
}

void reserve_page_checksums(sqlite3* connection) {
  int bytes = kPageChecksumBytes;
  sqlite3_file_control(connection, "main", SQLITE_FCNTL_RESERVE_BYTES, &bytes);
}

bool has_page_checksums(sqlite3* connection) {
  int bytes = -1;  // asks only
  sqlite3_file_control(connection, "main", SQLITE_FCNTL_RESERVE_BYTES, &bytes);
  return bytes == kPageChecksumBytes;
}

void expect_page_checksums(sqlite3* connection) {
  sqlite3_file_control(connection, "main", kExpect, nullptr);
}

void ignore_page_checksums(sqlite3* connection) {
  sqlite3_file_control(connection, "main", kIgnore, nullptr);
}

std::vector<int64_t> damaged_pages(sqlite3* connection) {
  std::vector<int64_t> pages;
  sqlite3_file_control(connection, "main", kIsDamaged, &pages);
  return pages;
}

}  // namespace remomask::db
