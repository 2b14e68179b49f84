#include "search/quantized_rows.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

void expect_near_products(const std::vector<float>& rows, int width,
                          const std::vector<float>& query, double tolerance) {
  const auto rough = search::QuantizedRows(rows, width).products(query);
  ASSERT_EQ(rough.size() * static_cast<size_t>(width), rows.size());
  for (size_t i = 0; i < rough.size(); ++i) {
    const float* row = rows.data() + i * static_cast<size_t>(width);
    EXPECT_NEAR(rough[i], std::inner_product(query.begin(), query.end(), row, 0.0), tolerance);
  }
}

TEST(QuantizedRowsTest, ProductsOfDirectionsAreNearlyRight) {
  for (const int width : {1, 7, 24, 384, 1000}) {
    const auto rows = random_directions(500, width, 3);
    // The steps of a number grow with the largest one, which falls with the width.
    const double tolerance = width < 100 ? 0.01 : 0.003;
    expect_near_products(rows, width, random_directions(1, width, 4), tolerance);
    // A row with itself: the largest product there is.
    expect_near_products(rows, width, {rows.begin(), rows.begin() + width}, tolerance);
  }
}

TEST(QuantizedRowsTest, RowsMayBeFlatSteepOrNothing) {
  const int width = 1024;
  std::vector<float> rows(3 * width, 0.f);
  std::fill_n(rows.begin(), width, 1.f / 32);  // the greatest sum of whole numbers
  rows[static_cast<size_t>(width)] = 1;
  const std::vector<float> flat(rows.begin(), rows.begin() + width);
  expect_near_products(rows, width, flat, 0.003);
  expect_near_products(rows, width, std::vector<float>(static_cast<size_t>(width)), 1e-9);
  EXPECT_TRUE(search::QuantizedRows().products({}).empty());
}

}  // namespace
}  // namespace remomask
