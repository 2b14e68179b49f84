// Search by words with the shipped text encoder, in a database of few clips whose motion vectors
// are random: what is found is found by its captions.
#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "db/database.h"
#include "db/snapshot.h"
#include "index/vector_index.h"
#include "nn/model_file.h"
#include "remomask/error.h"
#include "search/embed_captions.h"
#include "search/motion_search.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

const std::string kShipped = REMOMASK_SOURCE_DIR "/models/";

class WordSearchTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TestFolder;
    words_ = new std::shared_ptr<const search::WordModel>(std::make_shared<search::WordModel>(
        search::WordModel::open(kShipped + "text.safetensors")));
    retriever_ = new std::shared_ptr<const retriever::Retriever>(
        std::make_shared<const retriever::Retriever>(
            retriever::open_retriever(kShipped + "base.safetensors", (*words_)->encoder)));
    path_ = *folder_ / "motions.sqlite";
    db::Database database(path_, db::OpenMode::create);
    const std::map<std::string, std::vector<std::string>> clips = {
        {"walk", {"a person walks forward.", "someone strolls ahead."}},
        {"wave", {"a person waves with the right hand."}},
        {"kick", {"someone kicks with the left leg."}},
        {"swim", {"a person stands and moves the arms as if swimming."}},
        {"sit", {"a person sits down on a chair."}},
        {"floor", {"a person does pushups on the floor."}},
        {"lift", {"a person pushes up a heavy box."}},
        {"dumb", {}}};
    int frames = 20;
    for (const auto& [name, captions] : clips) {
      db::Clip clip = named_clip(name);
      clip.captions = captions;
      clip.group = "test/" + name;
      if (name == "sit") clip.tags = {"office scene"};
      add_test_clip(database, clip, ++frames);
    }
    std::vector<db::ClipEmbedding> embeddings;
    for (const db::Clip& clip : database.clips()) {
      const auto own = static_cast<uint64_t>(clip.id);
      embeddings.push_back(
          {clip.id, random_directions(1, static_cast<int>((*retriever_)->embedding_width()), own),
           random_directions(6, static_cast<int>((*retriever_)->part_width()), own + 50),
           random_directions(1, static_cast<int>((*retriever_)->embedding_width()), own + 90)});
    }
    database.store_embeddings((*retriever_)->hash(), embeddings);
    search::embed_captions(database, *(*words_)->encoder);
    index::VectorIndex::build(database, (*retriever_)->hash()).save(path_ + ".index");
    search_ = new search::MotionSearch(*retriever_, *words_, path_);
  }
  static void TearDownTestSuite() {
    delete search_;
    delete words_;
    delete retriever_;
    delete folder_;
  }

  static SearchAnswer ask(const std::string& text, SearchBy by = SearchBy::all) {
    SearchQuery query;
    query.text = text;
    query.by = by;
    return search_->search(query);
  }
  static std::string first(const SearchAnswer& answer) {
    return answer.hits.empty() ? "" : answer.hits.front().clip.name;
  }

  static inline TestFolder* folder_;
  static inline std::shared_ptr<const retriever::Retriever>* retriever_;
  static inline std::shared_ptr<const search::WordModel>* words_;
  static inline search::MotionSearch* search_;
  static inline std::string path_;
};

TEST_F(WordSearchTest, FindsWhatIsMeant) {
  for (const auto& [text, name] :
       std::map<std::string, std::string>{{"he is taking a seat", "sit"},
                                          {"GREETING somebody by waving", "wave"},
                                          {"front crawl in the pool", "swim"},
                                          {"a man goes for a walk", "walk"}}) {
    const SearchAnswer answer = ask(text);
    EXPECT_EQ(first(answer), name) << text;
    ASSERT_TRUE(answer.hits.front().probability) << text;
    EXPECT_GT(*answer.hits.front().probability, *answer.hits.back().probability);
    ASSERT_TRUE(answer.hits.front().parts);
    EXPECT_FALSE(answer.hits.front().parts->caption.empty());
    EXPECT_EQ(first(ask(text, SearchBy::captions)), name) << text;
  }
}

