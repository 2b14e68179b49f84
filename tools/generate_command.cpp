#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "base/error.h"
#include "motion/motion_file.h"
#include "text/caption.h"
#include "tools/contact_sheet.h"
#include "tools/generation_options.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask {

namespace {

namespace fs = std::filesystem;

/// The output of sample `i` of `count`: NAME.bvh, or NAME-1.bvh, NAME-2.bvh ...
std::string sample_path(const std::string& output, int i, int count) {
  if (count == 1) return output;
  const fs::path path(output);
  return (path.parent_path() /
          fmt::format("{}-{}{}", path.stem().string(), i + 1, path.extension().string()))
      .string();
}

/// Before minutes of work: can the result be stored at all?
void require_writable_output(const std::string& output) {
  const fs::path path(output);
  if (path.extension() != ".bvh" && path.extension() != ".npy") {
    throw Error("output \"" + output + "\": the format is chosen by the ending .bvh or .npy");
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) {
    throw Error("output \"" + output + "\": the folder does not exist; create it first");
  }
}

}  // namespace

void register_generate(CLI::App& app, Program& program) {
  struct Options {
    std::string prompt, output, sheet;
    FileOptions files;
    FilterOptions filter;
    GenerationOptions generation;
    uint64_t seed = 0;
    int count = 1;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "generate", "a sentence in, a motion file out, with its evidence",
                  "remomask generate \"a person walks forward and waves\" -o motion.bvh");
  command->add_option("prompt", options->prompt, "what the person does")->required();
  command->add_option("-o,--output", options->output, "motion file (.bvh or .npy)")->required();
  command->add_option("--sheet", options->sheet, "also draw a contact sheet (.png)");
  command->add_option("--seconds", options->generation.generate.seconds,
                      "length, 1 to 9.8; default: as the retrieved motions");
  command->add_option("--seed", options->seed, "same seed, same motion")->capture_default_str();
  command->add_option("-n,--count", options->count, "number of motions, seeds SEED, SEED+1, ...")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->filter.add(*command);
  options->generation.add(*command);
  command->callback([options, &program] {
    require_writable_output(options->output);
    normalise_prompt(options->prompt);
    if (options->prompt.size() > kMostCaptionBytes) {
      program.warn(
          fmt::format("only the first {} characters of the prompt can be read", kMostCaptionBytes));
    }
    const Monitor monitor = program.monitor();
    const std::string model_path = options->files.model_path();
    const GenerationWorkspace workspace(load_model(model_path), model_path, options->files,
                                        options->generation);
    const ClipFilter evidence_filter = options->filter.filter();
    nlohmann::json results = nlohmann::json::array();
    std::vector<SheetRow> rows;
    for (int i = 0; i < options->count; ++i) {
      if (monitor.stop_requested()) {
        throw Interrupted(fmt::format("stopped; {} of {} motions are stored", i, options->count));
      }
      const auto start = std::chrono::steady_clock::now();
      const uint64_t seed = options->seed + static_cast<uint64_t>(i);
      const EvidencedMotion made = workspace.generate(options->prompt, seed, evidence_filter);
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const std::string path = sample_path(options->output, i, options->count);
      const nlohmann::json evidence = hits_json(made.hits);
      save_motion_file(path, made.generated.motion,
                       {{"prompt", options->prompt},
                        {"seed", std::to_string(seed)},
                        {"generator", workspace.identity()},
                        {"database", workspace.search().database().uuid()},
                        {"evidence", evidence.dump()}});
      results.push_back({{"file", path},
                         {"prompt", options->prompt},
                         {"seed", seed},
                         {"frames", made.generated.motion.frames},
                         {"generator", workspace.identity()},
                         {"seconds_of_work", seconds},
                         {"evidence", evidence}});
      rows.push_back({options->prompt, evidence_line(evidence), made.generated.motion});
      if (!program.json) {
        fmt::print("{}: {} frames ({:.1f} s of motion) in {:.2f} s, seed {}\n", path,
                   made.generated.motion.frames, made.generated.motion.frames / 20.0, seconds,
                   seed);
        if (i == 0 && !made.hits.empty()) fmt::print("made from the retrieved motions\n");
        for (const MotionHit& hit : made.hits) {
          if (i > 0) break;
          fmt::print("  {:.3f}  {:<28} {}\n", hit.similarity, hit.clip.name,
                     hit.clip.captions.empty() ? "" : hit.clip.captions.front());
        }
      }
    }
    if (!options->sheet.empty()) {
      write_contact_sheet(options->sheet, rows);
      if (!program.json) fmt::print("{}: contact sheet\n", options->sheet);
    }
    program.print_json({{"motions", results}});
  });
}

}  // namespace remomask
