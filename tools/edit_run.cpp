#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/counted.h"
#include "pipeline/motion_document.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tools/edit_command.h"
#include "tools/edit_spans.h"
#include "tools/evidence_text.h"
#include "tools/generation_run.h"
#include "tools/output_path.h"
#include "tools/reading_options.h"

namespace remomask::tools {

void run_edit(const EditCommand& command, Program& program) {
  using Clock = std::chrono::steady_clock;
  if (command.count == 1) command.overwrite.check(command.output, command.input, program);
  MotionFileOptions reading = command.reading;
  reading.canonical = false;
  const Motion original = load_motion_of_user(command.input, reading, program);
  const std::vector<EditSpan> spans =
      parse_edit_spans(command.spans, command.parts, command.cells, original.frames);
  EditOptions options;
  static_cast<GenerateOptions&>(options) = command.generation.chosen();
  options.fade = command.fade;
  options.extend_frames = static_cast<int>(std::lround(command.extend * original.fps));
  options.evidence = command.filter.filter();
  if (spans.empty() && options.extend_frames == 0) {
    throw Error("there is nothing to edit; name a --span, --parts, --cells or --extend");
  }
  const Monitor monitor = program.monitor();
  const TextToMotion remomask =
      open_model(command.files, program, needs_search(command.generation));
  nlohmann::json motions = nlohmann::json::array();
  std::vector<drawing::SheetRow> rows = {{"before", command.input, original}};
  for (int i = 0; i < command.count; ++i) {
    const auto start = Clock::now();
    EditedMotion made;
    try {
      made = remomask.edit(original, spans, command.prompt, options, monitor);
    } catch (const Interrupted&) {
      stop_after(i, command.count, options.seed);
    }
    program.finish_progress();
    made.original = command.input;
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const std::string path = sample_path(command.output, i, command.count);
    if (command.count > 1) command.overwrite.check(path, command.input, program);
    const WrittenMotion written = save_motion(path, made, command.writing.chosen(path));
    motions.push_back(answer_entry(pipeline::motion_document(made), path, seconds));
    add_written(motions.back(), written);
    print_written(written, program);
    rows.push_back({command.prompt, evidence_line(made.evidence), made.motion});
    ++options.seed;
    if (program.json) continue;
    fmt::print("{}: {}, {} of {} tokens new, in {:.2f} s, seed {}\n", path,
               counted(made.motion.frames, "frame"), made.tokens_sampled, made.tokens, seconds,
               made.seed);
    if (made.path_shift_metres > 0 || made.path_turn_degrees > 0) {
      fmt::print("  path bent by {:.2f} m and {:.0f} degrees to meet both ends\n",
                 made.path_shift_metres, made.path_turn_degrees);
    }
  }
  finish_sheet(command.sheet, rows, program);
  print_motions(program, std::move(motions));
}

}  // namespace remomask::tools
