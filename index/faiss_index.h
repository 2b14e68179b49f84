#pragma once

#include <faiss/IndexIDMap.h>

#include <memory>
#include <string>
#include <vector>

#include "index/vector_index.h"
#include "remomask/progress.h"

namespace remomask::index {

/// The type that "auto" means for this many vectors: "Flat" below 500,000, otherwise "IVF<n>,Flat",
/// where n is the power of two nearest to 2 sqrt(count), from 1,024 to 16,384. Other types are
/// returned unchanged.
std::string resolve_factory(const std::string& requested, int64_t count);

/// A FAISS index of `vectors` [ids][width], trained and filled. Throws Error for a type that FAISS
/// cannot build from them, and Interrupted.
std::unique_ptr<faiss::IndexIDMap2> build_faiss_index(const std::vector<int64_t>& ids,
                                                      const float* vectors, int width,
                                                      const IndexType& type,
                                                      const Monitor& monitor);

}  // namespace remomask::index
