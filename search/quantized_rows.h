#pragma once

#include <cstdint>
#include <vector>

namespace remomask::search {

/// Rows of numbers rounded to one byte each, for inner products with all of them: a quarter of the
/// bytes of floats, which is what takes the time. Of rows of length 1 and
/// some hundreds of numbers the error is about 0.0005.
class QuantizedRows {
 public:
  QuantizedRows() = default;
  /// `rows` [count][width], finite.
  QuantizedRows(const std::vector<float>& rows, int64_t width);

  /// Approximate inner products of `query` [width] with every row.
  std::vector<float> products(const std::vector<float>& query) const;

 private:
  int64_t width_ = 0;
  std::vector<int8_t> rows_;
  std::vector<float> scales_;  // of each row
};

}  // namespace remomask::search
