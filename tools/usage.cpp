#include "tools/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <numeric>
#include <vector>

namespace remomask::tools {

namespace {

/// Levenshtein distance.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// The name nearest to a word, if it is near enough to be meant.
std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  std::string best;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const size_t distance = edit_distance(word, name);
    if (distance >= best_distance) continue;
    best = name;
    best_distance = distance;
  }
  return best;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

void add_option_names(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
}

/// The commands that were given, outermost first, and the first word that is not a command.
struct GivenCommands {
  std::vector<const CLI::App*> chain;
  std::string unknown;
};

GivenCommands given_commands(const CLI::App& app, const std::vector<std::string>& words) {
  GivenCommands given{{&app}, ""};
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "--threads") ++i;  // The one global option with a value.
    if (word.starts_with("-")) continue;
    const auto commands = given.chain.back()->get_subcommands({});
    if (commands.empty()) break;
    const auto next = std::find_if(commands.begin(), commands.end(), [&](const CLI::App* command) {
      return command->get_name() == word;
    });
    if (next == commands.end()) {
      given.unknown = word;
      break;
    }
    given.chain.push_back(*next);
  }
  return given;
}

/// Accepts the numbers that `accepts` takes; `limit` says which those are.
template <class Accepts>
CLI::Validator limited_number(const std::string& limit, Accepts accepts) {
  return CLI::Validator(
      [limit, accepts](const std::string& text) {
        double value = 0;
        const char* end = text.data() + text.size();
        const auto read = std::from_chars(text.data(), end, value);
        if (read.ec != std::errc() || read.ptr != end) return "\"" + text + "\" is not a number";
        return accepts(value) ? std::string() : fmt::format("must be {}, not {}", limit, text);
      },
      limit);
}

}  // namespace

std::string usage_hint(const CLI::App& app, int argc, const char* const* argv,
                       bool too_many_words) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  const GivenCommands given = given_commands(app, words);
  if (!given.unknown.empty()) {
    const std::string meant = nearest(given.unknown, command_names(*given.chain.back()));
    return "there is no command \"" + given.unknown + "\"" +
           (meant.empty() ? "" : "; did you mean \"" + meant + "\"?");
  }
  std::vector<std::string> known;
  for (const CLI::App* command : given.chain) add_option_names(*command, known);
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || std::count(known.begin(), known.end(), name) > 0) continue;
    const std::string meant = nearest(name, known);
    return "there is no option " + name + (meant.empty() ? "" : "; did you mean " + meant + "?");
  }
  const std::string& command = given.chain.back()->get_name();
  const bool takes_sentence = command == "generate" || command == "search" || command == "edit";
  if (takes_sentence && too_many_words) {
    return fmt::format("put the sentence in quotes: remomask {} \"a person waves\"", command);
  }
  return "";
}

CLI::Validator positive_number() {
  return limited_number("greater than 0", [](double value) { return value > 0; });
}

CLI::Validator at_least(int min) {
  return limited_number(fmt::format("at least {}", min),
                        [min](double value) { return value >= min; });
}

CLI::Validator number_between(double min, double max) {
  return limited_number(fmt::format("from {} to {}", min, max),
                        [min, max](double value) { return value >= min && value <= max; });
}

}  // namespace remomask::tools
