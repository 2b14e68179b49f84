#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/base/test_folder.h"

namespace remomask {

/// Gives a reader mutated inputs: it reads them or throws an Error, and never anything else.
///   REMOMASK_FUZZ_INPUTS=N   inputs of a reader, times its weight. Default 10.
///   REMOMASK_FUZZ_FROM=N     number of the first one, to go on where another run ended.
class ReaderFuzz : public testing::Test {
 protected:
  using Read = std::function<void(const std::string& content)>;

  /// Files of tests/fuzz/corpus/KIND, in the order of their names.
  static std::vector<std::string> corpus(const std::string& kind);

  /// What a writer of ours makes of a motion of six frames.
  std::string written(const std::string& name);

  /// A file in the folder of the test, written in place: nothing but the reader is on trial.
  std::string place(const std::string& name, const std::string& content);

  /// `weight`: how many times as many inputs as the dearest readers get, for cheap ones.
  /// `sound`: the seeds are read without an Error.
  void fuzz(std::vector<std::string> seeds, int weight, const Read& read, bool sound = true);

  TestFolder folder_;
};

}  // namespace remomask
