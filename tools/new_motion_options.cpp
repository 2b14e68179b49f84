#include "tools/new_motion_options.h"

#include "formats/motion_writing.h"
#include "tools/usage.h"

namespace remomask::tools {

void NewMotionOptions::add_output(CLI::App& command) {
  command.add_option("-o,--output", output, "motion file (" + formats::written_extensions() + ")")
      ->required();
}

void NewMotionOptions::add_count(CLI::App& command) {
  command.add_option("--seed", generation.generate.seed, "same seed, same motion")
      ->capture_default_str();
  command.add_option("-n,--count", count, "number of motions, seeds SEED, SEED+1, ...")
      ->capture_default_str()
      ->check(number_between(1, 1000));
}

void NewMotionOptions::add_rest(CLI::App& command) {
  files.add_model(command);
  files.add_database(command);
  filter.add(command);
  generation.add(command);
  overwrite.add(command);
  writing.add(command);
}

}  // namespace remomask::tools
