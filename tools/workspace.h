#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "remomask/search.h"
#include "tools/program.h"

namespace remomask::tools {

/// --model and --db with the shipped files as defaults.
struct FileOptions {
  std::string model, database, index, text;

  /// With --text, the file of the sentence encoder that goes with the model.
  void add_model(CLI::App& command);
  void add_database(CLI::App& command);
  std::string model_path() const;
  std::string database_path() const;
};

/// Options that choose which clips a search may return.
struct FilterOptions {
  std::vector<std::string> splits, labels, tags, licences;
  std::optional<double> min_seconds, max_seconds, min_speed, max_speed;
  std::string words, caption_query;

  void add(CLI::App& command);
  ClipFilter filter() const;
};

}  // namespace remomask::tools
