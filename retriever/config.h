#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "motion/features.h"

namespace remomask {

/// Which queues of negatives the training keeps besides the batch.
enum class Queues { none, motion, text, both };

Queues parse_queues(const std::string& name);
const char* queues_name(Queues queues);

struct RetrieverConfig {
  std::string preset = "base";
  std::string skeleton = "humanml3d";
  FeatureMode mode = FeatureMode::fixed;
  int64_t patch = 4;  ///< frames a patch of the motion encoder
  int64_t width = 128, layers = 3, heads = 4, hidden = 256;  ///< of each part encoder
  double dropout = 0.1;                                      ///< in the projection heads
  int64_t embedding = 256;                                   ///< E
  int64_t part_embedding = 64;                               ///< P
  nlohmann::json text_tower;  ///< of TextTower::config(); empty: made by the training
};

/// "tiny" (tests), "base" (default) or "paper" (sizes of the publication).
RetrieverConfig retriever_preset(const std::string& preset);

void to_json(nlohmann::json& json, const RetrieverConfig& config);
void from_json(const nlohmann::json& json, RetrieverConfig& config);

}  // namespace remomask
