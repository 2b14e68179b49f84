#pragma once

#include <string>

#include "remomask/export.h"
#include "remomask/progress.h"

namespace remomask {

struct TrainOptions {
  std::string database;         ///< clips of its splits "train" and "val"
  std::string folder;           ///< takes the model, its stages and their checkpoints
  std::string preset = "base";  ///< "tiny", "base", "paper", ...
  int steps = 0;                ///< steps of every stage; 0: as the preset says
  int threads = 0;              ///< 0: all that the process may use
};

struct TrainReport {
  std::string model;  ///< path of the finished model file
};

/// Trains all networks of a model: retriever, tokenizer, masked and residual transformer. Sentences
/// are read by the sentence encoder in text.safetensors of the folder, else by the shipped one. Can
/// be stopped at any moment (Interrupted); the same call continues to the same weights. Throws
/// Error for a database without captioned training clips.
REMOMASK_API TrainReport train_model(const TrainOptions& options, const Monitor& monitor = {});

}  // namespace remomask
