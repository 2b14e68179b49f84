#include "tests/fuzz/fuzz_test_tools.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "base/file.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tests/db/db_test_tools.h"
#include "tests/fuzz/mutator.h"

/// FAISS loses memory when it refuses an index of a type that is not walked through before.
extern "C" const char* __lsan_default_suppressions() { return "leak:faiss::read_index"; }

namespace remomask {

namespace {

uint64_t number_from(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

}  // namespace

std::vector<std::string> ReaderFuzz::corpus(const std::string& kind) {
  const std::string folder = std::string(REMOMASK_SOURCE_DIR) + "/tests/fuzz/corpus/" + kind;
  std::vector<std::string> paths, contents;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  for (const std::string& path : paths) contents.push_back(read_file(path));
  return contents;
}

std::string ReaderFuzz::written(const std::string& name) {
  save_motion(folder_ / name, walking_motion(6, 1));
  return read_file(folder_ / name);
}

std::string ReaderFuzz::place(const std::string& name, const std::string& content) {
  const std::string path = folder_ / name;
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
  return path;
}

void ReaderFuzz::fuzz(std::vector<std::string> seeds, int weight, const Read& read, bool sound) {
  ASSERT_FALSE(seeds.empty());
  const uint64_t from = number_from("REMOMASK_FUZZ_FROM", 0) * static_cast<uint64_t>(weight);
  const uint64_t inputs = number_from("REMOMASK_FUZZ_INPUTS", 10) * static_cast<uint64_t>(weight);
  const size_t sound_inputs = sound ? seeds.size() : 0;
  Mutator mutator(std::move(seeds));
  uint64_t refused = 0;
  for (uint64_t number = from; number < from + inputs; ++number) {
    const std::string content = mutator.input(number);
    try {
      read(content);
    } catch (const Error& error) {
      ++refused;
      EXPECT_GE(number, sound_inputs) << error.what();
      EXPECT_NE(std::string(error.what()), "");
    } catch (const std::exception& error) {
      const std::string kept = testing::TempDir() + "remomask_fuzz_input";
      std::ofstream(kept, std::ios::binary) << content;
      FAIL() << "input " << number << " (kept in " << kept << "): " << error.what();
    }
  }
  std::cout << "fuzz: " << inputs << " inputs, " << refused << " refused\n";
}

}  // namespace remomask
