#include "search/quantized_rows.h"

#include <algorithm>
#include <cmath>

namespace remomask::search {

namespace {

constexpr float kLargest = 127;
// Of the whole query: the sum over a row stays below 127 sqrt(width) of it, inside 32 bits up to
// widths of 16,000.
constexpr float kQueryLength = 1 << 15;

}  // namespace

QuantizedRows::QuantizedRows(const std::vector<float>& rows, int64_t width)
    : width_(width), rows_(rows.size()) {
  for (size_t first = 0; first < rows.size(); first += static_cast<size_t>(width)) {
    float most = 0;
    for (size_t i = first; i < first + static_cast<size_t>(width); ++i) {
      most = std::max(most, std::abs(rows[i]));
    }
    const float scale = most > 0 ? most / kLargest : 1;
    for (size_t i = first; i < first + static_cast<size_t>(width); ++i) {
      rows_[i] = static_cast<int8_t>(std::lround(rows[i] / scale));
    }
    scales_.push_back(scale);
  }
}

std::vector<float> QuantizedRows::products(const std::vector<float>& query) const {
  double square = 0;
  for (const float value : query) square += static_cast<double>(value) * value;
  const float step = square > 0 ? static_cast<float>(std::sqrt(square)) / kQueryLength : 1;
  std::vector<int16_t> rounded;
  for (const float value : query) {
    rounded.push_back(static_cast<int16_t>(std::clamp(std::lround(value / step), -32767L, 32767L)));
  }
  std::vector<float> products(scales_.size());
  const int8_t* row = rows_.data();
  const int16_t* const numbers = rounded.data();
  for (size_t i = 0; i < products.size(); ++i, row += width_) {
    int32_t sum = 0;
    for (int64_t j = 0; j < width_; ++j) sum += static_cast<int32_t>(row[j]) * numbers[j];
    products[i] = static_cast<float>(sum) * scales_[i] * step;
  }
  return products;
}

}  // namespace remomask::search
