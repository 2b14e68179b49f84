#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

namespace remomask::index {

/// Takes fields from the front of bytes, as faiss/impl/index_write.cpp lays them out. Every member
/// returns false where the bytes do not hold what is to be taken.
class LayoutWalk {
 public:
  explicit LayoutWalk(std::string_view bytes) : rest_(bytes) {}

  template <typename T>
  bool take(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }

  bool take_name(std::string_view& name) {
    name = rest_.substr(0, 4);
    return skip(4, 1);
  }

  bool skip(uint64_t count, uint64_t size) {
    if (count > rest_.size() / size) return false;
    rest_.remove_prefix(count * size);
    return true;
  }

  /// A vector of `count` values of `size` bytes, which says its own length before.
  bool skip_vector(uint64_t count, uint64_t size) {
    uint64_t stated = 0;
    return take(stated) && stated == count && skip(count, size);
  }

  /// A vector of at most `most` values.
  template <typename T>
  bool take_vector(std::vector<T>& values, uint64_t most = std::numeric_limits<uint64_t>::max()) {
    uint64_t count = 0;
    if (!take(count) || count > most || count > rest_.size() / sizeof(T)) return false;
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    return skip(count, sizeof(T));
  }

  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

}  // namespace remomask::index
