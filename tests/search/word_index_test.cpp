#include "search/word_index.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

using Texts = std::vector<std::vector<std::string>>;

search::WordIndex index_of(const Texts& texts) {
  return {texts.size(), [&](size_t place) { return texts[place]; }};
}

const Texts kTexts = {{"a person walks forward", "someone strolls ahead slowly"},
                      {"a person does push-ups on the floor"},
                      {"two pushups", "walks, walks, walks"},
                      {"someone pushes up a box"},
                      {}};

TEST(WordIndexTest, CountsAsFts5Does) {
  const std::vector<std::string> words = {"walk", "run",  "jump",   "left", "right", "arm",
                                          "leg",  "slow", "circle", "wave", "kick",  "turn"};
  CounterRandom random(5, 1);
  const TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  Texts texts;
  std::vector<int64_t> ids;
  for (int i = 0; i < 60; ++i) {
    db::Clip clip = named_clip("clip" + std::to_string(i));
    clip.captions.clear();
    for (uint64_t c = random.below(3) + 1; c > 0; --c) {
      std::string text;
      for (uint64_t w = random.below(9) + 1; w > 0; --w) {
        text += words[random.below(words.size())] + " ";
      }
      clip.captions.push_back(text);
    }
    clip.captions.push_back("a caption that they share");  // each counts by itself
    texts.push_back(clip.captions);
    ids.push_back(database.add_clip(clip, walking_motion(8, i)));
  }
  const search::WordIndex index = index_of(texts);
  for (const std::vector<std::string>& asked :
       {std::vector<std::string>{"walking"}, {"left", "arms", "kick"}, {"shared", "slow"}}) {
    std::string sentence, query;
    for (const std::string& word : asked) {
      sentence += word + " ";
      query += (query.empty() ? "" : " OR ") + word;
    }
    const search::WordMatches found = index.match(index.terms(sentence));
    const auto truth = database.match_captions(query);
    std::vector<double> expected(ids.size());
    for (const db::CaptionMatch& match : truth) {
      const auto place = std::lower_bound(ids.begin(), ids.end(), match.clip_id) - ids.begin();
      expected[static_cast<size_t>(place)] = match.bm25 / truth.front().bm25;
    }
    for (size_t i = 0; i < ids.size(); ++i) EXPECT_NEAR(found.bm25[i], expected[i], 1e-4) << query;
  }
}

TEST(WordIndexTest, SpellingsOfOneWordFindTheSame) {
  const search::WordIndex index = index_of(kTexts);
  const search::WordMatches wanted = index.match(index.terms("push-ups"));
  EXPECT_GT(wanted.bm25[1], 0);
  EXPECT_GT(wanted.bm25[2], 0);
  EXPECT_EQ(wanted.bm25[3], 0);  // who pushes up does no push-up
  EXPECT_FLOAT_EQ(wanted.share[1], 1);
  for (const char* text : {"pushup", "push ups", "a pushup", "PUSH-UP"}) {
    const search::WordMatches same = index.match(index.terms(text));
    EXPECT_EQ(same.bm25, wanted.bm25) << text;
    EXPECT_EQ(same.share, wanted.share) << text;
  }
  EXPECT_GT(index.match(index.terms("pushes")).bm25[3], 0);
}

TEST(WordIndexTest, SharesWeighRareWordsMore) {
  const search::WordIndex index = index_of(kTexts);
  const auto terms = index.terms("the person walks with a violin");
  ASSERT_EQ(terms.size(), 2u);
  EXPECT_EQ(terms[1].number, -1);
  const search::WordMatches found = index.match(terms);
  // ln(1 + 5 / 2) and ln(1 + 5 / 0.5)
  EXPECT_NEAR(found.share[0], 1.2528 / (1.2528 + 2.3979), 1e-3);
  EXPECT_FLOAT_EQ(found.bm25[2], 1);
  EXPECT_EQ(found.bm25[4], 0);
  EXPECT_EQ(index.match({}).share, std::vector<float>(5));
}

TEST(WordIndexTest, KnowsWhatAClipHas) {
  const search::WordIndex index = index_of(kTexts);
  EXPECT_TRUE(index.clip_has(0, index.terms("walking slowly")));
  EXPECT_FALSE(index.clip_has(1, index.terms("walking")));
  EXPECT_TRUE(index.clip_has(1, index.terms("pushups")));
  EXPECT_FALSE(index.clip_has(4, index.terms("walk")));
  EXPECT_FALSE(index.clip_has(0, index.terms("violin")));
  EXPECT_TRUE(index.has_word("Strolling"));
  EXPECT_FALSE(index.has_word("violin"));
  EXPECT_FALSE(index.has_word(""));
  EXPECT_EQ(index.vocabulary().at("walks"), 4);
}

TEST(WordIndexTest, ManyWordsAreNoTrouble) {
  const search::WordIndex index = index_of(kTexts);
  std::string many = "strolls ";
  for (int i = 0; i < 500; ++i) many += "word" + std::to_string(i) + " ";
  EXPECT_EQ(index.terms(many).size(), 501u);
  EXPECT_NO_THROW(index.match(index.terms(many)));
  const search::WordIndex empty = index_of({});
  EXPECT_TRUE(empty.match(empty.terms("walk")).bm25.empty());
}

TEST(ContentWordsTest, AreAsTyped) {
  EXPECT_EQ(search::content_words("The man's Push-ups, then (he) 'waves' - s"),
            (std::vector<std::string>{"man's", "Push-ups", "waves"}));
  EXPECT_EQ(search::content_words("läuft"), (std::vector<std::string>{"läuft"}));
}

}  // namespace
}  // namespace remomask
