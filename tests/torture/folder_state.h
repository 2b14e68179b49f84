#pragma once

#include <string>

namespace remomask {

/// All that the files of a folder say: of a database every clip with its motion, captions, tags and
/// vectors; of an index its clips; of other files the hash. Two runs of a command leave the same.
std::string state_of(const std::string& folder);

/// What is wrong with the files as they lie there: databases with defects, motions whose sidecar
/// speaks of another motion. Empty: nothing.
std::string damage_in(const std::string& folder);

/// Files of a killed process: none may be there after the next run.
std::string leftovers_in(const std::string& folder);

}  // namespace remomask
