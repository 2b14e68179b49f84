#include <fmt/format.h>

#include <filesystem>

#include "base/error.h"
#include "motion/motion_file.h"
#include "tools/contact_sheet.h"
#include "tools/program.h"

namespace remomask {

void register_sheet(CLI::App& app, Program& program) {
  struct Options {
    std::vector<std::string> inputs, titles;
    std::string output;
    SheetOptions sheet;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(app, "sheet", "draw motion files as a contact sheet (PNG)",
                                  "remomask sheet walk.bvh wave.npy -o sheet.png");
  command->add_option("inputs", options->inputs, "motion files, one row each")->required();
  command->add_option("-o,--output", options->output, "picture (.png)")->required();
  command->add_option("--title", options->titles, "title of each row; default: the file name");
  command->add_option("--heading", options->sheet.heading, "above all rows");
  command->add_option("--poses", options->sheet.poses, "poses in a row")->capture_default_str();
  command->callback([options, &program] {
    if (options->titles.size() > options->inputs.size()) {
      throw Error("there are more --title than motion files");
    }
    std::vector<SheetRow> rows;
    for (size_t i = 0; i < options->inputs.size(); ++i) {
      const std::string& input = options->inputs[i];
      rows.push_back({i < options->titles.size() ? options->titles[i]
                                                 : std::filesystem::path(input).filename().string(),
                      "", load_motion_file(input).motion});
    }
    write_contact_sheet(options->output, rows, options->sheet);
    if (program.json) return program.print_json({{"output", options->output}});
    fmt::print("{}: {} motions\n", options->output, rows.size());
  });
}

}  // namespace remomask
