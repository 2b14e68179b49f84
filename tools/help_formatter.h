#pragma once

#include <CLI/Formatter.hpp>
#include <string>

namespace remomask::tools {

/// Help whose columns stay narrow: limits and conditions of an option stand in its description.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace remomask::tools
