#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "db/clip_filter.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// Which clips a command is about: by name or #number, by the filters of a
/// search, or by both (those of the named that pass).
struct ClipSelection {
  std::vector<std::string> clips;
  FilterOptions filter;

  void add(CLI::App& command);
  bool empty() const;
  /// Ascending; all clips when nothing is selected. Throws Error for a clip that
  /// is not there.
  std::vector<int64_t> ids(const db::Database& database) const;
  /// The same for commands that change clips: throws Error when nothing is selected.
  std::vector<int64_t> chosen_ids(const db::Database& database) const;
};

/// The clip of this name, or of this number if written as #12. Throws Error if there is none.
int64_t find_clip(const db::Database& database, const std::string& name_or_id);

/// {"key=value", ...} -> labels. Numbers, true, false, null, lists and objects are
/// read as JSON, other values are texts. Throws Error for anything that is not such a pair.
nlohmann::json parse_labels(const std::vector<std::string>& pairs);

}  // namespace remomask::tools
