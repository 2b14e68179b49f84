#pragma once

#include <string>
#include <vector>

#include "remomask/generation.h"

namespace remomask::tools {

/// The hits that a motion was made with, in one line: "retrieved: NAME (0.81), ..."; empty without
/// any.
std::string evidence_line(const std::vector<Evidence>& evidence);

/// Why none of the retrieved motions was read, in a sentence for people.
std::string evidence_refusal(const std::vector<Evidence>& evidence);

/// What was not understood, in a line for people: typing errors that were corrected, and words that
/// nothing in the database shows. Empty where all was.
std::string words_text(const std::vector<QueryWord>& words,
                       const std::vector<CorrectedWord>& corrected = {});

/// That a sentence is in no language that is understood, in a line for people. Empty for English.
std::string language_text(const std::string& language);

/// Title and subtitle of a motion file for a contact sheet, from its sidecar; empty without one.
/// Sidecars of version 0.1, whose members are strings, are read, too. Throws FileError for a
/// sidecar that is neither.
struct SidecarText {
  std::string title, subtitle;
};
SidecarText read_sidecar_text(const std::string& motion_path);

}  // namespace remomask::tools
