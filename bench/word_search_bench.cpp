// A whole MotionSearch::search() by sentence among 100,000 clips with three captions each, on one
// thread: from the words to ten hits with what they say of each word. The clips are made in a
// temporary folder (0.9 GB, a minute): their captions are those of the shipped database with other
// words in some places, their vectors those of the shipped captions and motions with noise.
// REMOMASK_CLIPS chooses another number of clips, REMOMASK_GALLERY a file to keep them in, which
// the next run takes as it is. Read the lines _p50 and _p95.
//
// Floor: the matrix products of the sentence encoder for twelve word pieces at the GEMM peak, and
// reading one byte for each number of the caption vectors once.

#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "base/random.h"
#include "bench/file_named.h"
#include "bench/machine_peak.h"
#include "bench/unit_vectors.h"
#include "db/captions_index.h"
#include "db/transaction.h"
#include "index/vector_index.h"
#include "nn/model_file.h"
#include "nn/threads.h"
#include "search/motion_search.h"

namespace remomask {
namespace {

constexpr int kQueries = 120;
constexpr float kNoise = 0.6f;  // beside a vector of length 1
constexpr double kEncoderProducts = 2.0 * 6 * (4 * 384 * 384 + 2 * 384 * 1536);  // a word piece
constexpr double kPiecesOfQuery = 12;

const std::vector<std::string>& asked() {
  static const std::vector<std::string> sentences = {
      "a person walks forward",
      "someone waves with the right hand",
      "kicks with the left leg",
      "a man sits down on a chair and stands up again",
      "running in a circle",
      "jumping jacks",
      "the girl bows politely",
      "throws a punch",
      "walks slowly like an old man",
      "turns around to the left",
      "raises both arms above the head",
      "sneaks on tiptoe"};
  return sentences;
}

/// Words that stand in for others: twice as many captions differ, of like meaning.
std::string vary(const std::string& caption, CounterRandom& random) {
  static const std::vector<std::string> additions = {
      "slowly",  "quickly", "calmly",  "with care", "once",      "twice",   "again",     "in place",
      "briefly", "happily", "angrily", "at ease",   "in a hall", "outside", "carefully", "softly"};
  std::string varied = caption;
  varied.erase(varied.find_last_not_of(" .") + 1);
  for (int i = 0; i < 3; ++i) {
    varied += (i == 0 ? " " : " and ") + additions[random.below(additions.size())];
  }
  return varied;
}

std::vector<float> noisy(const std::vector<float>& vector, uint64_t seed) {
  const auto width = static_cast<int>(vector.size());
  std::vector<float> result = random_unit_vectors(1, width, seed);
  for (size_t i = 0; i < result.size(); ++i) result[i] = vector[i] + kNoise * result[i];
  normalise_row(result.data(), width);
  return result;
}

class Gallery {
 public:
  Gallery() {
    nn::set_compute_threads(1);
    if (const char* kept = std::getenv("REMOMASK_GALLERY")) {
      path_ = kept;
    } else {
      std::string name =
          (std::filesystem::temp_directory_path() / "remomask_bench_XXXXXX").string();
      if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make a temporary folder");
      folder_ = name;
      path_ = folder_ / "motions.sqlite";
    }
    if (!std::filesystem::exists(path_)) fill();
    caption_count_ = db::Database(path_, db::OpenMode::read_only)
                         .caption_vectors(words_->encoder->hash())
                         .size();
    search_ = std::make_unique<search::MotionSearch>(retriever_, words_, path_);
    for (const std::string& sentence : asked()) find(sentence);  // warm
  }
  ~Gallery() {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  Gallery(const Gallery&) = delete;
  Gallery& operator=(const Gallery&) = delete;

  SearchAnswer find(const std::string& sentence) const {
    SearchQuery query;
    query.text = sentence;
    return search_->search(query);
  }
  const search::WordModel& words() const { return *words_; }
  const std::string& path() const { return path_; }
  double caption_numbers() const {
    return static_cast<double>(caption_count_) * static_cast<double>(words_->encoder->width());
  }

 private:
  void fill() {
    const char* chosen = std::getenv("REMOMASK_CLIPS");
    const size_t count = chosen ? std::stoul(chosen) : 100000;
    const db::Database shipped(file_named("REMOMASK_DATABASE", "motions.sqlite"),
                               db::OpenMode::read_only);
    const std::vector<db::Clip> clips = shipped.clips();
    std::map<int64_t, std::vector<float>> motions;
    for (db::ClipEmbedding& one : shipped.embeddings(retriever_->hash())) {
      motions[one.clip_id] = std::move(one.motion);
    }
    std::map<std::string, std::vector<float>> captions;
    for (db::CaptionVector& one : shipped.caption_vectors(words_->encoder->hash())) {
      captions[one.text] = std::move(one.vector);
    }
    db::Database database(path_, db::OpenMode::create);
    db::Transaction transaction(database);
    std::vector<db::ClipEmbedding> embeddings;
    std::map<std::string, std::vector<float>> vectors;
    for (size_t i = 0; i < count; ++i) {
      const db::Clip& model = clips[i % clips.size()];
      CounterRandom random(i);
      db::Clip clip = model;
      clip.name = "clip" + std::to_string(i);
      clip.group = clip.name;
      clip.content_hash.clear();  // of the motion below
      clip.captions.clear();
      for (size_t c = 0; c < 3 && !model.captions.empty(); ++c) {
        const std::string& caption = model.captions[c % model.captions.size()];
        clip.captions.push_back(vary(caption, random));
        vectors[clip.captions.back()] = noisy(captions.at(caption), 3 * i + c);
      }
      Motion motion(4, humanml_skeleton().joints());
      motion.positions[0] = static_cast<float>(i) * 1e-3f;
      embeddings.push_back(
          {database.add_clip(clip, motion), noisy(motions.at(model.id), i), {}, {}});
    }
    database.add_embeddings(retriever_->hash(), embeddings);
    std::vector<db::CaptionVector> rows;
    for (const auto& [text, vector] : vectors) rows.push_back({text, vector});
    database.add_caption_vectors(words_->encoder->hash(), rows);
    transaction.commit();
    index::VectorIndex::build(database, retriever_->hash()).save(index::default_index_path(path_));
  }

  std::shared_ptr<const search::WordModel> words_ = std::make_shared<const search::WordModel>(
      search::WordModel::open(file_named("REMOMASK_TEXT", "text.safetensors")));
  std::shared_ptr<const retriever::Retriever> retriever_ =
      std::make_shared<const retriever::Retriever>(retriever::open_retriever(
          file_named("REMOMASK_MODEL", "base.safetensors"), words_->encoder));
  std::filesystem::path folder_;
  std::string path_;
  std::unique_ptr<search::MotionSearch> search_;
  size_t caption_count_ = 0;
};

const Gallery& gallery() {
  static const Gallery made;
  return made;
}

void sentence_to_hits(benchmark::State& state) {
  static size_t next = 0;
  const Gallery& all = gallery();
  for (auto _ : state) {
    benchmark::DoNotOptimize(all.find(asked()[next++ % asked().size()]));
  }
  report_floor(state, kEncoderProducts * kPiecesOfQuery / gemm_rate() +
                          all.caption_numbers() / memory_read_rate());
}

/// Of it, what the sentence encoder takes.
void sentence_to_vector(benchmark::State& state) {
  static size_t next = 0;
  const Gallery& all = gallery();
  for (auto _ : state) {
    benchmark::DoNotOptimize(all.words().encoder->embed({asked()[next++ % asked().size()]}));
  }
  report_floor(state, kEncoderProducts * kPiecesOfQuery / gemm_rate());
}

/// What SQLite's own BM25 takes for the words of one sentence: why the search holds them in memory.
void full_text_index(benchmark::State& state) {
  const db::Database database(gallery().path(), db::OpenMode::read_only);
  for (auto _ : state) {
    benchmark::DoNotOptimize(database.match_captions("\"walks\" OR \"forward\""));
  }
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

void with_quantiles(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(1)
      ->Repetitions(kQueries)
      ->ReportAggregatesOnly(true)
      ->ComputeStatistics("p50", [](const auto& values) { return quantile(values, 0.50); })
      ->ComputeStatistics("p95", [](const auto& values) { return quantile(values, 0.95); });
}

BENCHMARK(sentence_to_hits)->Apply(with_quantiles);
BENCHMARK(sentence_to_vector)->Apply(with_quantiles);
BENCHMARK(full_text_index)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(3);

}  // namespace
}  // namespace remomask
