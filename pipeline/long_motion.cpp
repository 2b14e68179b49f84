#include "pipeline/long_motion.h"

#include <algorithm>

#include "base/time.h"
#include "pipeline/candidate_ranking.h"
#include "pipeline/physical.h"
#include "pipeline/script.h"
#include "pipeline/seams.h"

namespace remomask::pipeline {

namespace {

double judge_segment(const Generator& generator, const std::string& sentence, const Motion& piece,
                     int seam) {
  const Skeleton& skeleton = humanml_skeleton();
  const int last = std::min(piece.frames, seam + kMaxStoredFrames);
  const Candidate score =
      score_candidate(generator.retriever(), generator.sentence_vector(sentence),
                      slice(piece, seam, last), skeleton);
  return score.score - jerk_penalty(jerk_at_seam(jerk_over_time(piece, skeleton), seam));
}

}  // namespace

ScriptedMotion make_long_motion(const Generator& generator, const FindEvidence& find,
                                std::span<const ScriptLine> lines, const GenerateOptions& options,
                                const Monitor& monitor) {
  std::vector<ScriptSegment> segments;
  ScriptedMotion result;
  for (const ScriptLine& line : lines) {
    FoundEvidence found = find(line.sentence);
    ScriptedSegment segment;
    segment.sentence = line.sentence;
    segment.evidence = std::move(found.evidence);
    segment.words = std::move(found.words);
    result.segments.push_back(std::move(segment));
    segments.push_back({line.sentence, std::move(found.motions), line.seconds});
  }
  ScriptOptions script;
  script.generate = options;
  script.candidates = options.best_of;
  script.judge = [&](const std::string& sentence, const Motion& piece, int seam) {
    return judge_segment(generator, sentence, piece, seam);
  };
  ScriptMotion made = generate_script(generator, segments, script, monitor);
  result.motion = std::move(made.motion);
  result.times = made.times;
  for (size_t i = 0; i < made.segments.size(); ++i) {
    ScriptedSegment& segment = result.segments[i];
    segment.first = made.segments[i].first;
    segment.last = made.segments[i].last;
    segment.candidate_seed = made.segments[i].seed;
    segment.score = made.segments[i].score;
    note_followed(segment.evidence, made.segments[i].followed);
  }
  return result;
}

void measure_long_motion(ScriptedMotion& made, const db::Database& database) {
  const Skeleton& skeleton = humanml_skeleton();
  const std::vector<double> jerk = jerk_over_time(made.motion, skeleton);
  const std::vector<double> lowest = lowest_foot_over_time(made.motion, skeleton);
  made.physical = measure_physical(made.motion, skeleton);
  made.jerk_of_real = jerk_of_database(database, skeleton);
  double sum = 0, worst = 0;
  for (size_t i = 0; i < made.segments.size(); ++i) {
    ScriptedSegment& segment = made.segments[i];
    const auto begin = lowest.begin() + segment.first, end = lowest.begin() + segment.last;
    segment.lowest_foot = *std::min_element(begin, end);
    segment.highest_lowest_foot = *std::max_element(begin, end);
    if (i == 0) continue;
    segment.jerk_at_seam = jerk_at_seam(jerk, segment.first);
    sum += *segment.jerk_at_seam;
    worst = std::max(worst, *segment.jerk_at_seam);
  }
  if (made.segments.size() < 2) return;
  made.jerk_at_seams = sum / static_cast<double>(made.segments.size() - 1);
  made.jerk_at_worst_seam = worst;
}

}  // namespace remomask::pipeline
