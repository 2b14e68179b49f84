#pragma once

#include <functional>
#include <span>
#include <string>

#include "db/database.h"
#include "pipeline/evidence.h"
#include "remomask/progress.h"

namespace remomask::pipeline {

/// What find_evidence() finds for a sentence.
using FindEvidence = std::function<FoundEvidence(const std::string& sentence)>;

/// Generates a script: retrieves for each sentence, generates the segments one after the other,
/// and keeps the best of `options.best_of` candidates of each. A candidate is judged by the score
/// of its segment, less what its seam is rougher than a body moves. The measurements of the
/// result are not filled in.
ScriptedMotion make_long_motion(const Generator& generator, const FindEvidence& find,
                                std::span<const ScriptLine> lines, const GenerateOptions& options,
                                const Monitor& monitor);

/// Measures the seams against the clips of the database, the floor and the body.
void measure_long_motion(ScriptedMotion& made, const db::Database& database);

}  // namespace remomask::pipeline
