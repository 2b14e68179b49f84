#pragma once

#include <faiss/Index.h>
#include <faiss/IndexFlat.h>
#include <faiss/IndexIDMap.h>

#include <memory>
#include <string>

#include "index/vector_index.h"

namespace remomask {

/// What one index file holds. Layout: the FAISS index; for approximate types
/// the exact vectors as an IndexFlat; a JSON text with the stamp, the sizes and
/// a checksum; its length (8 bytes, little-endian); 8 bytes "RMMINDEX". The
/// description is at the end so that FAISS itself can read the file.
struct IndexFile {
  IndexStamp stamp;
  std::string factory;
  std::unique_ptr<faiss::IndexIDMap2> index;
  std::unique_ptr<faiss::IndexFlat> exact;  ///< null when `index` holds a Flat itself
};

/// Writes atomically. Throws FileError.
void write_index_file(const std::string& path, const IndexStamp& stamp, const std::string& factory,
                      const faiss::IndexIDMap2& index, const faiss::IndexFlat* exact);

/// Throws FileError when the file is missing, cut off, damaged or made by a
/// newer program.
IndexFile read_index_file(const std::string& path);

}  // namespace remomask
