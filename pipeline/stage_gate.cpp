#include "pipeline/stage_gate.h"

#include <cmath>

#include "remomask/error.h"

namespace remomask::pipeline {

namespace {

constexpr const char* kKey = "evidence_gate";

bool is_sound(const SimilarityGate& gate) {
  return std::isfinite(gate.none) && std::isfinite(gate.all) && gate.none <= gate.all;
}

}  // namespace

void set_stage_gate(nn::ModelStage& masked, const EvidenceGate& gate) {
  masked.config[kKey] = gate;
}

std::optional<EvidenceGate> stage_gate(const nn::ModelStage& masked) {
  const auto found = masked.config.find(kKey);
  if (found == masked.config.end()) return std::nullopt;
  EvidenceGate gate;
  try {
    gate = found->get<EvidenceGate>();
  } catch (const nlohmann::json::exception&) {
    gate.motion.none = NAN;
  }
  if (is_sound(gate.motion) && is_sound(gate.caption)) return gate;
  throw Error("the evidence gate of this model is damaged: " + found->dump() +
              "; make the model file anew with \"remomask train all\"");
}

}  // namespace remomask::pipeline
