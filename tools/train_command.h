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
  std::string
      text_file;      ///< of the sentence encoder; empty: that in the folder, else the shipped one
  std::string start;  ///< a model whose weights the training goes on from
  std::vector<std::string> kept;  ///< stages of `start` that are taken as they are
  std::vector<std::string> sources;
  int64_t tuned_text_layers = 0;
  std::optional<int64_t> steps, batch, queue_size;
  std::optional<double> learning_rate, same_label_weight;
  uint64_t seed = 1;
};

void run_train(const TrainCommand& command, Program& program);

/// The stage "words": an adapter of the sentence encoder, which is no part of a model.
void run_train_words(const TrainCommand& command, Program& program);

}  // namespace remomask::tools
