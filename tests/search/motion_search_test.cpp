// With the shipped retriever and random vectors, where the right answer is a sum over all clips;
// and with the shipped database.
#include "search/motion_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <thread>

#include "motion/body_parts.h"
#include "motion/features.h"
#include "nn/tensor_values.h"
#include "retriever/retriever.h"
#include "search/calibration.h"
#include "search/moments.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

const std::string kModels = REMOMASK_SOURCE_DIR "/models/";
const std::string kModel = kModels + "base.safetensors";

// Search by words is in word_search_test.cpp.
struct MotionQuery : SearchQuery {
  MotionQuery() { by = SearchBy::motion; }
};
double dot(std::span<const float> left, std::span<const float> right) {
  return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

class MotionSearchTest : public ::testing::Test {
 protected:
  static constexpr int kClips = 90;

  static void SetUpTestSuite() {
    folder_ = new TestFolder;
    retriever_ = new std::shared_ptr<const retriever::Retriever>(
        std::make_shared<const retriever::Retriever>(retriever::open_retriever(kModel)));
    const std::string path = *folder_ / "motions.sqlite";
    {
      db::Database database(path, db::OpenMode::create);
      for (int i = 0; i < kClips; ++i) {
        db::Clip clip = named_clip("clip" + std::to_string(i));
        clip.group = "test/group" + std::to_string(i % 30);  // three clips each
        clip.split = i % 2 == 0 ? "train" : "val";
        clip.labels["side"] = i % 3 == 0 ? "left" : "right";
        clip.captions = {"a person does number " + std::to_string(i) + ".",
                         i % 5 == 0 ? "someone waves both hands." : "shared words."};
        add_test_clip(database, clip, 20 + i);
      }
      store_random_vectors(database, 5);
      index::VectorIndex::build(database, (*retriever_)->hash()).save(path + ".index");
    }
    database_ = new db::Database(path, db::OpenMode::read_only);
    search_ = new search::MotionSearch(*retriever_, nullptr, path);
  }
  static void TearDownTestSuite() {
    delete search_;
    delete database_;
    delete retriever_;
    delete folder_;
  }

  static void store_random_vectors(db::Database& database, uint64_t seed) {
    const auto width = static_cast<size_t>((*retriever_)->embedding_width());
    const auto part_width = static_cast<size_t>((*retriever_)->part_width());
    std::vector<db::ClipEmbedding> embeddings;
    for (const db::Clip& clip : database.clips()) {
      const uint64_t own = seed * 1000 + static_cast<uint64_t>(clip.id);
      db::ClipEmbedding embedding;
      embedding.clip_id = clip.id;
      embedding.motion = random_directions(1, static_cast<int>(width), own);
      embedding.parts =
          random_directions(motion::kBodyParts, static_cast<int>(part_width), own + 1);
      embedding.text = random_directions(1, static_cast<int>(width), own + 2);
      embeddings.push_back(std::move(embedding));
    }
    database.store_embeddings((*retriever_)->hash(), embeddings);
  }

  static db::ClipEmbedding vectors_of(const std::string& name) {
    return *database_->embedding((*retriever_)->hash(), *database_->find_name(name));
  }
  static std::vector<float> encode(const std::string& text) {
    return nn::float_vector((*retriever_)->encode_text({text}).query[0]);
  }

  using Similarity = std::function<double(const db::ClipEmbedding&)>;
  using Passes = std::function<bool(const db::Clip&)>;

  /// The answer by definition: every clip scored, sorted, filtered, grouped.
  static std::vector<std::pair<std::string, double>> by_definition(const Similarity& similarity,
                                                                   const SearchQuery& query,
                                                                   const Passes& passes) {
    std::vector<std::pair<double, int64_t>> scored;
    for (const db::ClipEmbedding& clip : database_->embeddings((*retriever_)->hash())) {
      scored.emplace_back(-similarity(clip), clip.clip_id);
    }
    std::sort(scored.begin(), scored.end());
    std::vector<std::pair<std::string, double>> result;
    std::set<std::string> groups;
    for (const auto& [score, id] : scored) {
      const db::Clip clip = database_->clip(id);
      if (!passes(clip)) continue;
      if (query.grouped && !groups.insert(clip.group).second) continue;
      if (static_cast<int>(result.size()) < query.k) result.emplace_back(clip.name, -score);
    }
    return result;
  }

  static void expect_exact(const SearchQuery& query, const Similarity& similarity,
                           const Passes& passes) {
    const auto expected = by_definition(similarity, query, passes);
    const SearchAnswer answer = search_->search(query);
    ASSERT_EQ(answer.hits.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(answer.hits[i].clip.name, expected[i].first) << i;
      EXPECT_NEAR(answer.hits[i].similarity, expected[i].second, 1e-6);
      EXPECT_EQ(answer.hits[i].rank, static_cast<int>(i) + 1);
    }
  }

  /// Without and with filter, grouped and not, few and many.
  static void expect_exact_however_filtered(SearchQuery query, const Similarity& similarity) {
    std::string like_group = "none";
    if (!query.like_clip.empty()) {
      like_group = database_->clip(*database_->find_name(query.like_clip)).group;
    }
    const auto other = [&](const db::Clip& clip) {
      return clip.name != query.like_clip && (!query.grouped || clip.group != like_group);
    };
    for (const bool grouped : {true, false}) {
      for (const int k : {3, 25, 200}) {
        query.grouped = grouped;
        query.k = k;
        query.filter = {};
        expect_exact(query, similarity, other);
        query.filter.splits = {"val"};
        query.filter.labels = {{"side", "right"}};
        query.filter.min_seconds = 2;
        expect_exact(query, similarity, [&](const db::Clip& clip) {
          return other(clip) && clip.split == "val" && clip.labels["side"] == "right" &&
                 clip.frames >= 40;
        });
      }
    }
  }

  static TestFolder* folder_;
  static std::shared_ptr<const retriever::Retriever>* retriever_;
  static db::Database* database_;
  static search::MotionSearch* search_;
};

TestFolder* MotionSearchTest::folder_ = nullptr;
std::shared_ptr<const retriever::Retriever>* MotionSearchTest::retriever_ = nullptr;
db::Database* MotionSearchTest::database_ = nullptr;
search::MotionSearch* MotionSearchTest::search_ = nullptr;

TEST_F(MotionSearchTest, FindsBySentence) {
  MotionQuery query;
  query.text = "a person walks";
  const auto text = encode(query.text);
  expect_exact_however_filtered(
      query, [&](const db::ClipEmbedding& clip) { return dot(text, clip.motion); });
}

TEST_F(MotionSearchTest, FindsByMotion) {
  MotionQuery query;
  query.like_clip = "clip7";
  const auto like = vectors_of("clip7");
  expect_exact_however_filtered(
      query, [&](const db::ClipEmbedding& clip) { return dot(like.motion, clip.motion); });
}

TEST_F(MotionSearchTest, FindsByBodyParts) {
  MotionQuery query;
  query.like_clip = "clip7";
  query.parts = {"arms", "left_leg"};
  const auto like = vectors_of("clip7");
  const auto width = static_cast<size_t>((*retriever_)->part_width());
  const auto parts = [&](const db::ClipEmbedding& clip) {
    double sum = 0;
    for (const size_t part : {0u, 4u, 5u}) {
      sum += dot(std::span(like.parts).subspan(part * width, width),
                 std::span(clip.parts).subspan(part * width, width));
    }
    return sum / 3;
  };
  expect_exact_however_filtered(query, parts);
  query.text = "a person waves";
  query.text_weight = 3;
  const auto text = encode(query.text);
  expect_exact_however_filtered(query, [&](const db::ClipEmbedding& clip) {
    return 0.75 * dot(text, clip.motion) + 0.25 * parts(clip);
  });
}

TEST_F(MotionSearchTest, FindsBySentenceAndMotion) {
  MotionQuery query;
  query.text = "a person waves";
  query.like_clip = "clip20";
  query.text_weight = 0.5;
  query.motion_weight = 1.5;
  const auto text = encode(query.text);
  const auto like = vectors_of("clip20");
  expect_exact_however_filtered(query, [&](const db::ClipEmbedding& clip) {
    return 0.25 * dot(text, clip.motion) + 0.75 * dot(like.motion, clip.motion);
  });
}

TEST_F(MotionSearchTest, CountsWhatItFolded) {
  MotionQuery query;
  query.text = "a person walks";
  SearchAnswer answer = search_->search(query);
  EXPECT_EQ(answer.candidates, kClips);
  for (const MotionHit& hit : answer.hits) EXPECT_EQ(hit.folded, 2);
  query.filter.splits = {"val"};  // i, i + 30, i + 60 are in one split
  query.filter.min_seconds = 4;   // 60 of them at least 80 frames long
  answer = search_->search(query);
  ASSERT_FALSE(answer.hits.empty());
  for (const MotionHit& hit : answer.hits) {
    int expected = -1;
    for (const db::Clip& clip : database_->clips()) {
      expected += clip.group == hit.clip.group && clip.frames >= 80;
    }
    EXPECT_EQ(hit.folded, expected) << hit.clip.name;
  }
  query.grouped = false;
  for (const MotionHit& hit : search_->search(query).hits) EXPECT_EQ(hit.folded, 0);
}

TEST_F(MotionSearchTest, LimitsRefuseAndSayWhat) {
  MotionQuery query;
  query.text = "a person walks";
  query.k = 30;
  const SearchAnswer all = search_->search(query);
  ASSERT_EQ(all.hits.size(), 30u);
  query.min_similarity = all.hits[4].similarity;  // the limit itself passes
  SearchAnswer some = search_->search(query);
  ASSERT_EQ(some.hits.size(), 5u);
  ASSERT_TRUE(some.refused);
  EXPECT_EQ(some.refused->clip.name, all.hits[5].clip.name);
  query.min_similarity = 0.99;
  some = search_->search(query);
  EXPECT_TRUE(some.hits.empty());
  ASSERT_TRUE(some.refused);
  EXPECT_EQ(some.refused->clip.name, all.hits[0].clip.name);
  EXPECT_EQ(some.candidates, kClips);
  query.filter.min_seconds = 100;
  some = search_->search(query);
  EXPECT_EQ(some.candidates, 0);
  EXPECT_FALSE(some.refused);
}

TEST_F(MotionSearchTest, CaptionsAreThoseOfNearClipsByTheirOwnCosine) {
  MotionQuery query;
  query.like_clip = "clip3";
  query.filter.splits = {"train"};  // 45 clips, all are near enough
  query.k = 100;
  const auto motion = vectors_of("clip3").motion;
  std::map<std::string, double> expected;
  std::map<std::string, size_t> owners;
  for (const db::Clip& clip : database_->clips()) {
    if (clip.split != "train" || clip.group == "test/group3") continue;
    for (const std::string& caption : clip.captions) {
      expected[caption] = dot(encode(caption), motion);
      ++owners[caption];
    }
  }
  const auto hits = search_->captions_for(query);
  ASSERT_EQ(hits.size(), expected.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_NEAR(hits[i].similarity, expected.at(hits[i].caption), 1e-4);
    EXPECT_EQ(hits[i].rank, static_cast<int>(i) + 1);
    EXPECT_GE(hits[i > 0 ? i - 1 : 0].similarity, hits[i].similarity);
    EXPECT_EQ(hits[i].clips.size(), owners.at(hits[i].caption));
  }
  query.k = 2;
  EXPECT_EQ(search_->captions_for(query).size(), 2u);
  query.text = "a sentence";
  EXPECT_NE(error_of([&] { search_->captions_for(query); }), "");
}

TEST_F(MotionSearchTest, LeavesUnwantedWordsOutByTheirStem) {
  MotionQuery query;
  query.text = "a person -waving walks -nonsense";
  query.k = 200;
  const auto text = encode("a person walks");
  const auto similarity = [&](const db::ClipEmbedding& clip) { return dot(text, clip.motion); };
  const auto waves = [](const db::Clip& clip) {
    return clip.captions[1] == "someone waves both hands.";
  };
  expect_exact(query, similarity, [&](const db::Clip& clip) { return !waves(clip); });
  query.filter.splits = {"val"};
  query.grouped = false;
  expect_exact(query, similarity,
               [&](const db::Clip& clip) { return !waves(clip) && clip.split == "val"; });
  query.text = "-waving";
  EXPECT_NE(error_of([&] { search_->search(query); }).find("not wanted"), std::string::npos);
  query.like_clip = "clip1";  // and now there is something to look for
  query.filter = {};
  const auto like = vectors_of("clip1");
  expect_exact(
      query, [&](const db::ClipEmbedding& clip) { return dot(like.motion, clip.motion); },
      [&](const db::Clip& clip) { return !waves(clip) && clip.name != "clip1"; });
}

TEST_F(MotionSearchTest, BoostsWordsByReciprocalRanks) {
  MotionQuery query;
  query.text = "a person walks";
  query.boost_words = "hands, & number 7";
  query.k = 20;
  query.grouped = false;
  const auto text = encode(query.text);
  for (const double weight : {0.0, 0.3, 1.0, 5.0}) {
    for (const bool filtered : {false, true}) {
      query.boost_weight = weight;
      query.filter = {};
      if (filtered) query.filter.splits = {"train"};
      SearchQuery plain = query;
      plain.k = kClips;
      const auto by_vector = by_definition(
          [&](const db::ClipEmbedding& clip) { return dot(text, clip.motion); }, plain,
          [&](const db::Clip& clip) { return !filtered || clip.split == "train"; });
      std::map<std::string, double> scores;
      for (size_t i = 0; i < by_vector.size(); ++i) {
        scores[by_vector[i].first] = 1 / (61.0 + static_cast<double>(i));
      }
      double rank = 1;
      for (const auto& match : database_->match_captions("\"hands,\" OR \"number\" OR \"7\"")) {
        const auto found = scores.find(database_->clip(match.clip_id).name);
        if (found != scores.end()) found->second += weight / (60 + rank++);
      }
      auto expected = by_vector;
      std::stable_sort(expected.begin(), expected.end(), [&](const auto& a, const auto& b) {
        return scores.at(a.first) > scores.at(b.first);
      });
      const SearchAnswer answer = search_->search(query);
      ASSERT_EQ(answer.hits.size(), 20u);
      EXPECT_EQ(answer.boosted, filtered ? 45 : 90);
      for (size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(answer.hits[i].clip.name, expected[i].first) << weight << " " << i;
        EXPECT_NEAR(answer.hits[i].similarity, expected[i].second, 1e-6);
      }
    }
  }
  query.boost_words = "& !";
  EXPECT_NE(error_of([&] { search_->search(query); }).find("no word"), std::string::npos);
  query.boost_words = "unheard";
  EXPECT_EQ(search_->search(query).boosted, 0);
  query.boost_weight = -1;
  EXPECT_NE(error_of([&] { search_->search(query); }), "");
}

TEST_F(MotionSearchTest, SeesWhatOthersHaveChanged) {
  const std::string path = *folder_ / "changing.sqlite";
  db::Database database(path, db::OpenMode::create);
  add_test_clip(database, named_clip("old"));
  add_test_clip(database, named_clip("older"));
  store_random_vectors(database, 1);
  index::VectorIndex::build(database, (*retriever_)->hash()).save(path + ".index");
  const search::MotionSearch search(*retriever_, nullptr, path);
  MotionQuery query;
  query.like_clip = "old";
  query.parts = {"arms"};
  EXPECT_EQ(search.search(query).hits.size(), 1u);
  query.parts.clear();
  EXPECT_EQ(search.captions_for(query).size(), 2u);
  add_test_clip(database, named_clip("new"));
  store_random_vectors(database, 2);
  EXPECT_EQ(search.search(query).hits.size(), 2u);
  query.like_clip = "new";
  query.parts = {"arms"};
  EXPECT_EQ(search.search(query).hits.size(), 2u);
  query.like_clip = "nobody";
  EXPECT_NE(error_of([&] { search.search(query); }).find("'nobody'"), std::string::npos);
}

TEST_F(MotionSearchTest, ProbabilitiesAreThoseOfTheStoredCalibration) {
  const std::string path = *folder_ / "calibrated.sqlite";
  db::Database database(path, db::OpenMode::create);
  for (const char* name : {"a", "b", "c", "d", "e"}) add_test_clip(database, named_clip(name));
  store_random_vectors(database, 3);
  index::VectorIndex::build(database, (*retriever_)->hash()).save(path + ".index");
  const search::MotionSearch search(*retriever_, nullptr, path);
  MotionQuery query;
  query.text = "a person walks";
  const SearchAnswer plain = search.search(query);
  ASSERT_EQ(plain.hits.size(), 5u);
  EXPECT_FALSE(plain.hits[0].probability);
  query.min_probability = 0.5;
  EXPECT_NE(error_of([&] { search.search(query); }).find("remomask evaluate calibration"),
            std::string::npos);

  // Right from the second best hit on, half right below it.
  const double high = plain.hits[1].similarity, low = plain.hits[2].similarity;
  const search::Calibration calibration =
      search::fit_calibration({low - 1, low, low, high}, {false, false, true, true});
  database.set_fact(search::calibration_fact((*retriever_)->hash()),
                    nlohmann::json(calibration).dump());
  query.min_probability.reset();
  const SearchAnswer answer = search.search(query);
  for (const MotionHit& hit : answer.hits) {
    EXPECT_DOUBLE_EQ(hit.probability.value(), calibration.probability(hit.similarity));
  }
  EXPECT_DOUBLE_EQ(*answer.hits[0].probability, 1);
  EXPECT_DOUBLE_EQ(*answer.hits[2].probability, 0.5);
  query.min_probability = 0.75;
  const SearchAnswer limited = search.search(query);
  ASSERT_EQ(limited.hits.size(), 2u);
  EXPECT_EQ(limited.refused->clip.name, answer.hits[2].clip.name);
  query.min_probability = 1.5;
  EXPECT_NE(error_of([&] { search.search(query); }).find("not a probability"), std::string::npos);

  SearchQuery like;
  like.like_clip = "a";
  EXPECT_FALSE(search.search(like).hits.at(0).probability);
  like.min_probability = 0.5;
  EXPECT_NE(error_of([&] { search.search(like); }).find("sentences alone"), std::string::npos);
  database.set_fact(search::calibration_fact((*retriever_)->hash()), "{]");
  query.min_probability.reset();
  EXPECT_NE(error_of([&] { search.search(query); }), "");
}

TEST_F(MotionSearchTest, AnswersSeveralThreadsAlike) {
  MotionQuery query;
  query.text = "a person kicks";
  query.like_clip = "clip11";
  query.parts = {"legs"};
  const SearchAnswer expected = search_->search(query);
  std::vector<int> failures(4, 0);
  {
    std::vector<std::jthread> threads;
    for (size_t t = 0; t < failures.size(); ++t) {
      threads.emplace_back([&, t] {
        for (int round = 0; round < 5; ++round) {
          const SearchAnswer answer = search_->search(query);
          for (size_t i = 0; i < expected.hits.size(); ++i) {
            failures[t] += answer.hits.at(i).clip.id != expected.hits[i].clip.id;
          }
        }
      });
    }
  }
  EXPECT_EQ(failures, std::vector<int>(4, 0));
}

TEST_F(MotionSearchTest, StoredMotionsAndMomentsOfTheShippedDatabase) {
  const search::MotionSearch shipped(*retriever_, nullptr, kModels + "motions.sqlite");
  const db::Database database(kModels + "motions.sqlite", db::OpenMode::read_only);
  MotionQuery query;
  query.k = 1;
  for (const char* name : {"procedural-walk-circle-left-000", "procedural-walk-slow-000"}) {
    query.motion = database.motion(*database.find_name(name));
    for (const std::vector<std::string>& parts :
         {std::vector<std::string>{}, std::vector<std::string>{"arms"}}) {
      query.parts = parts;
      const SearchAnswer answer = shipped.search(query);
      EXPECT_EQ(answer.hits.at(0).clip.name, name);
      EXPECT_NEAR(answer.hits[0].similarity, 1, 1e-3);
    }
  }
  query.moments = true;
  EXPECT_NE(error_of([&] { shipped.search(query); }).find("whole body"), std::string::npos);
  query.parts.clear();
  MotionQuery jump;
  jump.text = "a person jumps";
  jump.moments = true;
  jump.k = 3;
  const at::Tensor text = (*retriever_)->encode_text({jump.text}).query[0];
  for (const MotionHit& hit : shipped.search(jump).hits) {
    const motion::Features features = motion::extract_features_all_frames(
        database.motion(hit.clip.id), humanml_skeleton(), (*retriever_)->feature_mode());
    const auto windows = search::moment_windows(features.frames);
    const search::Moment best =
        search::best_moments(text, windows, search::encode_moments(**retriever_, features, windows))
            .at(0);
    ASSERT_TRUE(hit.moment);
    EXPECT_DOUBLE_EQ(hit.moment->start, best.window.first / 20.0);
    EXPECT_DOUBLE_EQ(hit.moment->end, best.window.last / 20.0);
    EXPECT_NEAR(hit.moment->similarity, best.similarity, 1e-4);
    EXPECT_LE(hit.moment->end, hit.clip.frames / 20.0);
  }
  EXPECT_FALSE(shipped.captions_for(query).empty());
  query.motion = walking_motion(201, 1);
  EXPECT_NE(error_of([&] { shipped.search(query); }).find("10.05 s"), std::string::npos);
  query.motion = walking_motion(3, 1);
  EXPECT_NE(error_of([&] { shipped.search(query); }), "");
}

}  // namespace
}  // namespace remomask
