#include "tools/search_command.h"

#include <CLI/CLI.hpp>

#include "tools/core.h"
#include "tools/reading_options.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

void add_query_options(CLI::App& command, SearchCommand& options) {
  SearchQuery& query = options.query;
  command.add_option("text", query.text,
                     "what to look for; clips with a word that follows a minus are left out");
  command
      .add_option("--by", options.by,
                  "what a sentence is compared with: all (captions, words and motions), captions, "
                  "words or motion")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "captions", "words", "motion"}));
  command.add_option("--like", options.like_file,
                     "a motion file (BVH, AMC, npy, npz): more like this");
  command.add_option("--from", options.from, "of the motion file: from this second");
  command.add_option("--to", options.to, "of the motion file: up to this second");
  add_reading_options(command, options.reading);
  command.add_option("--like-clip", query.like_clip, "a stored clip by name: more like it");
  command
      .add_option("--parts", query.parts,
                  "compare only these parts of the motion: left_arm, right_arm, arms, left_leg, "
                  "right_leg, legs, upper_spine_head, root_lower_spine, torso")
      ->delimiter(',');
  command
      .add_option("--text-weight", query.text_weight, "of the sentence, beside that of the motion")
      ->capture_default_str();
  command.add_option("--motion-weight", query.motion_weight, "of the motion")
      ->capture_default_str();
  command.add_option("--boost-words", query.boost_words,
                     "clips with any of these words in a caption rank higher; with --by motion");
  command.add_option("--boost-weight", query.boost_weight, "of the ranking by words")
      ->capture_default_str();
  command.add_flag("--captions", options.captions,
                   "list captions that describe the motion, instead of clips");
}

void add_result_options(CLI::App& command, SearchCommand& options) {
  command.add_option("-k", options.query.k, "number of hits")
      ->capture_default_str()
      ->check(at_least(1));
  command.add_flag("--ungrouped", options.ungrouped,
                   "list windows, mirror copies and duplicates of a motion one by one");
  command.add_option("--min-similarity", options.query.min_similarity,
                     "leave out what is less similar (cosine)");
  command.add_option("--min-probability", options.query.min_probability,
                     "leave out what is less probably right");
  command.add_flag("--moments", options.query.moments, "say where in each clip");
}

}  // namespace

void register_search(CLI::App& app, Program& program) {
  auto options = std::make_shared<SearchCommand>();
  CLI::App* command =
      add_command(app, "search", "find motions by meaning or by example",
                  "remomask search \"someone climbs a ladder\" -k 5 --min-seconds 2\n"
                  "  remomask search \"a boxer\" --label actions=punch\n"
                  "  remomask search \"a person walks -backward\"\n"
                  "  remomask search --like walk.bvh --parts arms\n"
                  "  remomask search --like walk.bvh --captions");
  add_query_options(*command, *options);
  options->files.add_database(*command);
  options->files.add_model(*command);
  options->filter.add(*command);
  add_result_options(*command, *options);
  command->callback([options, &program] { core(program).search(*options, program); });
}

}  // namespace remomask::tools
