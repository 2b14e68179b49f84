#include <fmt/format.h>

#include "formats/motion_file.h"
#include "remomask/error.h"
#include "search/motion_search.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

namespace {

struct SearchCommandOptions {
  search::SearchQuery query;
  FileOptions files;
  FilterOptions filter;
  std::string like_file;
  std::optional<double> from, to;
  bool ungrouped = false, captions = false;
};

void add_query_options(CLI::App& command, SearchCommandOptions& options) {
  search::SearchQuery& query = options.query;
  command.add_option("text", query.text,
                     "what to look for; clips with a word that follows a minus are left out");
  command.add_option("--like", options.like_file, "a motion file (BVH, npy): more like this");
  command.add_option("--from", options.from, "of the motion file: from this second");
  command.add_option("--to", options.to, "of the motion file: up to this second");
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
                     "clips with any of these words in a caption come up");
  command.add_option("--boost-weight", query.boost_weight, "of the ranking by words")
      ->capture_default_str();
  command.add_flag("--captions", options.captions,
                   "list captions that describe the motion, instead of clips");
}

void add_result_options(CLI::App& command, SearchCommandOptions& options) {
  command.add_option("-k", options.query.k, "number of hits")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command.add_flag("--ungrouped", options.ungrouped,
                   "list windows, mirror copies and duplicates of a motion one by one");
  command.add_option("--least-similarity", options.query.least_similarity,
                     "leave out what is less similar (cosine)");
  command.add_option("--least-probability", options.query.least_probability,
                     "leave out what is less probably right, by the calibration that \"remomask "
                     "evaluate calibration --store\" keeps in the database");
  command.add_flag("--moments", options.query.moments, "say where in each clip");
}

search::SearchQuery complete_query(const SearchCommandOptions& options) {
  search::SearchQuery query = options.query;
  query.filter = options.filter.filter();
  query.grouped = !options.ungrouped;
  if (!options.like_file.empty()) {
    query.motion = formats::load_motion_file(options.like_file).motion;
    if (options.from || options.to) {
      query.motion = search::cut_motion(*query.motion, options.from.value_or(0), options.to);
    }
  } else if (options.from || options.to) {
    throw Error("--from and --to choose a piece of a motion file; name one with --like");
  }
  search::check_query(query);  // before the model is loaded
  return query;
}

search::MotionSearch open_search(const SearchCommandOptions& options) {
  return search::MotionSearch(options.files.model_path(), options.files.database_path(),
                              options.files.index_path());
}

nlohmann::json query_json(const SearchCommandOptions& options) {
  nlohmann::json query = {{"query", options.query.text}};
  if (!options.like_file.empty()) query["like"] = options.like_file;
  if (!options.query.like_clip.empty()) query["like_clip"] = options.query.like_clip;
  return query;
}

nlohmann::json motion_hit_json(const search::MotionHit& hit) {
  nlohmann::json json = hit_json(hit);
  json["folded"] = hit.folded;
  json["tags"] = hit.clip.tags;
  if (hit.probability) json["probability"] = *hit.probability;
  if (hit.moment) {
    json["moment"] = {{"start", hit.moment->start},
                      {"end", hit.moment->end},
                      {"similarity", hit.moment->similarity}};
  }
  return json;
}

/// "0.713", with a probability "0.713 (82 %)".
std::string score_text(const search::MotionHit& hit) {
  std::string text = fmt::format("{:.3f}", hit.similarity);
  if (hit.probability) text += fmt::format(" ({:.0f} %)", 100 * *hit.probability);
  return text;
}

void print_hit(const search::MotionHit& hit) {
  std::string where = fmt::format("{:5.1f} s", search::clip_seconds(hit.clip));
  if (hit.moment) where += fmt::format(", {:.1f} to {:.1f} s", hit.moment->start, hit.moment->end);
  fmt::print("{:3}  {}  {}  {:<32} {}{}\n", hit.rank, score_text(hit), where, hit.clip.name,
             hit.clip.captions.empty() ? "" : hit.clip.captions.front(),
             hit.folded > 0 ? fmt::format(" (+{} of the same motion)", hit.folded) : "");
}

void print_answer(const search::SearchAnswer& answer) {
  if (answer.candidates == 0) {
    fmt::print("no clip passes the filters\n");
  } else if (answer.hits.empty() && answer.refused) {
    fmt::print("nothing fits: the most similar of {} clips is {} with {}, below the limit\n",
               answer.candidates, answer.refused->clip.name, score_text(*answer.refused));
  }
  for (const search::MotionHit& hit : answer.hits) print_hit(hit);
}

void search_clips(const SearchCommandOptions& options, Program& program) {
  const search::SearchQuery query = complete_query(options);
  const search::SearchAnswer answer = open_search(options).search(query);
  if (!program.json) {
    print_answer(answer);
    if (answer.unsearched > 0) {
      program.warn(
          fmt::format("{} clips have no vectors yet and were not searched; run: remomask "
                      "index {}",
                      answer.unsearched, options.files.database_path()));
    }
    return;
  }
  nlohmann::json document = query_json(options);
  document["candidates"] = answer.candidates;
  document["clips_without_vectors"] = answer.unsearched;
  if (!query.boost_words.empty()) document["boosted"] = answer.boosted;
  document["hits"] = nlohmann::json::array();
  for (const search::MotionHit& hit : answer.hits) document["hits"].push_back(motion_hit_json(hit));
  if (answer.refused) document["refused"] = motion_hit_json(*answer.refused);
  program.print_json(document);
}

void search_captions(const SearchCommandOptions& options, Program& program) {
  const search::SearchQuery query = complete_query(options);
  const std::vector<search::CaptionHit> hits = open_search(options).captions_for(query);
  if (!program.json) {
    if (hits.empty()) fmt::print("no clip with captions passes the filters\n");
    for (const search::CaptionHit& hit : hits) {
      fmt::print("{:3}  {:.3f}  {:<60} {}{}\n", hit.rank, hit.similarity, hit.caption,
                 hit.clips.front(),
                 hit.clips.size() > 1 ? fmt::format(" (+{})", hit.clips.size() - 1) : "");
    }
    return;
  }
  nlohmann::json document = query_json(options);
  document["captions"] = nlohmann::json::array();
  for (const search::CaptionHit& hit : hits) {
    document["captions"].push_back({{"rank", hit.rank},
                                    {"caption", hit.caption},
                                    {"similarity", hit.similarity},
                                    {"clips", hit.clips}});
  }
  program.print_json(document);
}

}  // namespace

void register_search(CLI::App& app, Program& program) {
  auto options = std::make_shared<SearchCommandOptions>();
  CLI::App* command = add_command(app, "search", "find motions by meaning or by example",
                                  "remomask search \"someone waves\" -k 5 --min-seconds 2\n"
                                  "  remomask search \"a person walks -backward\"\n"
                                  "  remomask search --like walk.bvh --parts arms\n"
                                  "  remomask search --like walk.bvh --captions");
  add_query_options(*command, *options);
  options->files.add_database(*command);
  options->files.add_model(*command);
  options->filter.add(*command);
  add_result_options(*command, *options);
  command->callback([options, &program] {
    options->captions ? search_captions(*options, program) : search_clips(*options, program);
  });
}

}  // namespace remomask::tools
