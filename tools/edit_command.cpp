#include "tools/edit_command.h"

#include <CLI/CLI.hpp>

#include "base/time.h"
#include "tools/core.h"
#include "tools/output_path.h"
#include "tools/reading_options.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_edit(CLI::App& app, Program& program) {
  auto options = std::make_shared<EditCommand>();
  CLI::App* command = add_command(
      app, "edit", "make spans and body parts of a motion anew, the rest stays as it is",
      "remomask edit walk.bvh -o edited.bvh --prompt \"someone waves\" --span 1-3 --parts "
      "left_arm");
  command->add_option("input", options->input, "motion file (BVH, AMC, npy, npz)")->required();
  add_reading_options(*command, options->reading, "--input-fps");
  options->add_output(*command);
  command->add_option("--prompt", options->prompt, "what the person does there")->required();
  command->add_option("--span", options->spans,
                      "A-B[,C-D ...] in seconds; start and end are times, too; default with "
                      "--parts: all of the motion");
  command
      ->add_option("--parts", options->parts,
                   "only these parts: left_arm, right_arm, arms, left_leg, right_leg, legs, "
                   "upper_spine_head, root_lower_spine, torso")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_repeatable(*command, "--cells", options->cells,
                 "A-B[,C-D ...]:PART[,PART ...]: further spans with parts of their own");
  command->add_option("--extend", options->extend, "continue the motion by so many seconds")
      ->check(number_between(0.0, kMaxMotionSeconds));
  command
      ->add_option("--fade", options->fade,
                   "frames inside of a span over which it leaves, and meets, what stays")
      ->capture_default_str()
      ->check(number_between(1, 40));
  options->add_count(*command);
  command->add_option("--sheet", options->sheet, "draw before and after as a contact sheet (.png)");
  options->add_rest(*command);
  command->callback([options, &program] {
    require_writable_output(options->output);
    options->writing.chosen(options->output);
    core(program).edit(*options, program);
  });
}

}  // namespace remomask::tools
