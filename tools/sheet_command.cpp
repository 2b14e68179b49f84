#include <fmt/format.h>

#include <filesystem>

#include "base/counted.h"
#include "base/file.h"
#include "drawing/contact_sheet.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tools/evidence_text.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"

namespace remomask::tools {

namespace {

/// Sentence and retrieved clips where the motion was generated, else the name of the file.
void label_row(const std::string& path, drawing::SheetRow& row) {
  const SidecarText text = read_sidecar_text(path);
  row.title = text.title.empty() ? std::filesystem::path(path).filename().string() : text.title;
  row.subtitle = text.subtitle;
}

}  // namespace

void register_sheet(CLI::App& app, Program& program) {
  struct Options {
    std::vector<std::string> inputs, titles;
    std::string output;
    drawing::SheetOptions sheet;
    MotionFileOptions reading;
    OutputOptions overwrite;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(app, "sheet", "draw motion files as a contact sheet (PNG)",
                                  "remomask sheet walk.bvh wave.npy -o sheet.png");
  command->add_option("inputs", options->inputs, "motion files, one row each")->required();
  command->add_option("-o,--output", options->output, "picture (.png)")->required();
  options->overwrite.add(*command);
  command->add_option("--title", options->titles,
                      "title of each row; default: prompt or file name");
  add_reading_options(*command, options->reading);
  command->add_option("--heading", options->sheet.heading, "above all rows");
  command->add_option("--poses", options->sheet.poses, "poses in a row")->capture_default_str();
  command->callback([options, &program] {
    if (std::filesystem::path(options->output).extension() != ".png") {
      throw Error("output \"" + options->output +
                  "\": contact sheets are PNG files; end it in .png");
    }
    if (options->titles.size() > options->inputs.size()) {
      throw Error("there are more --title than motion files");
    }
    std::vector<drawing::SheetRow> rows;
    for (size_t i = 0; i < options->inputs.size(); ++i) {
      drawing::SheetRow row;
      label_row(options->inputs[i], row);
      if (i < options->titles.size()) row.title = options->titles[i];
      row.motion = load_motion_of_user(options->inputs[i], options->reading, program);
      rows.push_back(row);
    }
    options->overwrite.check(options->output, "", program);
    drawing::write_contact_sheet(options->output, rows, options->sheet);
    if (program.json) return program.print_json({{"output", options->output}});
    fmt::print("{}: {}\n", options->output, counted(static_cast<int64_t>(rows.size()), "motion"));
  });
}

}  // namespace remomask::tools
