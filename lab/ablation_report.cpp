#include "lab/ablation_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/file.h"
#include "base/json.h"
#include "lab/variants.h"
#include "nn/model_file.h"
#include "remomask/error.h"

namespace remomask::lab {

namespace {

const std::vector<std::string> kSubsets = {"take", "pair", "rare"};

nlohmann::json read_trial(const AblationTrial& trial) {
  auto document = try_parse_json(read_file(trial.file));
  if (!document.is_object() || !document.contains("figures")) {
    throw FileError(trial.file, 0, "is not the result of a trial; remove it and run again");
  }
  return document;
}

/// Weights that a generation uses besides the sentence encoder.
int64_t model_weights(const AblationModel& model) {
  int64_t count = 0;
  for (const auto& [stage, file] : model.files) {
    for (const auto& [name, tensor] : nn::load_stage(file, stage).tensors) count += tensor.numel();
  }
  return count;
}

nlohmann::json stage_settings(const AblationPlan& plan) {
  nlohmann::json settings;
  for (const AblationModel& model : plan.models) {
    for (const std::string& stage : training::recipe_stages(model.recipe)) {
      const auto description = training::stage_description(model.recipe, stage);
      settings[stage] = {{"steps", description["trainer"]["steps"]},
                         {"learning_rate", description["trainer"]["learning_rate"]}};
      for (const char* size : {"batch", "batch_frames"}) {
        if (description["training"].contains(size)) {
          settings[stage][size] = description["training"][size];
        }
      }
    }
  }
  return settings;
}

std::string number_text(double value, const AblationColumn& column) {
  return fmt::format("{:.{}f}", column.scale * value, column.digits);
}

/// "64.0 (61.3-66.2)", or "64.0" of one seed, "-" without a figure.
std::string cell_text(const std::vector<double>& values, const AblationColumn& column) {
  if (values.empty()) return "-";
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  if (values.size() == 1) return number_text(mean, column);
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("{} ({}-{})", number_text(mean, column), number_text(*least, column),
                     number_text(*most, column));
}

std::string table_head(const std::vector<std::string>& titles) {
  std::string line = "|", rule = "|";
  for (const std::string& title : titles) {
    line += " " + title + " |";
    rule += "---|";
  }
  return line + "\n" + rule + "\n";
}

std::string table_row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

int subset_prompts(const nlohmann::json& document, const std::string& subset) {
  const auto& real = document.at("real");
  return real.contains(subset) ? real.at(subset).at("prompts").get<int>() : 0;
}

std::string main_table(const nlohmann::json& document) {
  std::vector<std::string> titles = {"variant", "what differs", "weights"};
  for (const AblationColumn& column : ablation_columns()) titles.push_back(column.title);
  std::string text = table_head(titles);
  const nlohmann::json real = one_seed(document.at("real"));
  std::vector<std::string> cells = {"real clips", "", ""};
  for (const AblationColumn& column : ablation_columns()) {
    cells.push_back(cell_text(seed_values(real, "all", column.path), column));
  }
  cells.back() = "-";  // the foot skate of stored clips is not measured here
  text += table_row(cells);
  for (const auto& variant : document.at("variants")) {
    cells = {variant.at("name"), variant.at("meaning"),
             fmt::format("{:.1f} M", variant.at("weights").get<double>() / 1e6)};
    for (const AblationColumn& column : ablation_columns()) {
      cells.push_back(cell_text(seed_values(variant, "all", column.path), column));
    }
    text += table_row(cells);
  }
  return text;
}

/// Content right and R@3 of the prompts that training made hard.
std::string subset_table(const nlohmann::json& document) {
  const std::vector<AblationColumn> columns = {ablation_columns()[0], ablation_columns()[2]};
  std::vector<std::string> titles = {"variant"}, subsets;
  for (const std::string& subset : kSubsets) {
    const int prompts = subset_prompts(document, subset);
    if (prompts == 0) continue;
    subsets.push_back(subset);
    for (const AblationColumn& column : columns) {
      titles.push_back(fmt::format("{} ({}): {}", subset, prompts, column.title));
    }
  }
  if (subsets.empty()) return "";
  std::string text = "\n" + table_head(titles);
  const auto add_row = [&](const std::string& name, const nlohmann::json& variant) {
    std::vector<std::string> cells = {name};
    for (const std::string& subset : subsets) {
      for (const AblationColumn& column : columns) {
        cells.push_back(cell_text(seed_values(variant, subset, column.path), column));
      }
    }
    text += table_row(cells);
  };
  add_row("real clips", one_seed(document.at("real")));
  for (const auto& variant : document.at("variants")) add_row(variant.at("name"), variant);
  return text;
}

std::string sweep_table(const nlohmann::json& document, const std::string& sweep) {
  const auto& points = document.at("sweeps").at(sweep);
  if (points.empty()) return "";
  std::vector<std::string> titles = {sweep};
  for (const AblationColumn& column : ablation_columns()) titles.push_back(column.title);
  std::string text = "\n" + table_head(titles);
  for (const auto& point : points) {
    const nlohmann::json figures = one_seed(point.at("figures"));
    std::vector<std::string> cells = {fmt::format("{:g}", point.at("value").get<double>())};
    for (const AblationColumn& column : ablation_columns()) {
      cells.push_back(cell_text(seed_values(figures, "all", column.path), column));
    }
    text += table_row(cells);
  }
  return text;
}

}  // namespace

const std::vector<AblationColumn>& ablation_columns() {
  static const std::vector<AblationColumn> columns = {
      {"content right, %", "/content_right", 100, 1},
      {"R@1, %", "/metrics/r_precision/0/mean", 100, 1},
      {"R@3, %", "/metrics/r_precision/2/mean", 100, 1},
      {"FID", "/metrics/fid/mean", 1, 2},
      {"MM-Dist", "/metrics/mm_dist/mean", 1, 2},
      {"diversity", "/metrics/diversity/mean", 1, 2},
      {"foot skate, m/s", "/foot_skate", 1, 2}};
  return columns;
}

nlohmann::json one_seed(const nlohmann::json& figures) {
  nlohmann::json variant;
  variant["seeds"][0]["figures"] = figures;
  return variant;
}

std::vector<double> seed_values(const nlohmann::json& variant, const std::string& subset,
                                const std::string& path) {
  const nlohmann::json::json_pointer place("/figures/" + subset + path);
  std::vector<double> values;
  for (const auto& seed : variant.at("seeds")) {
    // What could not be measured is null in JSON.
    if (seed.contains(place) && seed.at(place).is_number()) values.push_back(seed.at(place));
  }
  return values;
}

nlohmann::json ablation_document(const AblationOptions& options, const AblationPlan& plan,
                                 const ExamResult& real, const nlohmann::json& judge) {
  nlohmann::json document = {
      {"preset", options.preset},
      {"seeds", options.seeds},
      {"stages", stage_settings(plan)},
      {"prompts", options.prompts},
      {"split", options.split},
      {"prompt_seed", options.prompt_seed},
      {"judge", judge},
      {"real", real},
      {"variants", nlohmann::json::array()},
      {"sweeps", {{"guidance", nlohmann::json::array()}, {"steps", nlohmann::json::array()}}}};
  for (const std::string& name : options.variants) {
    nlohmann::json variant = {{"name", name},
                              {"meaning", find_variant(name).meaning},
                              {"seeds", nlohmann::json::array()}};
    for (const AblationTrial& trial : plan.trials) {
      const AblationModel& model = plan.models[trial.model];
      if (!trial.sweep.empty() || model.variant != name) continue;
      variant["weights"] = model_weights(model);
      variant["seeds"].push_back(read_trial(trial));
    }
    document["variants"].push_back(variant);
  }
  for (const AblationTrial& trial : plan.trials) {
    if (trial.sweep.empty()) continue;
    const auto& sampling = trial.sampling;
    const double value = trial.sweep == "guidance" ? sampling.guidance : sampling.steps;
    document["sweeps"][trial.sweep].push_back(
        {{"value", value}, {"figures", read_trial(trial).at("figures")}});
  }
  return document;
}

std::string ablation_markdown(const nlohmann::json& document) {
  std::string trained;
  for (const auto& [stage, settings] : document.at("stages").items()) {
    trained += fmt::format("{}{} {}", trained.empty() ? "" : ", ", stage,
                           settings.at("steps").get<int64_t>());
    if (settings.contains("batch")) trained += fmt::format(" x {}", settings["batch"].dump());
    if (settings.contains("batch_frames")) {
      trained += fmt::format(" x {} frames", settings["batch_frames"].dump());
    }
  }
  const size_t seeds = document.at("seeds").size();
  std::string text = fmt::format(
      "Preset `{}`, equal budgets (steps x batch): {}. {}; {} prompts of split `{}`, one motion "
      "each, at the length of the prompt's clip; hits from the training clips. Judge: an "
      "evaluator network that no model was trained with.\n\n",
      document.at("preset").get<std::string>(), trained,
      seeds == 1 ? "One seed" : fmt::format("{} seeds, mean (min-max)", seeds),
      document.at("prompts").get<int>(), document.at("split").get<std::string>());
  text += main_table(document) + subset_table(document);
  for (const char* sweep : {"guidance", "steps"}) {
    const std::string table = sweep_table(document, sweep);
    if (table.empty()) continue;
    text += fmt::format("\nSampling of `{}` with another {}:\n{}",
                        document.at("variants").front().at("name").get<std::string>(),
                        sweep == std::string("steps") ? "number of steps" : "guidance", table);
  }
  return text;
}

}  // namespace remomask::lab
