#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "base/preset.h"
#include "motion/feature_mode_json.h"
#include "motion/features.h"

namespace remomask::retriever {

/// Which queues of negatives the training keeps besides the batch.
enum class Queues { none, motion, text, both };

Queues parse_queues(const std::string& name);
const char* queues_name(Queues queues);

struct RetrieverConfig {
  std::string preset = "base";
  std::string skeleton = "humanml3d";
  motion::FeatureMode mode = motion::FeatureMode::fixed;
  int64_t patch = 4;  ///< frames a patch of the motion encoder
  int64_t width = 128, layers = 3, heads = 4, hidden = 256;  ///< of each part encoder
  double dropout = 0.1;                                      ///< in the projection heads
  int64_t embedding = 256;                                   ///< E
  int64_t part_embedding = 64;                               ///< P
  /// Motion encoders: one a body part, or 1 that reads the whole body.
  int64_t encoders = 6;
  /// The transformer that reads the states of the sentence encoder's words (TextReader).
  int64_t text_width = 256, text_layers = 2, text_heads = 4, text_hidden = 512;
  double text_dropout = 0.1;
  /// Last layers of the sentence encoder that the retriever trains, as a copy of its own.
  int64_t tuned_text_layers = 0;
  /// Identity of the sentence encoder, SentenceEncoder::tower_hash(), and its width; empty: set by
  /// the training.
  std::string text_encoder;
  int64_t text_encoder_width = 0;
};

/// The sizes of a retriever. MoMask's published sizes go with the base retriever.
RetrieverConfig retriever_preset(ModelSize size);

/// One encoder over the whole body in place of six over its parts, as wide as
/// makes about as many weights. The six part vectors are then six heads of the
/// one state.
void use_whole_body_encoder(RetrieverConfig& config);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RetrieverConfig, preset, skeleton, mode, patch, width, layers,
                                   heads, hidden, dropout, embedding, part_embedding, encoders,
                                   text_width, text_layers, text_heads, text_hidden, text_dropout,
                                   tuned_text_layers, text_encoder, text_encoder_width)

/// The configuration in a model file. Throws Error for one of version 0.2 and older, whose text
/// tower was the retriever's own.
RetrieverConfig read_retriever_config(const nlohmann::json& json);

}  // namespace remomask::retriever
