#include "search/motion_search.h"

#include <ATen/ops/from_blob.h>
#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <sstream>
#include <unordered_map>

#include "base/json.h"
#include "base/time.h"
#include "db/captions_index.h"
#include "db/clip_filter.h"
#include "index/vector_index.h"
#include "motion/features.h"
#include "nn/model_file.h"
#include "nn/tensor_values.h"
#include "remomask/error.h"
#include "retriever/retriever.h"
#include "search/calibration.h"
#include "search/coverage.h"
#include "search/hit_list.h"
#include "search/moments.h"
#include "search/motion_search_impl.h"
#include "search/query.h"
#include "search/sentence.h"
#include "text/caption.h"

namespace remomask::search {

namespace {

constexpr int kMinQueryFrames = kFramesPerToken;  // as clips that are embedded
constexpr int64_t kCaptionClips = 50;             // whose captions are compared one by one
constexpr size_t kMomentHits = 50;                // whose windows are embedded

}  // namespace

MotionSearch::Impl::Impl(std::shared_ptr<const retriever::Retriever> shared,
                         std::shared_ptr<const WordModel> word_model,
                         const std::string& database_file, const std::string& index_file)
    : index_path(index_file.empty() ? index::default_index_path(database_file) : index_file),
      retriever(std::move(shared)),
      words(std::move(word_model)),
      database(database_file, db::OpenMode::read_only) {
  const db::ReadSnapshot snapshot(database);
  read_state();
}

void MotionSearch::Impl::read_state() const {
  state = std::make_shared<SearchState>(
      index::VectorIndex::open(index_path, database, retriever->hash()), database.clips(),
      database.guessed_captions());
}

void MotionSearch::Impl::refresh() const {
  // A new one: other searches may still be reading the old one.
  if (state->index.stamp().generation != database.generation()) read_state();
}

std::optional<std::vector<int64_t>> MotionSearch::Impl::allowed_clips(
    const SearchQuery& query, const Sentence& sentence) const {
  ClipFilter filter = query.filter;
  for (const std::string& word : sentence.unwanted) {
    const std::string quoted = db::quote_caption_words(word);
    if (quoted.empty()) throw no_word(word);
    const std::vector<int64_t> with = database.clips_with_words(quoted);
    filter.excluded_clips.insert(with.begin(), with.end());
  }
  if (!query.like_clip.empty()) {
    const db::Clip clip = database.clip(stored_clip(query.like_clip));
    filter.excluded_clips.insert(clip.id);
    if (query.grouped) filter.excluded_groups.insert(clip.group);
  }
  // Ranks need all clips in their exact order: no approximate index for boosts.
  if (filter.empty() && query.boost_words.empty()) return std::nullopt;
  return db::matching_clips(database, state->clips, filter);
}

/// The clips with any of the words, best first.
std::vector<int64_t> MotionSearch::Impl::boosted_clips(const std::string& boost_words) const {
  std::vector<int64_t> ids;
  if (boost_words.empty()) return ids;
  std::istringstream stream(boost_words);
  std::string any;
  for (std::string word; stream >> word;) {
    const std::string quoted = db::quote_caption_words(word);
    if (!quoted.empty()) any += (any.empty() ? "" : " OR ") + quoted;
  }
  if (any.empty()) throw no_word(boost_words);
  for (const db::CaptionMatch& match : database.match_captions(any)) ids.push_back(match.clip_id);
  return ids;
}

int64_t MotionSearch::Impl::stored_clip(const std::string& name) const {
  if (const auto id = database.find_name(name)) return *id;
  throw Error(database.path() + ": there is no clip '" + name + "'");
}

SearchScene MotionSearch::Impl::scene(const SearchQuery& query, const Sentence& sentence,
                                      VectorsNeeded need) const {
  const std::scoped_lock lock(mutex);
  const db::ReadSnapshot snapshot(database);
  MotionSearch::Impl::refresh();
  SearchScene scene;
  if (need == VectorsNeeded::bodies && !state->bodies) {
    state->bodies = std::make_shared<index::VectorTable>(
        index::VectorTable::of_bodies(database.embeddings(retriever->hash())));
  }
  if (need == VectorsNeeded::captions && !state->captions) {
    state->captions = std::make_shared<index::VectorTable>(
        index::VectorTable::of_captions(database.embeddings(retriever->hash())));
  }
  scene.state = state;
  scene.bodies = state->bodies;
  scene.captions = state->captions;
  scene.allowed = allowed_clips(query, sentence);
  scene.boosted = boosted_clips(query.boost_words);
  if (!query.motion && query.like_clip.empty()) scene.calibration = calibration();
  if (query.min_probability && !scene.calibration) {
    throw Error(database.path() +
                ": has no calibration of this retriever, so that nothing is known of "
                "probabilities; run: remomask evaluate calibration --db DB --store");
  }
  if (!query.like_clip.empty()) {
    scene.like = database.embedding(retriever->hash(), stored_clip(query.like_clip));
    if (!scene.like) {
      throw Error(database.path() + ": clip '" + query.like_clip +
                  "' has no vectors of this retriever; run: remomask index DB");
    }
  }
  return scene;
}

std::optional<Calibration> MotionSearch::Impl::calibration() const {
  const auto text = database.fact(calibration_fact(retriever->hash()));
  if (!text) return std::nullopt;
  return parse_calibration(try_parse_json(*text));
}

/// [E] of one caption.
std::vector<float> MotionSearch::Impl::text_vector(const std::string& text) const {
  return nn::float_vector(retriever->encode_text({text::normalise_prompt(text)}).query[0]);
}

db::ClipEmbedding MotionSearch::Impl::motion_vectors(const Motion& motion) const {
  const double fps = humanml_skeleton().fps;
  if (motion.frames < kMinQueryFrames || motion.frames > kMaxStoredFrames) {
    throw Error(fmt::format(
        "the motion to compare with is {:.2f} s long; it must be {:.1f} to {:.0f} s: choose a "
        "piece of it (--from, --to)",
        motion.frames / fps, kMinQueryFrames / fps, kMaxStoredFrames / fps));
  }
  const motion::Features features =
      motion::extract_features_all_frames(motion, humanml_skeleton(), retriever->feature_mode());
  const retriever::MotionEncoding encoding = retriever->encode_motion({&features});
  return {0, nn::float_vector(encoding.global[0]), nn::float_vector(encoding.parts[0]), {}};
}

std::vector<FoundClip> MotionSearch::Impl::with_vectors(std::vector<MotionHit> hits) const {
  std::vector<FoundClip> result;
  for (MotionHit& hit : hits) {
    // A clip that was removed meanwhile, or not embedded yet, has none.
    auto vectors = database.embedding(retriever->hash(), hit.clip.id);
    if (!vectors) continue;
    result.push_back({std::move(hit), std::move(vectors->motion), std::move(vectors->text)});
  }
  return result;
}

/// The motion of a hit; nothing when the clip was removed meanwhile.
std::optional<Motion> MotionSearch::Impl::hit_motion(const ClipInfo& clip) const {
  const std::scoped_lock lock(mutex);
  const db::ReadSnapshot snapshot(database);
  if (database.find_name(clip.name) != clip.id) return std::nullopt;
  return database.motion(clip.id);
}

void MotionSearch::Impl::find_moments(const index::LinearQuery& query,
                                      std::vector<MotionHit>& hits) const {
  std::vector<float> values = query.global;
  const at::Tensor vector = at::from_blob(values.data(), {static_cast<int64_t>(values.size())});
  for (size_t i = 0; i < std::min(hits.size(), kMomentHits); ++i) {
    const auto motion = hit_motion(hits[i].clip);
    if (!motion) continue;
    const Skeleton& skeleton = skeleton_named(hits[i].clip.skeleton);
    const motion::Features features =
        motion::extract_features_all_frames(*motion, skeleton, retriever->feature_mode());
    const auto windows = moment_windows(features.frames);
    const auto found = best_moments(vector, windows, encode_moments(*retriever, features, windows));
    if (found.empty()) continue;
    const Moment& best = found.front();
    hits[i].moment = {best.window.first / skeleton.fps, best.window.last / skeleton.fps,
                      best.similarity};
  }
}

QueryVectors MotionSearch::Impl::vectors(const SearchQuery& query, const Sentence& sentence,
                                         const SearchScene& scene) const {
  QueryVectors result;
  if (!sentence.text.empty()) result.text = text_vector(sentence.text);
  if (query.motion || scene.like) {
    db::ClipEmbedding motion = scene.like ? *scene.like : motion_vectors(*query.motion);
    result.motion = std::move(motion.motion);
    result.motion_parts = std::move(motion.parts);
  }
  return result;
}
MotionSearch::MotionSearch(std::shared_ptr<const retriever::Retriever> retriever,
                           std::shared_ptr<const WordModel> words, const std::string& database_path,
                           const std::string& index_path)
    : impl_(std::make_unique<Impl>(std::move(retriever), std::move(words), database_path,
                                   index_path)) {}
MotionSearch::~MotionSearch() = default;
MotionSearch::MotionSearch(MotionSearch&&) noexcept = default;
MotionSearch& MotionSearch::operator=(MotionSearch&&) noexcept = default;

SearchAnswer MotionSearch::search(const SearchQuery& query) const {
  check_query(query);
  if (asks_by_words(query)) {
    SearchAnswer answer = impl_->search_words(query, parse_sentence(query.text));
    const Sentence asked = parse_sentence(answer.sentence.empty() ? query.text : answer.sentence);
    if (query.moments) impl_->find_moments({impl_->text_vector(asked.text), {}}, answer.hits);
    return answer;
  }
  const VectorsNeeded need = query.parts.empty() ? VectorsNeeded::index : VectorsNeeded::bodies;
  const Sentence sentence = parse_sentence(query.text);
  const SearchScene scene = impl_->scene(query, sentence, need);
  const index::LinearQuery vectors = linear_query(impl_->vectors(query, sentence, scene), query);
  SearchAnswer answer = collect_hits(scene, query, vectors);
  if (query.moments) impl_->find_moments(vectors, answer.hits);
  return answer;
}

std::vector<CaptionHit> MotionSearch::captions_for(const SearchQuery& query) const {
  check_query(query);
  if (!query.text.empty() || !query.parts.empty() || !query.boost_words.empty()) {
    throw Error("captions are looked up for a motion alone; omit sentence, words and parts");
  }
  const SearchScene scene = impl_->scene(query, {}, VectorsNeeded::captions);
  const std::vector<float> motion = impl_->vectors(query, {}, scene).motion;
  const auto near = scene.captions->nearest({motion, {}}, kCaptionClips, scene.limit());
  std::vector<CaptionHit> hits;
  std::unordered_map<std::string, size_t> places;
  for (const index::VectorHit& found : near) {
    const db::Clip& clip = scene.state->clip(found.clip_id);
    for (const std::string& caption : clip.captions) {
      const std::string normal = text::normalise_caption(caption);
      if (normal.empty()) continue;
      const auto [place, is_new] = places.emplace(normal, hits.size());
      if (is_new) {
        const std::vector<float> text = impl_->text_vector(normal);
        CaptionHit hit;
        hit.caption = caption;
        hit.similarity = static_cast<float>(dot_product(text, motion));
        hits.push_back(std::move(hit));
      }
      std::vector<std::string>& names = hits[place->second].clips;
      if (names.empty() || names.back() != clip.name) names.push_back(clip.name);
    }
  }
  std::stable_sort(hits.begin(), hits.end(), [](const CaptionHit& left, const CaptionHit& right) {
    return left.similarity > right.similarity;
  });
  if (hits.size() > static_cast<size_t>(query.k)) hits.resize(static_cast<size_t>(query.k));
  for (size_t i = 0; i < hits.size(); ++i) hits[i].rank = static_cast<int>(i) + 1;
  return hits;
}

std::vector<FoundClip> MotionSearch::nearest(const std::vector<float>& query, int k,
                                             const ClipFilter& filter) const {
  const std::scoped_lock lock(impl_->mutex);
  const db::ReadSnapshot snapshot(impl_->database);
  impl_->refresh();
  SearchScene scene;
  scene.state = impl_->state;
  if (!filter.empty())
    scene.allowed = db::matching_clips(impl_->database, scene.state->clips, filter);
  SearchQuery hits;
  hits.k = k;
  return impl_->with_vectors(collect_hits(scene, hits, {query, {}}).hits);
}

FoundClips MotionSearch::find(const std::string& sentence, int k, const ClipFilter& filter) const {
  SearchQuery query;
  query.text = sentence;
  query.k = k;
  query.filter = filter;
  // A minus in a prompt excludes nothing: it is read by the generator, too.
  SearchAnswer answer = impl_->search_words(query, {sentence, {}});
  const std::scoped_lock lock(impl_->mutex);
  const db::ReadSnapshot snapshot(impl_->database);
  return {impl_->with_vectors(std::move(answer.hits)), std::move(answer.words)};
}

Motion MotionSearch::motion(int64_t clip_id) const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->database.motion(clip_id);
}

}  // namespace remomask::search
