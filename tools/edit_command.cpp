#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "drawing/contact_sheet.h"
#include "formats/motion_file.h"
#include "pipeline/editing.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "tools/candidate_list.h"
#include "tools/edit_spans.h"
#include "tools/generation_options.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

namespace {

/// What was made anew: a list of {part, first, last} in frames, last exclusive.
nlohmann::json cells_json(const motion::PartMask& mask) {
  const motion::BodyPartMap& map = motion::body_parts(humanml_skeleton());
  nlohmann::json list = nlohmann::json::array();
  for (int part = 0; part < motion::kBodyParts; ++part) {
    for (const motion::FrameRun& run : motion::part_runs(mask, part)) {
      list.push_back({{"part", map.names[static_cast<size_t>(part)]},
                      {"first", run.first},
                      {"last", run.last}});
    }
  }
  return list;
}

}  // namespace

void register_edit(CLI::App& app, Program& program) {
  struct Options {
    std::string input, output, prompt, spans, sheet;
    std::vector<std::string> parts, cells;
    double extend = 0;
    FileOptions files;
    FilterOptions filter;
    GenerationOptions generation;
    pipeline::EditOptions edit;
    uint64_t seed = 0;
    int count = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      app, "edit", "make spans and body parts of a motion anew, the rest stays as it is",
      "remomask edit walk.bvh -o edited.bvh --prompt \"someone waves\" --span 1-3 --parts "
      "left_arm");
  command->add_option("input", options->input, "motion file (.bvh or .npy)")->required();
  command->add_option("-o,--output", options->output, "motion file (.bvh or .npy)")->required();
  command->add_option("--prompt", options->prompt, "what the person does there")->required();
  command->add_option("--span", options->spans,
                      "A-B[,C-D ...] in seconds; start and end are times, too; default with "
                      "--parts: all of the motion");
  command
      ->add_option("--parts", options->parts,
                   "only these parts: left_arm, right_arm, arms, left_leg, right_leg, legs, "
                   "upper_spine_head, root_lower_spine, torso")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_repeatable(*command, "--cells", options->cells,
                 "A-B[,C-D ...]:PART[,PART ...]: further spans with parts of their own");
  command->add_option("--extend", options->extend, "continue the motion by so many seconds")
      ->check(CLI::Range(0.0, 600.0));
  command
      ->add_option("--fade", options->edit.splice.fade,
                   "frames inside of a span over which it leaves, and meets, what stays")
      ->capture_default_str()
      ->check(CLI::Range(1, 40));
  command->add_option("--seed", options->seed, "same seed, same motion")->capture_default_str();
  command->add_option("-n,--count", options->count, "number of motions, seeds SEED, SEED+1, ...")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_option("--sheet", options->sheet, "draw before and after as a contact sheet (.png)");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->filter.add(*command);
  options->generation.generate.follow = options->edit.generate.follow;
  options->generation.add(*command);
  command->callback([options, &program] {
    require_writable_output(options->output);
    text::normalise_prompt(options->prompt);
    formats::MotionFileOptions reading;
    reading.canonical = false;
    const Motion original = formats::load_motion_file(options->input, reading).motion;
    const std::vector<pipeline::EditSpan> spans =
        parse_edit_spans(options->spans, options->parts, options->cells, original.frames);
    pipeline::EditOptions edit = options->edit;
    edit.extend_frames = static_cast<int>(std::lround(options->extend * 20));
    if (spans.empty() && edit.extend_frames == 0) {
      throw Error("there is nothing to edit; name a --span, --parts, --cells or --extend");
    }
    const Monitor monitor = program.monitor();
    const std::string model_path = options->files.model_path();
    const GenerationWorkspace workspace(nn::load_model(model_path), model_path, options->files,
                                        options->generation);
    const Evidence found = workspace.find_evidence(options->prompt, options->filter.filter());
    const nlohmann::json evidence = evidence_list(found);
    nlohmann::json results = nlohmann::json::array();
    std::vector<drawing::SheetRow> rows = {{"before", options->input, original}};
    for (int i = 0; i < options->count; ++i) {
      if (monitor.stop_requested()) {
        throw Interrupted(fmt::format("stopped; {} of {} motions are stored", i, options->count));
      }
      const auto start = std::chrono::steady_clock::now();
      const uint64_t seed = options->seed + static_cast<uint64_t>(i);
      CandidateList<pipeline::Edited> candidates(workspace.search().retriever(), options->prompt);
      for (const uint64_t number : candidate_seeds(seed, workspace.best_of())) {
        edit.generate = workspace.generate_options(number);
        pipeline::Edited one = pipeline::edit_motion(workspace.generator(), original, spans,
                                                     options->prompt, found.motions, edit);
        const Motion motion = one.motion;
        const double bend = one.splice.path_shift + one.splice.path_turn;
        candidates.add(std::move(one), number, motion, bend);
      }
      const pipeline::Edited made = candidates.take_best();
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const std::string path = sample_path(options->output, i, options->count);
      const nlohmann::json cells = cells_json(made.mask);
      formats::save_motion_file(path, made.motion,
                                {{"prompt", options->prompt},
                                 {"edited", options->input},
                                 {"cells", cells.dump()},
                                 {"seed", std::to_string(seed)},
                                 {"generator", workspace.identity()},
                                 {"database", workspace.search().database().uuid()},
                                 {"evidence", evidence.dump()}});
      const double turn = made.splice.path_turn * 180 / std::numbers::pi;
      results.push_back({{"file", path},
                         {"prompt", options->prompt},
                         {"seed", seed},
                         {"frames", made.motion.frames},
                         {"cells", cells},
                         {"tokens", made.tokens},
                         {"tokens_sampled", made.tokens_sampled},
                         {"path_shift_metres", made.splice.path_shift},
                         {"path_turn_degrees", turn},
                         {"generator", workspace.identity()},
                         {"candidates", candidates.ranking()},
                         {"followed", followed_json(made.followed, evidence)},
                         {"seconds_of_work", seconds},
                         {"evidence", evidence}});
      rows.push_back({options->prompt, evidence_line(evidence), made.motion});
      if (program.json) continue;
      fmt::print("{}: {} frames, {} of {} tokens new, in {:.2f} s, seed {}\n", path,
                 made.motion.frames, made.tokens_sampled, made.tokens, seconds, seed);
      if (made.splice.path_shift > 0 || turn > 0) {
        fmt::print("  path bent by {:.2f} m and {:.0f} degrees to meet both ends\n",
                   made.splice.path_shift, turn);
      }
    }
    if (!options->sheet.empty()) {
      drawing::write_contact_sheet(options->sheet, rows);
      if (!program.json) fmt::print("{}: contact sheet\n", options->sheet);
    }
    program.print_json({{"motions", results}});
  });
}

}  // namespace remomask::tools
