#include "pipeline/motion_document.h"

#include "formats/motion_writing.h"
#include "pipeline/length_estimate.h"
#include "pipeline/physical.h"
#include "remomask/motion_file.h"
#include "remomask/search.h"

namespace remomask::pipeline {

namespace {

using nlohmann::json;

constexpr const char* kSchema = "remomask.motion/1";

json seed_json(uint64_t seed) { return std::to_string(seed); }

template <class Value>
json optional_json(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

json candidates_json(const std::vector<Candidate>& candidates) {
  json list = json::array();
  for (const Candidate& candidate : candidates) {
    list.push_back({{"seed", seed_json(candidate.seed)},
                    {"score", candidate.score},
                    {"similarity", candidate.similarity},
                    {"skate", candidate.skate},
                    {"jerk", candidate.jerk},
                    {"penetration", candidate.penetration},
                    {"bend", candidate.bend}});
  }
  return list;
}

json length_json(const LengthChoice& length) {
  json result = {{"rule", length.given ? "given" : length_rule_name(length.rule)}};
  if (length.distribution.empty()) return result;
  result["neighbours"] = length.neighbours;
  result["likely_seconds"] = length.likely_seconds;
  result["distribution"] = length.distribution;
  return result;
}

/// The members that every motion has.
json motion_json(const char* kind, const Motion& motion, uint64_t seed,
                 const std::string& generator, const std::string& database) {
  return {{"schema", kSchema},           {"kind", kind},
          {"frames", motion.frames},     {"fps", motion.fps},
          {"skeleton", motion.skeleton}, {"seed", seed_json(seed)},
          {"generator", generator},      {"database", database}};
}

json segment_json(const std::string& sentence, int first, int last, uint64_t seed,
                  const std::vector<Evidence>& evidence, const std::vector<QueryWord>& words) {
  json followed = nullptr;
  for (const Evidence& entry : evidence) {
    if (entry.followed_share <= 0) continue;
    followed = {{"clip_id", entry.hit.clip.id},
                {"clip", entry.hit.clip.name},
                {"share", entry.followed_share}};
  }
  return {{"sentence", sentence},
          {"first", first},
          {"last", last},
          {"candidate_seed", seed_json(seed)},
          {"followed", followed},
          {"evidence", evidence_document(evidence)},
          {"words", words_document(words)}};
}

json single_segment(const Provenance& made, int frames) {
  json segment =
      segment_json(made.sentence, 0, frames, made.candidate_seed, made.evidence, made.words);
  segment["candidates"] = candidates_json(made.candidates);
  return segment;
}

}  // namespace

json words_document(const std::vector<QueryWord>& words) {
  json list = json::array();
  for (const QueryWord& word : words) {
    list.push_back({{"word", word.word},
                    {"covered", word.covered},
                    {"in_captions", word.in_captions},
                    {"found", word.covered >= kCoveredWord}});
  }
  return list;
}

json hit_document(const MotionHit& hit) {
  json parts = nullptr;
  if (hit.parts) {
    parts = {{"caption", hit.parts->caption},
             {"best", optional_json(hit.parts->best)},
             {"mean", optional_json(hit.parts->mean)},
             {"words", hit.parts->words},
             {"share", hit.parts->share},
             {"motion", optional_json(hit.parts->motion)}};
  }
  return {{"rank", hit.rank},
          {"clip_id", hit.clip.id},
          {"clip", hit.clip.name},
          {"similarity", hit.similarity},
          {"probability", optional_json(hit.probability)},
          {"as_mirrored", hit.as_mirrored},
          {"parts", parts},
          {"captions", hit.clip.captions},
          {"source", hit.clip.source},
          {"licence", hit.clip.licence},
          {"split", hit.clip.split},
          {"seconds", clip_seconds(hit.clip)}};
}

json evidence_document(const std::vector<Evidence>& evidence) {
  json list = json::array();
  for (const Evidence& entry : evidence) {
    json item = hit_document(entry.hit);
    const bool worded = entry.use != EvidenceUse::no_captions;
    item["caption_similarity"] = worded ? json(entry.caption_similarity) : json(nullptr);
    item["trust"] = entry.trust;
    item["read"] = entry.use == EvidenceUse::read;
    item["use"] = evidence_use_name(entry.use);
    item["followed_share"] = entry.followed_share;
    item["influence"] = optional_json(entry.influence);
    list.push_back(std::move(item));
  }
  return list;
}

json motion_document(const GeneratedMotion& made) {
  json result = motion_json("generated", made.motion, made.seed, made.generator, made.database);
  result["length"] = length_json(made.length);
  result["segments"] = json::array({single_segment(made, made.motion.frames)});
  return result;
}

json motion_document(const EditedMotion& made) {
  json result = motion_json("edited", made.motion, made.seed, made.generator, made.database);
  json cells = json::array();
  for (const EditedCells& cell : made.cells) {
    cells.push_back({{"part", cell.part}, {"first", cell.first}, {"last", cell.last}});
  }
  result["edit"] = {{"original", made.original},
                    {"cells", cells},
                    {"tokens", made.tokens},
                    {"tokens_sampled", made.tokens_sampled},
                    {"path_shift_metres", made.path_shift_metres},
                    {"path_turn_degrees", made.path_turn_degrees}};
  result["segments"] = json::array({single_segment(made, made.motion.frames)});
  return result;
}

json motion_document(const ScriptedMotion& made) {
  json result = motion_json("scripted", made.motion, made.seed, made.generator, made.database);
  json segments = json::array();
  for (const ScriptedSegment& segment : made.segments) {
    json item = segment_json(segment.sentence, segment.first, segment.last, segment.candidate_seed,
                             segment.evidence, segment.words);
    item["score"] = segment.score;
    item["lowest_foot"] = segment.lowest_foot;
    item["highest_lowest_foot"] = segment.highest_lowest_foot;
    item["jerk_at_seam"] = optional_json(segment.jerk_at_seam);
    segments.push_back(std::move(item));
  }
  result["segments"] = segments;
  json seams_to_real = nullptr;
  if (made.jerk_at_seams && made.jerk_of_real > 0) {
    seams_to_real = *made.jerk_at_seams / made.jerk_of_real;
  }
  result["script"] = {{"physical", made.physical},
                      {"jerk_of_real", made.jerk_of_real},
                      {"jerk_at_seams", optional_json(made.jerk_at_seams)},
                      {"jerk_at_worst_seam", optional_json(made.jerk_at_worst_seam)},
                      {"seams_to_real", seams_to_real}};
  return result;
}

}  // namespace remomask::pipeline

namespace remomask {

namespace {

template <class Made>
WrittenMotion save_with_sidecar(const std::string& path, const Made& made,
                                const MotionWriteOptions& options) {
  const nlohmann::json sidecar = pipeline::motion_document(made);
  return formats::write_motion(path, made.motion, &sidecar, options);
}

}  // namespace

WrittenMotion save_motion(const std::string& path, const GeneratedMotion& made,
                          const MotionWriteOptions& options) {
  return save_with_sidecar(path, made, options);
}
WrittenMotion save_motion(const std::string& path, const EditedMotion& made,
                          const MotionWriteOptions& options) {
  return save_with_sidecar(path, made, options);
}
WrittenMotion save_motion(const std::string& path, const ScriptedMotion& made,
                          const MotionWriteOptions& options) {
  return save_with_sidecar(path, made, options);
}

}  // namespace remomask
