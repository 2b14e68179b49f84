#include "formats/npy.h"

#include <gtest/gtest.h>

#include <cstring>

#include "remomask/error.h"

namespace remomask {

namespace {

template <typename Number>
std::string npy_file(int version, const std::string& header, const std::vector<Number>& numbers) {
  std::string content = "\x93NUMPY";
  content += static_cast<char>(version);
  content += '\0';
  const int size_bytes = version == 1 ? 2 : 4;
  for (int i = 0; i < size_bytes; ++i) {
    content += static_cast<char>(header.size() >> (8 * i) & 255);
  }
  content += header;
  content.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  return content;
}

std::string header_of(const std::string& type, const std::string& order, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': (" + shape + "), }\n";
}

}  // namespace

TEST(Npy, ReadsTypesVersionsAndOrders) {
  const std::vector<float> f4 = {1, 2, 3, 4, 5, 6};
  const std::vector<double> f8 = {1, 2, 3, 4, 5, 6};
  for (const int version : {1, 2, 3}) {
    const formats::NpyArray c =
        formats::parse_npy(npy_file(version, header_of("<f4", "False", "2, 3"), f4), "a");
    EXPECT_EQ(c.shape, (std::vector<size_t>{2, 3}));
    EXPECT_EQ(c.values, f4);
    const formats::NpyArray d =
        formats::parse_npy(npy_file(version, header_of("<f8", "False", "6,"), f8), "a");
    EXPECT_EQ(d.shape, (std::vector<size_t>{6}));
    EXPECT_EQ(d.values, f4);
  }
  const formats::NpyArray fortran =
      formats::parse_npy(npy_file(1, header_of("<f8", "True", "2, 3"), f8), "a");
  EXPECT_EQ(fortran.values, (std::vector<float>{1, 3, 5, 2, 4, 6}));
}

TEST(Npy, ReadsHalvesWholeNumbersAndBigEndian) {
  const auto values = [](const std::string& type, const auto& numbers) {
    return formats::parse_npy(npy_file(1, header_of(type, "False", "3"), numbers), "a").values;
  };
  const std::vector<float> expected = {1, -2, 0.5f};
  EXPECT_EQ(values("<f2", std::vector<uint16_t>{0x3C00, 0xC000, 0x3800}), expected);
  EXPECT_EQ(values(">f2", std::vector<uint16_t>{0x003C, 0x00C0, 0x0038}), expected);
  EXPECT_EQ(values("<f2", std::vector<uint16_t>{0x0001, 0x7BFF, 0x8000}),
            (std::vector<float>{0x1p-24f, 65504, -0.f}));
  EXPECT_EQ(values(">f4", std::vector<uint32_t>{0x0000803F, 0x000000C0, 0x0000003F}), expected);
  EXPECT_EQ(values(">f8", std::vector<uint64_t>{0xF03F, 0x00C0, 0xE03F}), expected);
  const std::vector<float> whole = {1, 2, 250};
  EXPECT_EQ(values("|u1", std::vector<uint8_t>{1, 2, 250}), whole);
  EXPECT_EQ(values("<i8", std::vector<int64_t>{1, 2, 250}), whole);
  EXPECT_EQ(values(">u2", std::vector<uint16_t>{0x0100, 0x0200, 0xFA00}), whole);
}

TEST(Npy, WrittenFilesReadBack) {
  for (const std::vector<size_t>& shape : {std::vector<size_t>{6}, {2, 3}, {1, 2, 3}, {0, 22, 3}}) {
    formats::NpyArray array{shape, {1, 2, 3, 4, 5, 6}};
    if (shape[0] == 0) array.values.clear();
    const std::string content = formats::format_npy(array);
    EXPECT_EQ((content.size() - array.values.size() * 4) % 64, 0u);
    const formats::NpyArray again = formats::parse_npy(content, "a");
    EXPECT_EQ(again.shape, array.shape);
    EXPECT_EQ(again.values, array.values);
  }
}

TEST(Npy, RefusesWhatItCannotRead) {
  const std::vector<float> numbers = {1, 2, 3, 4, 5, 6};
  const std::string good = npy_file(1, header_of("<f4", "False", "2, 3"), numbers);
  const std::pair<std::string, const char*> cases[] = {
      {"", "not a NumPy"},
      {"hello world", "not a NumPy"},
      {good.substr(0, 9), "not a NumPy"},
      {good.substr(0, 30), "truncated"},
      {good.substr(0, good.size() - 1), "truncated"},
      {npy_file(9, header_of("<f4", "False", "6"), numbers), "format 9"},
      {npy_file(1, header_of("<c8", "False", "3"), numbers), "float32"},
      {npy_file(1, header_of("<f16", "False", "1"), numbers), "float32"},
      {npy_file(1, header_of("<U4", "False", "3"), numbers), "float32"},
      {npy_file(1, header_of("|O", "False", ""), numbers), "nothing of it was executed"},
      {npy_file(1, header_of("|O", "False", ""), numbers), "d[\"motion\"][0]"},
      {npy_file(1, std::string("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (6,)}"),
                numbers),
       "named fields"},
      {npy_file(1, header_of("<f4", "False", "-6"), numbers), "shape"},
      {npy_file(1, header_of("<f4", "False", "2, x"), numbers), "shape"},
      {npy_file(1, header_of("<f4", "Maybe", "6"), numbers), "fortran_order"},
      {npy_file(1, header_of("<f4", "False", "99999999999, 99999999999"), numbers), "truncated"},
      {npy_file(1, header_of("<f4", "False", "9999999999999999999999"), numbers), "not plausible"},
      {npy_file(1, std::string("{}"), numbers), "descr"},
  };
  for (const auto& [content, message] : cases) {
    try {
      formats::parse_npy(content, "broken.npy");
      ADD_FAILURE() << message << ": was accepted";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

}  // namespace remomask
