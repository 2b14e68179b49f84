#pragma once

#include <optional>

#include "nn/model_file.h"
#include "pipeline/evidence_gate.h"

namespace remomask::pipeline {

// A model keeps the evidence gate of its retriever in the config of its masked stage.

void set_stage_gate(nn::ModelStage& masked, const EvidenceGate& gate);

/// Nothing where the stage holds none. Throws Error for one that is damaged: limits that
/// are no finite numbers, or the wrong way round.
std::optional<EvidenceGate> stage_gate(const nn::ModelStage& masked);

}  // namespace remomask::pipeline
