#pragma once

#include <faiss/IndexFlat.h>
#include <faiss/IndexIDMap.h>

#include <memory>
#include <string>
#include <vector>

#include "index/vector_index.h"

namespace remomask::index {

/// What an index file says about itself.
struct IndexHeader {
  IndexStamp stamp;
  IndexType type;
  int width = 0;
  std::vector<int64_t> ids;  ///< of the rows, ascending
  std::string checksum;      ///< of everything that can be searched: its identity
};

/// A whole index file. Its body: the FAISS index (IDMap2, ids last); for
/// approximate types the exact vectors as an IndexFlat.
struct IndexFile {
  IndexHeader header;
  std::unique_ptr<faiss::IndexIDMap2> index;
  std::unique_ptr<faiss::IndexFlat> exact;  ///< null if `index` is a Flat itself
};

/// Writes the file atomically and returns the checksum. Throws FileError.
std::string write_index_file(const std::string& path, const IndexStamp& stamp,
                             const IndexType& type, const faiss::IndexIDMap2& index,
                             const faiss::IndexFlat* exact);

/// Throws FileError if the file is missing, truncated, damaged or made by a newer program.
IndexFile read_index_file(const std::string& path);

/// The same without the vectors, which are neither read nor checked: takes milliseconds for any
/// size.
IndexHeader read_index_header(const std::string& path);

}  // namespace remomask::index
