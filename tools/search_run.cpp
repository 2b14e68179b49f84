#include <fmt/format.h>

#include "base/counted.h"
#include "pipeline/motion_document.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "search/query.h"
#include "tools/evidence_text.h"
#include "tools/generation_run.h"
#include "tools/reading_options.h"
#include "tools/search_command.h"

namespace remomask::tools {

namespace {

SearchQuery complete_query(const SearchCommand& options, Program& program) {
  SearchQuery query = options.query;
  query.filter = options.filter.filter();
  query.grouped = !options.ungrouped;
  query.by = parse_search_by(options.by);
  if (!options.like_file.empty()) {
    query.motion = load_motion_of_user(options.like_file, options.reading, program);
    if (options.from || options.to) {
      query.motion = search::cut_motion(*query.motion, options.from.value_or(0), options.to);
    }
  } else if (options.from || options.to) {
    throw Error("--from and --to choose a piece of a motion file; name one with --like");
  }
  search::check_query(query);  // before the model is loaded
  return query;
}

nlohmann::json query_json(const SearchCommand& options) {
  nlohmann::json query = {{"query", options.query.text}};
  if (!options.like_file.empty()) query["like"] = options.like_file;
  if (!options.query.like_clip.empty()) query["like_clip"] = options.query.like_clip;
  return query;
}

nlohmann::json motion_hit_json(const MotionHit& hit) {
  nlohmann::json json = pipeline::hit_document(hit);
  if (hit.parts && hit.parts->guess) json["parts"]["guess"] = *hit.parts->guess;
  json["folded"] = hit.folded;
  json["tags"] = hit.clip.tags;
  if (hit.moment) {
    json["moment"] = {{"start", hit.moment->start},
                      {"end", hit.moment->end},
                      {"similarity", hit.moment->similarity}};
  }
  return json;
}

/// A sentence: the probability, and what it rests on, "92 % (caption 0.87, words 1.00, motion
/// 0.41)". Else the similarity, "0.713", with a probability "0.713 (82 %)".
std::string score_text(const MotionHit& hit) {
  if (hit.parts && hit.probability) {
    std::string text = fmt::format("{:3.0f} %", 100 * *hit.probability);
    const WordParts& parts = *hit.parts;
    text += parts.best ? fmt::format(" (caption {:.2f}, words {:.2f}", *parts.best, parts.words)
                       : " (no caption";
    if (parts.motion) text += fmt::format(", motion {:.2f}", *parts.motion);
    return text + ")";
  }
  std::string text = fmt::format("{:.3f}", hit.similarity);
  if (hit.probability) text += fmt::format(" ({:.0f} %)", 100 * *hit.probability);
  return text;
}

/// The caption that answers the sentence best, else the first.
std::string shown_caption(const MotionHit& hit) {
  if (hit.parts && !hit.parts->caption.empty()) return hit.parts->caption;
  return hit.clip.captions.empty() ? "" : hit.clip.captions.front();
}

/// What is to be known of the caption that follows.
std::string marks(const MotionHit& hit) {
  std::string text = hit.as_mirrored ? "(mirrored) " : "";
  if (hit.parts && hit.parts->guess) {
    text += fmt::format("(guessed, {:.0f} %) ", 100 * *hit.parts->guess);
  }
  return text;
}

void print_hit(const MotionHit& hit) {
  std::string where = fmt::format("{:5.1f} s", clip_seconds(hit.clip));
  if (hit.moment) where += fmt::format(", {:.1f} to {:.1f} s", hit.moment->start, hit.moment->end);
  fmt::print("{:3}  {}  {}  {:<32} {}{}\n", hit.rank, score_text(hit), where, hit.clip.name,
             marks(hit) + shown_caption(hit),
             hit.folded > 0 ? fmt::format(" (+{} of the same motion)", hit.folded) : "");
}

void print_answer(const SearchAnswer& answer) {
  if (answer.candidates == 0) {
    fmt::print("no clip passes the filters\n");
  } else if (answer.hits.empty() && answer.refused) {
    fmt::print("nothing fits: the most similar of {} is {} with {}, below the limit\n",
               counted(answer.candidates, "clip"), answer.refused->clip.name,
               score_text(*answer.refused));
  }
  std::string lead = language_text(answer.language);
  if (lead.empty()) lead = words_text(answer.words, answer.corrected);
  if (!lead.empty()) fmt::print("{}; nearest:\n", lead);
  for (const MotionHit& hit : answer.hits) print_hit(hit);
}

void search_clips(const SearchCommand& options, Program& program) {
  const SearchQuery query = complete_query(options, program);
  const SearchAnswer answer = open_model(options.files, program).search(query);
  if (!program.json) {
    print_answer(answer);
    if (answer.unsearched > 0) {
      program.warn(
          fmt::format("not searched, since vectors are missing: {}; run: remomask index {}",
                      counted(answer.unsearched, "clip"), options.files.database_path()));
    }
    return;
  }
  nlohmann::json document = query_json(options);
  document["candidates"] = answer.candidates;
  document["clips_without_vectors"] = answer.unsearched;
  if (!query.boost_words.empty()) document["boosted"] = answer.boosted;
  document["by"] = search_by_name(query.by);
  document["words"] = pipeline::words_document(answer.words);
  document["corrected"] = nlohmann::json::array();
  for (const CorrectedWord& word : answer.corrected) {
    document["corrected"].push_back({{"typed", word.typed}, {"read", word.read}});
  }
  if (!answer.language.empty()) document["language"] = answer.language;
  document["hits"] = nlohmann::json::array();
  for (const MotionHit& hit : answer.hits) document["hits"].push_back(motion_hit_json(hit));
  if (answer.refused) document["refused"] = motion_hit_json(*answer.refused);
  program.print_json(document);
}

void search_captions(const SearchCommand& options, Program& program) {
  const SearchQuery query = complete_query(options, program);
  const std::vector<CaptionHit> hits = open_model(options.files, program).captions_for(query);
  if (!program.json) {
    if (hits.empty()) fmt::print("no clip with captions passes the filters\n");
    for (const CaptionHit& hit : hits) {
      fmt::print("{:3}  {:.3f}  {:<60} {}{}\n", hit.rank, hit.similarity, hit.caption,
                 hit.clips.front(),
                 hit.clips.size() > 1 ? fmt::format(" (+{})", hit.clips.size() - 1) : "");
    }
    return;
  }
  nlohmann::json document = query_json(options);
  document["captions"] = nlohmann::json::array();
  for (const CaptionHit& hit : hits) {
    document["captions"].push_back({{"rank", hit.rank},
                                    {"caption", hit.caption},
                                    {"similarity", hit.similarity},
                                    {"clips", hit.clips}});
  }
  program.print_json(document);
}

}  // namespace

void run_search(const SearchCommand& command, Program& program) {
  command.captions ? search_captions(command, program) : search_clips(command, program);
}

}  // namespace remomask::tools
