#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "drawing/contact_sheet.h"
#include "formats/motion_file.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "tools/generate_script.h"
#include "tools/generation_options.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

namespace {

void check_prompt_or_script(const std::string& prompt, const std::string& script,
                            const GenerationOptions& generation, int count) {
  if (script.empty()) return;
  if (!prompt.empty()) throw Error("give a sentence or a --script, not both");
  if (count != 1 || generation.generate.seconds) {
    throw Error(
        "--count and --seconds are for one sentence; a script says its seconds "
        "line by line");
  }
}

void print_evidence(const nlohmann::json& evidence) {
  const auto is_read = [](const auto& hit) { return hit.at("read").template get<bool>(); };
  const bool any = std::any_of(evidence.begin(), evidence.end(), is_read);
  if (!evidence.empty()) {
    fmt::print("{}\n", any ? "made from the retrieved motions"
                           : "made from the text alone; of the retrieved motions none fits");
  }
  for (const auto& hit : evidence) {
    if (any && !is_read(hit)) continue;
    const nlohmann::json& captions = hit.at("captions");
    const std::string influence =
        hit.contains("influence")
            ? fmt::format("{:3.0f} %  ", 100 * hit.at("influence").get<double>())
            : "";
    fmt::print("  {:.3f}  {}{:<28} {}\n", hit.at("similarity").get<double>(), influence,
               hit.at("clip").get<std::string>(),
               captions.empty() ? "" : captions.front().get<std::string>());
  }
}

}  // namespace

void register_generate(CLI::App& app, Program& program) {
  struct Options {
    std::string prompt, script, output, sheet;
    FileOptions files;
    FilterOptions filter;
    GenerationOptions generation;
    uint64_t seed = 0;
    int count = 1;
    bool influence = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "generate", "a sentence in, a motion file out, with its evidence",
                  "remomask generate \"a person walks forward and waves\" -o motion.bvh");
  const CLI::Option* prompt =
      command->add_option("prompt", options->prompt, "what the person does");
  command->add_option("--script", options->script,
                      "several sentences in a row, instead of the prompt: a file with a line "
                      "\"SECONDS  sentence\" each");
  command->add_option("-o,--output", options->output, "motion file (.bvh or .npy)")->required();
  command->add_option("--sheet", options->sheet, "also draw a contact sheet (.png)");
  command->add_option("--seconds", options->generation.generate.seconds,
                      "length, 1 to 600, kept to the frame (20 a second); default: see --length");
  command
      ->add_option("--length", options->generation.length,
                   "without --seconds: the median of the retrieved motions (evidence), the "
                   "likeliest length of motions like the sentence (likely), or one drawn by the "
                   "seed (sample)")
      ->capture_default_str()
      ->check(CLI::IsMember({"evidence", "likely", "sample"}));
  command->add_option("--seed", options->seed, "same seed, same motion")->capture_default_str();
  command->add_option("-n,--count", options->count, "number of motions, seeds SEED, SEED+1, ...")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--influence", options->influence,
                    "also say what share of the codes would be others without each retrieved "
                    "motion (as many generations more)");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->filter.add(*command);
  options->generation.add(*command);
  command->callback([options, prompt, &program] {
    if (prompt->count() == 0 && options->script.empty()) {
      throw CLI::RequiredError("a sentence, or --script");
    }
    require_writable_output(options->output);
    check_prompt_or_script(options->prompt, options->script, options->generation, options->count);
    if (options->script.empty()) text::normalise_prompt(options->prompt);
    if (options->prompt.size() > text::kMostCaptionBytes) {
      program.warn(fmt::format("only the first {} characters of the prompt can be read",
                               text::kMostCaptionBytes));
    }
    const Monitor monitor = program.monitor();
    const std::string model_path = options->files.model_path();
    const GenerationWorkspace workspace(nn::load_model(model_path), model_path, options->files,
                                        options->generation);
    const search::ClipFilter evidence_filter = options->filter.filter();
    if (!options->script.empty()) {
      return run_script(workspace, options->script, options->output, options->sheet, options->seed,
                        evidence_filter, program);
    }
    nlohmann::json results = nlohmann::json::array();
    std::vector<drawing::SheetRow> rows;
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
      const nlohmann::json evidence =
          workspace.evidence_json(options->prompt, made, options->influence);
      const nlohmann::json followed = followed_json(made.generated.followed, evidence);
      formats::save_motion_file(path, made.generated.motion,
                                {{"prompt", options->prompt},
                                 {"seed", std::to_string(seed)},
                                 {"generator", workspace.identity()},
                                 {"database", workspace.search().database().uuid()},
                                 {"candidates", made.candidates.dump()},
                                 {"followed", followed.dump()},
                                 {"evidence", evidence.dump()}});
      results.push_back({{"file", path},
                         {"prompt", options->prompt},
                         {"seed", seed},
                         {"frames", made.generated.motion.frames},
                         {"generator", workspace.identity()},
                         {"candidates", made.candidates},
                         {"length", made.length},
                         {"followed", followed},
                         {"seconds_of_work", seconds},
                         {"evidence", evidence}});
      rows.push_back({options->prompt, evidence_line(evidence), made.generated.motion});
      if (!program.json) {
        fmt::print("{}: {} frames ({:.1f} s of motion) in {:.2f} s, seed {}\n", path,
                   made.generated.motion.frames, made.generated.motion.frames / 20.0, seconds,
                   seed);
        if (!followed.is_null()) {
          fmt::print("  {:.0f} % of its frames began as {}\n",
                     100 * followed.at("share").get<double>(),
                     followed.at("clip").get<std::string>());
        }
        if (i == 0 || options->influence) print_evidence(evidence);
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
