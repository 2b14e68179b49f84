#include "tests/fuzz/mutator.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace remomask {

namespace {

constexpr const char* kWords[] = {"-1",
                                  "0",
                                  "1e309",
                                  "nan",
                                  "99999999999999999999",
                                  "2305843009213693952",
                                  "4294967296",
                                  "{",
                                  "[",
                                  "\"",
                                  "\n",
                                  "\r",
                                  "\\u0000",
                                  "\xff\xfe",
                                  "ROOT x",
                                  "#",
                                  ""};

/// At and beside the limits of counts and offsets.
constexpr uint64_t kNumbers[] = {0,          1,          127,        128,        255,        65535,
                                 0x7fffffff, 0x80000000, 0xffffffff, 1ull << 32, 1ull << 62, ~0ull};

}  // namespace

std::string Mutator::input(uint64_t number) {
  if (number < seeds_.size()) return seeds_[number];
  return changed(seeds_[number % seeds_.size()], number);
}

std::string Mutator::changed(std::string content, uint64_t number) {
  // Neighbouring seeds of this generator begin with neighbouring numbers.
  random_.seed(static_cast<uint32_t>((number + 1) * 0x9e3779b97f4a7c15ull >> 32));
  random_.discard(2);
  for (size_t i = 0, count = 1 + below(4); i < count && !content.empty(); ++i) change(content);
  return content;
}

void Mutator::change(std::string& content) {
  const size_t at = below(content.size());
  const size_t length = 1 + below(std::min<size_t>(64, content.size() - at));
  switch (below(9)) {
    case 0:
      content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
      break;
    case 1:
      content.resize(at);
      break;
    case 2:
      content.erase(at, length);
      break;
    case 3:
      content.insert(at, content.substr(below(content.size()), length));
      break;
    case 4:
      content.replace(at, length, kWords[below(std::size(kWords))]);
      break;
    case 5:
      std::fill_n(content.begin() + static_cast<std::ptrdiff_t>(at), std::min<size_t>(length, 8),
                  '\xff');
      break;
    case 6:
      std::fill_n(content.begin() + static_cast<std::ptrdiff_t>(at), std::min<size_t>(length, 8),
                  '\0');
      break;
    case 7: {
      const uint64_t value = kNumbers[below(std::size(kNumbers))];
      const size_t bytes = std::min(content.size() - at, size_t{1} << below(4));
      std::memcpy(content.data() + at, &value, bytes);
      break;
    }
    default: {
      const std::string& other = seeds_[below(seeds_.size())];
      if (other.empty()) break;
      const size_t from = below(other.size());
      content.replace(at, length, other, from, length);
    }
  }
}

}  // namespace remomask
