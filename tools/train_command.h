#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/program.h"

namespace remomask::tools {

/// What `remomask train` is asked for.
struct TrainCommand {
  std::string stage, database, folder, preset = "base", variant = "full", queues = "both";
  std::vector<std::string> captions, sources;
  std::string text_file;  ///< of the sentence encoder; empty: the shipped one
  std::optional<int64_t> steps, batch, queue_size;
  std::optional<double> learning_rate, same_label_weight;
  uint64_t seed = 1;
};

void run_train(const TrainCommand& command, Program& program);

/// The stage "words": an adapter of the sentence encoder, which is no part of a model.
void run_train_words(const TrainCommand& command, Program& program);

}  // namespace remomask::tools
