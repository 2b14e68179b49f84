#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace remomask {

/// Makes broken files out of sound ones. The same number gives the same input on every machine, so
/// that a long run can be cut into pieces, and an input that breaks a reader can be made again.
class Mutator {
 public:
  /// `seeds`: at least one file that is read.
  explicit Mutator(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {}

  /// Input number 0, 1, ...: the seeds as they are, then changed ones.
  std::string input(uint64_t number);
  /// A changed copy of `content`.
  std::string changed(std::string content, uint64_t number);

 private:
  size_t below(size_t limit) { return random_() % limit; }
  void change(std::string& content);

  std::vector<std::string> seeds_;
  std::minstd_rand random_;  // cheaper to seed than the Mersenne Twister, and each input seeds it
};

}  // namespace remomask
