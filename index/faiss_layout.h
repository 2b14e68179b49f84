#pragma once

#include <cstdint>
#include <string_view>

namespace remomask::index {

/// What an index file says that its FAISS index holds.
struct FaissSize {
  int64_t count = 0;
  int width = 0;
};

/// Walks through the bytes of a serialised FAISS index before FAISS reads them, since FAISS
/// allocates what the bytes claim: every count, width and size must fit `expected` and the bytes.
/// `with_ids`: an IndexIDMap2 over one of the other types. Flat, IVF,Flat and HNSW
/// are walked to their end; of other types only the header is looked at. Returns false for bytes
/// that do not fit.
bool fits_layout(std::string_view bytes, const FaissSize& expected, bool with_ids);

}  // namespace remomask::index
