#include "tools/training_presets.h"

namespace remomask {

namespace {

bool published_size(const std::string& preset) { return preset == "paper" || preset == "momask"; }

TransformerTrainingOptions transformer_preset(const std::string& preset, const char* stage,
                                              int64_t base_steps) {
  TransformerTrainingOptions options;
  options.trainer.stage_name = stage;
  options.trainer.steps = base_steps;
  options.batch = 32;
  options.trainer.learning_rate = 6e-4;
  options.trainer.warmup_steps = 100;
  options.trainer.ema_decay = 0.99;
  if (preset == "tiny") {
    options.trainer.steps = 60;
    options.trainer.learning_rate = 2e-3;
    options.batch = 16;
    options.validate_every = 30;
  } else if (published_size(preset)) {
    options.trainer.steps = 180000;
    options.trainer.learning_rate = 2e-4;
    options.trainer.warmup_steps = 2000;
    options.trainer.ema_decay = 0.999;
    options.batch = preset == "paper" ? 256 : 64;
  }
  return options;
}

}  // namespace

TextTrainingOptions text_training_preset(const std::string& preset) {
  TextTrainingOptions options;
  options.trainer.steps = 800;
  if (preset == "tiny") {
    options.trainer.steps = 40;
    options.batch = 16;
  }
  return options;
}

TokenizerTrainingOptions tokenizer_training_preset(const std::string& preset) {
  TokenizerTrainingOptions options;
  if (preset == "tiny") {
    options.trainer.steps = 120;
    options.trainer.learning_rate = 2e-3;
    options.batch_frames = 512;
    options.validate_every = 60;
  } else if (published_size(preset)) {
    options.trainer.steps = 350000;
    options.trainer.learning_rate = 2e-4;
    options.trainer.warmup_steps = 2000;
    options.trainer.ema_decay = 0.999;
    options.batch_frames = 256 * options.window;
  }
  return options;
}

TransformerTrainingOptions masked_training_preset(const std::string& preset) {
  return transformer_preset(preset, "masked", 2800);
}

TransformerTrainingOptions residual_training_preset(const std::string& preset) {
  return transformer_preset(preset, "residual", 1500);
}

}  // namespace remomask
