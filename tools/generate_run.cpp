#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/bounded_file.h"
#include "base/counted.h"
#include "formats/animation_formats.h"
#include "pipeline/motion_document.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tools/evidence_text.h"
#include "tools/generate_command.h"
#include "tools/generation_run.h"
#include "tools/output_path.h"

namespace remomask::tools {

namespace {

constexpr uint64_t kMaxScript = uint64_t{1} << 20;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The probability of a hit, else its similarity.
std::string likeness_text(const MotionHit& hit) {
  return hit.probability ? fmt::format("{:.0f} %", 100 * *hit.probability)
                         : fmt::format("{:.3f}", hit.similarity);
}

void print_evidence(const std::vector<Evidence>& evidence, const std::vector<QueryWord>& words) {
  const auto is_read = [](const Evidence& entry) { return entry.use == EvidenceUse::read; };
  const bool any = std::any_of(evidence.begin(), evidence.end(), is_read);
  if (evidence.empty()) return;
  const std::string missing = words_text(words);
  if (!missing.empty()) fmt::print("{}\n", missing);
  fmt::print("{}\n", any ? "made from the retrieved motions" : evidence_refusal(evidence));
  for (const Evidence& entry : evidence) {
    if (any && !is_read(entry)) continue;
    const std::string influence =
        entry.influence ? fmt::format("{:3.0f} %  ", 100 * *entry.influence) : "";
    fmt::print("  {:>6}  {}{:<28} {}\n", likeness_text(entry.hit), influence, entry.hit.clip.name,
               entry.hit.clip.captions.empty() ? "" : entry.hit.clip.captions.front());
  }
}

void print_followed(const std::vector<Evidence>& evidence) {
  for (const Evidence& entry : evidence) {
    if (entry.followed_share <= 0) continue;
    fmt::print("  {:.0f} % of its frames began as {}\n", 100 * entry.followed_share,
               entry.hit.clip.name);
  }
}

void print_script(const std::string& path, const ScriptedMotion& made, double seconds) {
  fmt::print("{}: {} ({:.1f} s of motion) of {} in {:.2f} s, seed {}\n", path,
             counted(made.motion.frames, "frame"), made.motion.seconds(),
             counted(static_cast<int64_t>(made.segments.size()), "sentence"), seconds, made.seed);
  for (const ScriptedSegment& segment : made.segments) {
    fmt::print("  {:6.2f} s  {}\n", segment.first / made.motion.fps, segment.sentence);
  }
  if (made.jerk_at_seams && made.jerk_of_real > 0) {
    fmt::print("jerk at the seams: {:.2f} times that of the database's clips\n",
               *made.jerk_at_seams / made.jerk_of_real);
  }
}

void run_script(const GenerateCommand& command, const TextToMotion& remomask,
                const GenerateOptions& options, Program& program) {
  const auto start = Clock::now();
  const auto lines = parse_script(read_bounded_file(command.script, kMaxScript), command.script);
  const ScriptedMotion made = remomask.script(lines, options, program.monitor());
  program.finish_progress();
  const double seconds = seconds_since(start);
  command.overwrite.check(command.output, "", program);
  const WrittenMotion written =
      save_motion(command.output, made, command.writing.chosen(command.output));
  std::vector<drawing::SheetRow> rows;
  for (const ScriptedSegment& segment : made.segments) {
    rows.push_back({segment.sentence, evidence_line(segment.evidence),
                    slice(made.motion, segment.first, segment.last)});
  }
  if (!program.json) print_script(command.output, made, seconds);
  print_written(written, program);
  finish_sheet(command.sheet, rows, program);
  nlohmann::json entry = answer_entry(pipeline::motion_document(made), command.output, seconds);
  entry["script_file"] = command.script;
  add_written(entry, written);
  print_motions(program, nlohmann::json::array({entry}));
}

/// The motions of --one-file until the file is written.
struct Together {
  std::vector<GeneratedMotion> motions;
  std::vector<nlohmann::json> documents;
};

WrittenMotion write_all(const GenerateCommand& command, const Together& together) {
  const MotionWriteOptions writing = command.writing.chosen(command.output);
  std::vector<formats::WritingJob> jobs;
  for (size_t i = 0; i < together.motions.size(); ++i) {
    const GeneratedMotion& made = together.motions[i];
    jobs.push_back({made.motion, writing, &together.documents[i],
                    fmt::format("{} {}", i + 1, command.prompt)});
  }
  return formats::write_together(command.output, jobs);
}

}  // namespace

void run_generate(const GenerateCommand& command, Program& program) {
  const Monitor monitor = program.monitor();
  const TextToMotion remomask =
      open_model(command.files, program, needs_search(command.generation));
  GenerateOptions options = command.generation.chosen();
  options.evidence = command.filter.filter();
  if (!command.script.empty()) return run_script(command, remomask, options, program);
  nlohmann::json motions = nlohmann::json::array();
  std::vector<drawing::SheetRow> rows;
  Together together;
  if (command.one_file) command.overwrite.check(command.output, "", program);
  for (int i = 0; i < command.count; ++i) {
    const auto start = Clock::now();
    GeneratedMotion made;
    try {
      made = remomask.generate(command.prompt, options, monitor);
    } catch (const Interrupted&) {
      if (!together.motions.empty()) write_all(command, together);
      stop_after(i, command.count, options.seed);
    }
    program.finish_progress();
    const double seconds = seconds_since(start);
    const std::string path =
        command.one_file ? command.output : sample_path(command.output, i, command.count);
    const nlohmann::json document = pipeline::motion_document(made);
    motions.push_back(answer_entry(document, path, seconds));
    WrittenMotion written;
    if (command.one_file) {
      together.motions.push_back(made);
      together.documents.push_back(document);
    } else {
      command.overwrite.check(path, "", program);
      written = save_motion(path, made, command.writing.chosen(path));
      add_written(motions.back(), written);
    }
    rows.push_back({command.prompt, evidence_line(made.evidence), made.motion});
    if (!program.json) {
      fmt::print("{}: {} ({:.1f} s of motion) in {:.2f} s, seed {}\n", path,
                 counted(made.motion.frames, "frame"), made.motion.seconds(), seconds, made.seed);
      print_followed(made.evidence);
      if (i == 0 || options.influence) print_evidence(made.evidence, made.words);
    }
    print_written(written, program);
    ++options.seed;
  }
  if (command.one_file) {
    const WrittenMotion written = write_all(command, together);
    for (nlohmann::json& entry : motions) add_written(entry, written);
  }
  finish_sheet(command.sheet, rows, program);
  print_motions(program, std::move(motions));
}

}  // namespace remomask::tools
