#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <vector>

namespace remomask::db {

/// Since format 7 every page of a database ends with a checksum of it, where SQLite leaves room if
/// it is asked to ("reserved bytes"). A layer between SQLite and the file system writes and
/// compares it, so that no byte of the file, of whatever table, index or list, can change without
/// being noticed when it is read. Other programs read such a file as any other; pages that they
/// write have no checksum that fits.
constexpr int kPageChecksumBytes = 8;

/// Name of that layer (a VFS of SQLite) for sqlite3_open_v2(); registers it.
const char* page_checksum_vfs();

/// Lets a new, empty database have checksums.
void reserve_page_checksums(sqlite3* connection);
/// Whether the file has them, once SQLite has read its first page.
bool has_page_checksums(sqlite3* connection);
/// Before pages with checksums are copied into a new file, of which SQLite may write others first
/// than the one that says so.
void expect_page_checksums(sqlite3* connection);
/// Takes pages as they are from now on; those that are written get checksums.
void ignore_page_checksums(sqlite3* connection);

/// Numbers of the first pages in the file that do not fit their checksums, unused ones included;
/// not those that lie only in the log beside it.
std::vector<int64_t> damaged_pages(sqlite3* connection);

}  // namespace remomask::db
