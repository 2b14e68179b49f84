#include "tools/generate_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "base/file.h"
#include "drawing/contact_sheet.h"
#include "formats/motion_file.h"
#include "pipeline/candidate_ranking.h"
#include "pipeline/physical.h"
#include "pipeline/script.h"
#include "pipeline/seams.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::tools {

namespace {

constexpr int kLongestClip = 200;

struct FoundSegments {
  std::vector<pipeline::ScriptSegment> segments;
  std::vector<nlohmann::json> evidence;  ///< of each
};

FoundSegments find_segments(const GenerationWorkspace& workspace,
                            const std::vector<pipeline::ScriptLine>& lines, const std::string& path,
                            const search::ClipFilter& filter) {
  FoundSegments found;
  for (const pipeline::ScriptLine& line : lines) {
    std::string sentence = line.sentence;
    try {
      text::normalise_prompt(sentence);
    } catch (const Error& error) {
      throw FileError(path, line.line, error.what());
    }
    Evidence evidence = workspace.find_evidence(sentence, filter);
    found.evidence.push_back(evidence_list(evidence));
    found.segments.push_back({sentence, std::move(evidence.motions), line.seconds});
  }
  return found;
}

/// The score of the segment alone, less what its seam is rougher than allowed.
double judge_segment(const GenerationWorkspace& workspace, const std::string& sentence,
                     const Motion& piece, int seam) {
  const retriever::Retriever& retriever = workspace.search().retriever();
  const std::vector<float> vector = text_vector(retriever, sentence);
  const Skeleton& skeleton = humanml_skeleton();
  // The retriever reads as much as a clip has.
  const int last = std::min(piece.frames, seam + kLongestClip);
  const pipeline::CandidateScore score =
      pipeline::score_candidate(retriever, vector, slice(piece, seam, last), skeleton);
  return score.score - pipeline::jerk_penalty(
                           pipeline::jerk_at_seam(pipeline::jerk_over_time(piece, skeleton), seam));
}

/// What can be measured of a long motion: its seams against real clips, its
/// bones and its floor.
nlohmann::json measure_script(const pipeline::ScriptMotion& made, const FoundSegments& found,
                              const db::Database& database) {
  const Skeleton& skeleton = humanml_skeleton();
  const std::vector<double> jerk = pipeline::jerk_over_time(made.motion, skeleton);
  const std::vector<double> lowest = pipeline::lowest_foot_over_time(made.motion, skeleton);
  const pipeline::PhysicalMetrics physical = pipeline::measure_physical(made.motion, skeleton);
  nlohmann::json segments = nlohmann::json::array();
  double seam_sum = 0, seam_most = 0;
  for (size_t i = 0; i < made.segments.size(); ++i) {
    const pipeline::MadeSegment& segment = made.segments[i];
    const auto begin = lowest.begin() + segment.first, end = lowest.begin() + segment.last;
    nlohmann::json entry = {{"sentence", found.segments[i].sentence},
                            {"first", segment.first},
                            {"last", segment.last},
                            {"seed", segment.seed},
                            {"score", segment.score},
                            {"lowest_foot", *std::min_element(begin, end)},
                            {"highest_lowest_foot", *std::max_element(begin, end)},
                            {"followed", followed_json(segment.followed, found.evidence[i])},
                            {"evidence", found.evidence[i]}};
    if (i > 0) {
      const double at_seam = pipeline::jerk_at_seam(jerk, segment.first);
      entry["jerk_at_seam"] = at_seam;
      seam_sum += at_seam;
      seam_most = std::max(seam_most, at_seam);
    }
    segments.push_back(std::move(entry));
  }
  const size_t seams = made.segments.size() - 1;
  const double real = pipeline::jerk_of_database(database, skeleton);
  nlohmann::json report = {{"segments", segments}, {"physical", physical}, {"jerk_of_real", real}};
  if (seams > 0) {
    const double mean = seam_sum / static_cast<double>(seams);
    report["jerk_at_seams"] = mean;
    report["jerk_at_worst_seam"] = seam_most;
    if (real > 0) report["seams_to_real"] = mean / real;
  }
  return report;
}

void draw_segments(const pipeline::ScriptMotion& made, const FoundSegments& found,
                   const std::string& path) {
  std::vector<drawing::SheetRow> rows;
  for (size_t i = 0; i < made.segments.size(); ++i) {
    rows.push_back({found.segments[i].sentence, evidence_line(found.evidence[i]),
                    slice(made.motion, made.segments[i].first, made.segments[i].last)});
  }
  drawing::write_contact_sheet(path, rows);
}

}  // namespace

void run_script(const GenerationWorkspace& workspace, const std::string& script_path,
                const std::string& output, const std::string& sheet, uint64_t seed,
                const search::ClipFilter& evidence, Program& program) {
  const auto start = std::chrono::steady_clock::now();
  const std::string text = read_file(script_path);
  const FoundSegments found =
      find_segments(workspace, pipeline::parse_script(text, script_path), script_path, evidence);
  pipeline::ScriptOptions options;
  options.generate = workspace.generate_options(seed);
  options.candidates = workspace.best_of();
  options.judge = [&](const std::string& sentence, const Motion& piece, int seam) {
    return judge_segment(workspace, sentence, piece, seam);
  };
  const pipeline::ScriptMotion made =
      pipeline::generate_script(workspace.generator(), found.segments, options, program.monitor());
  program.finish_progress();
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  nlohmann::json report = measure_script(made, found, workspace.search().database());
  report["file"] = output;
  report["script"] = script_path;
  report["seed"] = seed;
  report["frames"] = made.motion.frames;
  report["generator"] = workspace.identity();
  report["seconds_of_work"] = seconds;
  formats::save_motion_file(output, made.motion,
                            {{"prompt", text},
                             {"script", script_path},
                             {"segments", report["segments"].dump()},
                             {"seed", std::to_string(seed)},
                             {"generator", workspace.identity()},
                             {"database", workspace.search().database().uuid()},
                             {"evidence", nlohmann::json::array().dump()}});
  if (!sheet.empty()) draw_segments(made, found, sheet);
  if (program.json) return program.print_json(report);
  fmt::print("{}: {} frames ({:.1f} s of motion) of {} sentences in {:.2f} s, seed {}\n", output,
             made.motion.frames, made.motion.frames / 20.0, made.segments.size(), seconds, seed);
  for (const auto& segment : report["segments"]) {
    fmt::print("  {:6.2f} s  {}\n", segment["first"].get<int>() / 20.0,
               segment["sentence"].get<std::string>());
  }
  if (report.contains("seams_to_real")) {
    fmt::print("jerk at the seams: {:.2f} times that of the database's clips\n",
               report["seams_to_real"].get<double>());
  }
  if (!sheet.empty()) fmt::print("{}: contact sheet\n", sheet);
}

}  // namespace remomask::tools
