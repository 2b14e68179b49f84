#include "tools/help_formatter.h"

#include <CLI/CLI.hpp>

namespace remomask::tools {

namespace {

/// What CLI11 joins with a colon: "INT" and "at least 1", "TEXT" and "{bvh,npy}".
struct OptionType {
  std::string value, limit;
  bool lists_values() const { return limit.starts_with("{"); }
};

OptionType option_type(const CLI::Option& option) {
  const std::string name = option.get_type_name();
  const size_t colon = name.find(':');
  if (colon == std::string::npos) return {name, ""};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) return "";
  const OptionType type = option_type(*option);
  std::string text = " " + (type.lists_values() ? type.limit : type.value);
  if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
  if (option->get_expected_max() > 1) text += " ...";
  if (option->get_required()) text += " REQUIRED";
  return text;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const OptionType type = option_type(*option);
  const bool in_words = !type.limit.empty() && !type.lists_values();
  return option->get_description() + (in_words ? " (" + type.limit + ")" : "");
}

}  // namespace remomask::tools
