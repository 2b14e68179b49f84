#pragma once

#include <CLI/App.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nn/model_file.h"
#include "remomask/search.h"
#include "tools/program.h"

namespace remomask::tools {

/// --model and --db with the shipped files as defaults.
struct FileOptions {
  std::string model, database, index;

  void add_model(CLI::App& command);
  void add_database(CLI::App& command);
  std::string model_path() const;
  std::string database_path() const;
  std::string index_path() const;  ///< --index, or beside the database
};

/// Options that choose which clips a search may return.
struct FilterOptions {
  std::vector<std::string> splits, labels, tags, licences;
  std::optional<double> min_seconds, max_seconds, min_speed, max_speed;
  std::string words, caption_query;

  void add(CLI::App& command);
  ClipFilter filter() const;
};

/// The stage of `kind`; throws Error that names the model file when it lacks it.
const nn::ModelStage& require_stage(const std::map<std::string, nn::ModelStage>& stages,
                                    const std::string& kind, const std::string& model_path);

}  // namespace remomask::tools