TEST_F(WordSearchTest, WhoMovesChangesLittle) {
  const double probability = *ask("a person waves").hits.front().probability;
  for (const char* text : {"a man waves", "the girl waves", "robot  waves", "he waves", "waves"}) {
    const SearchAnswer answer = ask(text);
    EXPECT_EQ(first(answer), "wave") << text;
    EXPECT_NEAR(*answer.hits.front().probability, probability, 0.15) << text;
  }
}

TEST_F(WordSearchTest, SaysWhichWordIsNotThere) {
  const SearchAnswer answer = ask("walks with a violin");
  ASSERT_EQ(answer.words.size(), 2u);
  EXPECT_EQ(answer.words[0].word, "walks");
  EXPECT_TRUE(answer.words[0].in_captions);
  EXPECT_EQ(answer.words[1].word, "violin");
  EXPECT_LT(answer.words[1].covered, kCoveredWord);
  // By meaning: "strides" stands in no caption.
  const SearchAnswer near = ask("strolling");
  EXPECT_TRUE(near.words.at(0).covered >= kCoveredWord);
}

TEST_F(WordSearchTest, ReadsTypingErrors) {
  const SearchAnswer answer = ask("a person waks foward");
  EXPECT_EQ(first(answer), "walk");
  EXPECT_EQ(answer.sentence, "a person walks forward");
  ASSERT_EQ(answer.corrected.size(), 2u);
  EXPECT_EQ(answer.corrected[1].typed, "foward");
}

TEST_F(WordSearchTest, FindsTheMirrorImageOfAClip) {
  const SearchAnswer answer = ask("waves with the left hand");
  EXPECT_EQ(first(answer), "wave");
  EXPECT_TRUE(answer.hits.front().as_mirrored);
  const SearchAnswer right = ask("waves with the right hand");
  EXPECT_EQ(first(right), "wave");
  EXPECT_FALSE(right.hits.front().as_mirrored);
  EXPECT_NEAR(*right.hits.front().probability, *answer.hits.front().probability, 0.2);
  SearchQuery query;
  query.text = "waves with the left hand";
  query.mirror = false;
  const SearchAnswer plain = search_->search(query);
  EXPECT_FALSE(plain.hits.front().as_mirrored);
  EXPECT_LT(*plain.hits.front().probability, *answer.hits.front().probability);
}

TEST_F(WordSearchTest, SearchesByWordsAlone) {
  const SearchAnswer answer = ask("kicking", SearchBy::words);
  ASSERT_EQ(answer.hits.size(), 1u);
  EXPECT_EQ(first(answer), "kick");
  EXPECT_FLOAT_EQ(answer.hits.front().similarity, 1);
  EXPECT_FALSE(answer.hits.front().probability);
  // Signs that mean something to FTS5 are words like others, or none.
  for (const char* text : {"walk* NEAR( -", "\"kick", "kick AND OR NOT", "(kick:"}) {
    EXPECT_NO_THROW(ask(text)) << text;
  }
}

TEST_F(WordSearchTest, SpellingsOfACompoundAreOneWord) {
  const SearchAnswer wanted = ask("push-ups");
  EXPECT_EQ(first(wanted), "floor");
  for (const char* text : {"pushups", "push ups", "Push ups"}) {
    const SearchAnswer same = ask(text);
    ASSERT_EQ(same.words.size(), 1u) << text;
    EXPECT_TRUE(same.words.front().in_captions) << text;
    ASSERT_EQ(same.hits.size(), wanted.hits.size());
    for (size_t i = 0; i < same.hits.size(); ++i) {
      EXPECT_EQ(same.hits[i].clip.name, wanted.hits[i].clip.name) << text;
      EXPECT_NEAR(*same.hits[i].probability, *wanted.hits[i].probability, 1e-3) << text;
    }
  }
  const auto lift = std::find_if(wanted.hits.begin(), wanted.hits.end(),
                                 [](const MotionHit& hit) { return hit.clip.name == "lift"; });
  ASSERT_NE(lift, wanted.hits.end());
  EXPECT_EQ(lift->parts->words, 0);
  EXPECT_EQ(first(ask("pushes up")), "lift");
}

