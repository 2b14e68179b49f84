#include "base/hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

#include "base/content_hasher.h"

namespace remomask {

namespace {

std::string as_text(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace

std::string content_hash(std::string_view content) {
  return as_text(XXH3_128bits(content.data(), content.size()));
}

struct ContentHasher::State {
  State() {
    if (!state) throw std::bad_alloc();
    XXH3_128bits_reset(state);
  }
  ~State() { XXH3_freeState(state); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  XXH3_state_t* const state = XXH3_createState();
};

ContentHasher::ContentHasher() : state_(std::make_unique<State>()) {}
ContentHasher::~ContentHasher() = default;
void ContentHasher::add(std::string_view piece) {
  XXH3_128bits_update(state_->state, piece.data(), piece.size());
}
std::string ContentHasher::hash() const { return as_text(XXH3_128bits_digest(state_->state)); }

}  // namespace remomask
