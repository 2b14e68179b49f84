#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "remomask/error.h"
#include "search/compounds.h"
#include "search/coverage.h"
#include "search/hit_list.h"
#include "search/language.h"
#include "search/motion_search_impl.h"
#include "search/query.h"
#include "search/subject.h"
#include "text/caption.h"
#include "text/caption_mirror.h"

namespace remomask::search {

namespace {

constexpr size_t kCoverageCaptions = 24;  // nearest captions whose words are compared
constexpr size_t kCoverageClips = 24;     // best clips in whose captions a word may stand

/// The text of a clip's tags for the search by words.
std::string tag_text(const std::vector<std::string>& tags) {
  return fmt::format("{}", fmt::join(tags, ", "));
}

/// The captions of these clips that are nearest to the sentence, each once.
std::vector<std::string> nearest_captions(const std::vector<RankedClip>& ranked, size_t count) {
  std::map<std::string, double> cosines;
  for (const RankedClip& clip : ranked) {
    if (clip.parts.best && !clip.as_mirrored) cosines[clip.parts.caption] = *clip.parts.best;
  }
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [caption, cosine] : cosines) order.emplace_back(-cosine, caption);
  std::sort(order.begin(), order.end());
  std::vector<std::string> captions;
  for (size_t i = 0; i < std::min(count, order.size()); ++i) captions.push_back(order[i].second);
  return captions;
}

}  // namespace

SearchScene MotionSearch::Impl::word_scene(const SearchQuery& query,
                                           const Sentence& sentence) const {
  SearchScene scene;
  const std::string& hash = words->encoder->hash();
  if (!state->caption_table) {
    const auto captions_of = [&](size_t place) { return state->captions_of(place); };
    state->caption_table = std::make_shared<CaptionTable>(state->clips.size(), captions_of,
                                                          database.caption_vectors(hash));
    if (state->caption_table->incomplete_clips() > 0 && state->caption_table->size() == 0) {
      state->caption_table.reset();
      throw Error(database.path() +
                  ": its captions have no vectors of this text encoder; run: remomask index " +
                  database.path());
    }
    const auto texts_of = [&](size_t place) {
      std::vector<std::string> texts = state->captions_of(place);
      const std::vector<std::string>& tags = state->clips[place].tags;
      if (!tags.empty()) texts.push_back(tag_text(tags));
      return texts;
    };
    state->word_index = std::make_shared<WordIndex>(state->clips.size(), texts_of);
  }
  scene.state = state;
  scene.caption_table = state->caption_table;
  scene.word_index = state->word_index;
  scene.allowed = allowed_clips(query, sentence);
  return scene;
}

SpelledSentence MotionSearch::Impl::spelled(const std::string& sentence, const WordIndex& index,
                                            std::string& language) const {
  const auto is_word = [&](const std::string& word) {
    return words->encoder->is_word(word) || index.has_word(word);
  };
  const std::string usual = usual_spelling(sentence, index.stems());
  SpelledSentence spelled = correct_spelling(usual, is_word, index.vocabulary());
  const KnownWords known{[&](const std::string& word) { return index.has_word(word); }, is_word};
  // Words of other languages look like typing errors, and typing errors like other languages.
  language = foreign_language(sentence, known);
  if (language == kAnotherLanguage) language = foreign_language(spelled.text, known);
  if (!language.empty()) return {usual, {}};
  return spelled;
}

WordedQuery MotionSearch::Impl::worded_query(const SearchQuery& query, const Sentence& sentence,
                                             const WordIndex& index) const {
  WordedQuery worded;
  worded.sentence = spelled(sentence.text, index, worded.language);
  const std::string text = text::normalise_prompt(worded.sentence.text);
  if (index.stems().read(text).empty()) throw no_word(sentence.text);
  worded.variants.emplace_back().text = text;
  const std::string mirrored = text::mirror_caption(text);
  if (mirrored != text && query.mirror) {
    worded.variants.emplace_back().text = mirrored;
    worded.variants.back().mirrored = true;
  }
  std::vector<std::string> texts;
  for (const WordVariant& variant : worded.variants) texts.push_back(generic_subject(variant.text));
  auto vectors = words->encoder->embed(texts);
  for (size_t i = 0; i < texts.size(); ++i) {
    WordVariant& variant = worded.variants[i];
    variant.caption_query = std::move(vectors[i]);
    if (query.by == SearchBy::all) variant.motion_query = text_vector(variant.text);
    variant.terms = index.terms(variant.text);
  }
  return worded;
}

std::vector<QueryWord> MotionSearch::Impl::coverage(const WordedQuery& worded,
                                                    const SearchScene& scene,
                                                    const std::vector<RankedClip>& ranked) const {
  CoverageQuestion question;
  question.sentence = worded.sentence.text;
  question.nearest_captions = [&]() -> std::vector<std::string> {
    // The states of words that the encoder has not learnt say nothing.
    if (!worded.language.empty()) return {};
    return nearest_captions(ranked, kCoverageCaptions);
  };
  question.in_captions = [&](const std::string& word) {
    const std::vector<QueryTerm> terms = scene.word_index->terms(word);
    const size_t count = std::min(ranked.size(), kCoverageClips);
    return !terms.empty() &&
           std::any_of(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const RankedClip& clip) {
                         return scene.word_index->clip_has(clip.place, terms);
                       });
  };
  return covered_words(*words->encoder, question);
}

SearchScene MotionSearch::Impl::locked_word_scene(const SearchQuery& query,
                                                  const Sentence& sentence) const {
  const std::scoped_lock lock(mutex);
  const db::ReadSnapshot snapshot(database);
  refresh();
  return word_scene(query, sentence);
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
  const SearchScene scene = locked_word_scene(query, sentence);
  const WordedQuery worded = worded_query(query, sentence, *scene.word_index);
  const WordScore score = words->score.value_or(WordScore());
  std::vector<RankedClip> ranked;
  SearchAnswer answer;
  // Grouping and limits leave gaps: look further until there are enough hits or no more clips.
  for (auto count = static_cast<size_t>(query.k);; count *= 8) {
    ranked = rank_clips(scene, worded.variants, score, query.by, count);
    answer = collect_ranked(scene, query, ranked);
    if (answer.hits.size() == static_cast<size_t>(query.k) || count >= scene.state->clips.size() ||
        (answer.refused && query.min_probability)) {
      break;
    }
  }
  answer.unsearched = std::max(answer.unsearched, scene.caption_table->incomplete_clips());
  answer.words = coverage(worded, scene, ranked);
  answer.language = worded.language;
  answer.corrected = worded.sentence.corrected;
  if (!answer.corrected.empty()) answer.sentence = worded.sentence.text;
  return answer;
}

}  // namespace remomask::search
