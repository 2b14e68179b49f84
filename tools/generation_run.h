#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drawing/contact_sheet.h"
#include "remomask/text_to_motion.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

// What the runs of generate, edit, search and evaluate generation share.

/// The library's face on the files and threads that were chosen. `retrieval`: as in OpenOptions.
TextToMotion open_model(const FileOptions& files, const Program& program, bool retrieval = true);

/// The text file that goes with the model, unless --text names another.
std::string text_file(const FileOptions& files);

/// Throws Interrupted that says how to make the motions that are missing: `done` of `count` are
/// stored, the next one has `seed`.
[[noreturn]] void stop_after(int done, int count, uint64_t seed);

/// A motion's document with the file that it was written to and the seconds that it took.
nlohmann::json answer_entry(nlohmann::json document, const std::string& path, double seconds);
/// The answer of generate and edit (docs/schema/motions.json).
void print_motions(Program& program, nlohmann::json motions);

/// Draws a contact sheet and says so; nothing for an empty path.
void finish_sheet(const std::string& path, const std::vector<drawing::SheetRow>& rows,
                  const Program& program);

}  // namespace remomask::tools
