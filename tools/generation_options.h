#pragma once

#include <CLI/App.hpp>
#include <string>

#include "remomask/generation.h"

namespace remomask::tools {

/// Options of a generation that `generate`, `edit` and `evaluate generation` share.
struct GenerationOptions {
  GenerateOptions generate;
  bool no_retrieval = false;
  std::string length = "evidence";  ///< only if no length is given

  void add(CLI::App& command);
  /// The options as they were chosen, without seed and filter.
  GenerateOptions chosen() const;
};

/// Whether a generation with these options looks into the index.
bool needs_search(const GenerationOptions& options);

}  // namespace remomask::tools
