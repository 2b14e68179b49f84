#pragma once

#include <nlohmann/json.hpp>

#include "remomask/generation.h"

namespace remomask::pipeline {

// Results as JSON documents: the sidecar of a motion file, and an entry of the answers of the
// commands generate and edit (docs/schema/motion.json). One sentence or many, generated or edited:
// every motion has the same members, and a list of segments. Seeds are strings, since 64 bits do
// not fit the numbers of JavaScript and many other readers.

nlohmann::json words_document(const std::vector<QueryWord>& words);
nlohmann::json hit_document(const MotionHit& hit);
nlohmann::json evidence_document(const std::vector<Evidence>& evidence);

nlohmann::json motion_document(const GeneratedMotion& made);
nlohmann::json motion_document(const EditedMotion& made);
nlohmann::json motion_document(const ScriptedMotion& made);

}  // namespace remomask::pipeline