TEST_F(WordSearchTest, FindsTags) {
  EXPECT_EQ(first(ask("office", SearchBy::words)), "sit");
  EXPECT_GT(ask("sits down in an office").hits.front().parts->share, 0.99);
}

TEST_F(WordSearchTest, SaysThatASentenceIsInAnotherLanguage) {
  const SearchAnswer answer = ask("una persona camina");
  EXPECT_EQ(answer.language, "Spanish");
  EXPECT_TRUE(answer.corrected.empty());
  EXPECT_FALSE(answer.hits.empty());
  EXPECT_EQ(ask("走路").language, "Chinese");
  EXPECT_EQ(ask("a person walks").language, "");
  EXPECT_EQ(ask("waks foward").language, "");
  EXPECT_EQ(ask("blorp fnargle").language, "another language");
  EXPECT_THROW(ask("👋"), Error);
}

TEST_F(WordSearchTest, FindsClipsWithoutCaptionsByTheirMotion) {
  const SearchAnswer answer = ask("anything at all");
  const auto dumb = std::find_if(answer.hits.begin(), answer.hits.end(),
                                 [](const MotionHit& hit) { return hit.clip.name == "dumb"; });
  ASSERT_NE(dumb, answer.hits.end());
  EXPECT_TRUE(dumb->parts->caption.empty());
  EXPECT_FALSE(dumb->parts->best);
  EXPECT_TRUE(dumb->probability);
}

TEST_F(WordSearchTest, RefusesWhatItCannotAnswer) {
  EXPECT_THROW(ask(""), Error);
  EXPECT_THROW(ask("!? ..."), Error);
  SearchQuery query;
  query.text = "walk";
  query.boost_words = "slow";
  EXPECT_THROW(search_->search(query), Error);
  query.boost_words.clear();
  query.by = SearchBy::words;
  query.min_probability = 0.5;
  EXPECT_THROW(search_->search(query), Error);
  const search::MotionSearch wordless(*retriever_, nullptr, path_);
  query = {};
  query.text = "walk";
  EXPECT_THROW(wordless.search(query), Error);
  query.by = SearchBy::motion;
  EXPECT_EQ(wordless.search(query).hits.size(), 8u);
  EXPECT_THROW(parse_search_by("feeling"), Error);
}

TEST_F(WordSearchTest, LongAndStrangeTextsAreAnswered) {
  std::string many;
  for (int i = 0; i < 500; ++i) many += "walks and kicks ";
  for (const std::string& text :
       {many, std::string("une personne qui marche"), std::string("wave \u200b hand"),
        std::string("يمشي"), std::string("wave 👋"), std::string("一个人走路")}) {
    EXPECT_FALSE(ask(text).hits.empty()) << text.substr(0, 40);
  }
}

TEST_F(WordSearchTest, FollowsChangesAndAsksForMissingVectors) {
  TestFolder folder;
  const std::string copy = folder / "copy.sqlite";
  db::snapshot_database(path_, copy, false);
  std::filesystem::copy_file(path_ + ".index", copy + ".index");
  const search::MotionSearch search(*retriever_, *words_, copy);
  SearchQuery query;
  query.text = "juggles three balls";
  EXPECT_LT(*search.search(query).hits.front().probability, 0.5);
  {
    db::Database database(copy, db::OpenMode::read_write);
    db::ClipChanges changes;
    changes.captions = {"someone juggles balls."};
    database.update_clip(*database.find_name("dumb"), changes);
    EXPECT_EQ(search.search(query).unsearched, 1);
    EXPECT_EQ(search::embed_captions(database, *(*words_)->encoder), 1);
    EXPECT_EQ(search::embed_captions(database, *(*words_)->encoder), 0);
  }
  EXPECT_EQ(search.search(query).hits.front().clip.name, "dumb");
  {
    db::Database database(copy, db::OpenMode::read_write);
    EXPECT_GT(database.drop_unused_caption_vectors(""), 0);
  }
  EXPECT_THROW(search.search(query), Error);
}

}  // namespace
}  // namespace remomask
