#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "db/captions_index.h"
#include "remomask/error.h"
#include "search/coverage.h"
#include "search/hit_list.h"
#include "search/motion_search_impl.h"
#include "search/query.h"
#include "search/subject.h"
#include "text/caption.h"
#include "text/caption_mirror.h"
#include "text/words.h"

namespace remomask::search {

namespace {

constexpr size_t kCoverageCaptions = 24;  // nearest captions whose words are compared
constexpr size_t kCoverageClips = 24;     // best clips in whose captions a word may stand

/// The content words, each once, as FTS5 queries.
std::vector<std::string> content_words(const std::string& sentence) {
  std::vector<std::string> quoted;
  for (const std::string& word : text::split_words(text::normalise_caption(sentence))) {
    std::string one = is_function_word(word) ? "" : db::quote_caption_words(word);
    if (one.empty() || std::find(quoted.begin(), quoted.end(), one) != quoted.end()) continue;
    quoted.push_back(std::move(one));
  }
  return quoted;
}

/// WordFeatures::share of each clip with a word.
std::unordered_map<int64_t, double> word_shares(const db::Database& database, size_t clips,
                                                const std::vector<std::string>& words) {
  constexpr double kOfNone = 0.5;  // clips that a word which no clip has counts for
  std::unordered_map<int64_t, double> shares;
  double sum = 0;
  for (const std::string& word : words) {
    const std::vector<int64_t> with = database.clips_with_words(word);
    const double count = with.empty() ? kOfNone : static_cast<double>(with.size());
    const double weight = std::log1p(static_cast<double>(clips) / count);
    sum += weight;
    for (const int64_t id : with) shares[id] += weight;
  }
  for (auto& [id, share] : shares) share /= sum;
  return shares;
}

std::unordered_map<std::string, int> caption_vocabulary(const std::vector<db::Clip>& clips) {
  std::unordered_map<std::string, int> counts;
  for (const db::Clip& clip : clips) {
    for (const std::string& caption : clip.captions) {
      for (const std::string& word : text::split_words(text::normalise_caption(caption))) {
        ++counts[word];
      }
    }
  }
  return counts;
}

}  // namespace

SearchScene MotionSearch::Impl::word_scene(const SearchQuery& query,
                                           const Sentence& sentence) const {
  SearchScene scene;
  const std::string& hash = words->encoder->hash();
  if (!state->caption_table) {
    state->caption_table =
        std::make_shared<CaptionTable>(state->clips, database.caption_vectors(hash));
    if (state->caption_table->incomplete_clips() > 0 && state->caption_table->size() == 0) {
      state->caption_table.reset();
      throw Error(database.path() +
                  ": its captions have no vectors of this text encoder; run: remomask index " +
                  database.path());
    }
  }
  scene.state = state;
  scene.caption_table = state->caption_table;
  scene.allowed = allowed_clips(query, sentence);
  return scene;
}

SpelledSentence MotionSearch::Impl::spelled(const std::string& sentence) const {
  const auto is_word = [&](const std::string& word) {
    return words->encoder->is_word(word) ||
           !database.match_captions(db::quote_caption_words(word), 1).empty();
  };
  const auto unknown = [&](const std::string& word) {
    return word.size() >= kMinSpelledLetters && !is_word(word);
  };
  const auto typed = text::split_words(text::normalise_caption(sentence));
  // Listing all words of the database pays only where one is unknown.
  if (std::none_of(typed.begin(), typed.end(), unknown)) return {sentence, {}};
  return correct_spelling(sentence, is_word, caption_vocabulary(state->clips));
}

WordedQuery MotionSearch::Impl::worded_query(const SearchQuery& query,
                                             const Sentence& sentence) const {
  WordedQuery worded;
  worded.sentence = spelled(sentence.text);
  const std::string text = text::normalise_prompt(worded.sentence.text);
  worded.variants.emplace_back().text = text;
  const std::string mirrored = text::mirror_caption(text);
  if (mirrored != text && query.mirror) {
    worded.variants.emplace_back().text = mirrored;
    worded.variants.back().mirrored = true;
  }
  for (WordVariant& variant : worded.variants) {
    variant.caption_query = words->encoder->embed({generic_subject(variant.text)}).front();
    if (query.by == SearchBy::all) variant.motion_query = text_vector(variant.text);
    const std::vector<std::string> content = content_words(variant.text);
    if (content.empty()) continue;
    variant.matches = database.match_captions(fmt::format("{}", fmt::join(content, " OR ")));
    variant.shares = word_shares(database, state->clips.size(), content);
  }
  return worded;
}

std::vector<QueryWord> MotionSearch::Impl::coverage(const WordedQuery& worded,
                                                    const SearchScene& scene,
                                                    const std::vector<RankedClip>& ranked) const {
  CoverageQuestion question;
  question.sentence = worded.sentence.text;
  const CaptionTable& table = *scene.caption_table;
  const auto cosines = table.cosines(worded.variants.front().caption_query);
  for (const int32_t caption : table.nearest(cosines, kCoverageCaptions)) {
    question.captions.push_back(table.text(caption));
  }
  question.in_captions = [&](const std::string& word) {
    const std::string quoted = db::quote_caption_words(word);
    const size_t count = std::min(ranked.size(), kCoverageClips);
    return !quoted.empty() &&
           std::any_of(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const RankedClip& clip) {
                         return database.clip_has_words(clip.clip_id, quoted);
                       });
  };
  return covered_words(*words->encoder, question);
}

SearchAnswer MotionSearch::Impl::search_words(const SearchQuery& query,
                                              const Sentence& sentence) const {
  if (!words) {
    throw Error("opened without a text encoder: search by motion, or open with a text file");
  }
  if (query.by == SearchBy::all && !words->score) {
    throw Error(
        "the text file holds no score for its encoder; fit one: remomask evaluate search "
        "--prompts FILE --fit, or search by captions, words or motion");
  }
  const std::scoped_lock lock(mutex);
  const db::ReadSnapshot snapshot(database);
  refresh();
  const SearchScene scene = word_scene(query, sentence);
  const WordedQuery worded = worded_query(query, sentence);
  const WordScore score = words->score.value_or(WordScore());
  const std::vector<RankedClip> ranked = rank_clips(scene, worded.variants, score, query.by);
  SearchAnswer answer = collect_ranked(scene, query, ranked);
  answer.unsearched = std::max(answer.unsearched, scene.caption_table->incomplete_clips());
  answer.words = coverage(worded, scene, ranked);
  answer.corrected = worded.sentence.corrected;
  if (!answer.corrected.empty()) answer.sentence = worded.sentence.text;
  return answer;
}

}  // namespace remomask::search
