#pragma once

#include <CLI/App.hpp>
#include <string>

namespace remomask::tools {

/// What a person probably meant who used the program wrongly: the nearest command or option, or
/// quotes around a sentence. Empty if nothing is near.
/// `too_many_words`: the arguments had words that belong to nothing.
std::string usage_hint(const CLI::App& app, int argc, const char* const* argv, bool too_many_words);

/// Validators whose messages name the number and the limit as people write them.
CLI::Validator positive_number();
CLI::Validator at_least(int min);
CLI::Validator number_between(double min, double max);

}  // namespace remomask::tools
