#include "db/captions_index.h"

#include "db/database.h"
#include "db/sqlite.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class CaptionsIndexTest : public testing::Test {
 protected:
  int64_t add(const std::string& name, const std::vector<std::string>& captions) {
    db::Clip clip = named_clip(name);
    clip.captions = captions;
    return database_.add_clip(clip, walking_motion(20, seed_++));
  }
  std::vector<int64_t> find(const std::string& query, int limit = -1) {
    std::vector<int64_t> ids;
    for (const db::CaptionMatch& match : database_.match_captions(query, limit)) {
      ids.push_back(match.clip_id);
    }
    return ids;
  }
  std::string error(const std::string& query) {
    return error_of([&] { database_.match_captions(query); });
  }

  using Ids = std::vector<int64_t>;
  TestFolder folder_;
  db::Database database_{folder_ / "d", db::OpenMode::create};
  int seed_ = 0;
};

TEST_F(CaptionsIndexTest, FindsStemsWithoutCaseAndAccentsBestFirst) {
  const int64_t a = add("a", {"a person walks slowly around the big old house", "Ünïcode wörds"});
  const int64_t b = add("b", {"someone runs", "someone is WALKING"});
  const int64_t c = add("c", {"a jump"});
  EXPECT_EQ(find("walk"), (Ids{b, a}));  // a short caption that is hit counts more
  EXPECT_EQ(find("walk", 1), (Ids{b}));
  EXPECT_EQ(find("unicode words"), (Ids{a}));
  EXPECT_EQ(find("jumping"), (Ids{c}));
  EXPECT_EQ(find("run OR jumps"), (Ids{b, c}));  // equal: by id
  EXPECT_EQ(find("\"person walking\""), (Ids{a}));
  EXPECT_EQ(find("\"walking person\""), (Ids{}));
  EXPECT_EQ(find("some*"), (Ids{b}));
  EXPECT_EQ(find("walk NOT house"), (Ids{b}));
  const auto matches = database_.match_captions("walk");
  EXPECT_LT(matches[0].bm25, matches[1].bm25);
  EXPECT_LT(matches[1].bm25, 0);
}

TEST_F(CaptionsIndexTest, FollowsEveryChangeOfTheCaptions) {
  const int64_t a = add("a", {"a person walks", "a walk"});
  const int64_t b = add("b", {"a person runs"});
  db::ClipChanges changes;
  changes.captions = {"a person crawls"};
  database_.update_clip(a, changes);
  EXPECT_EQ(find("walk"), (Ids{}));
  EXPECT_EQ(find("crawl"), (Ids{a}));
  database_.remove({a});
  EXPECT_EQ(find("crawl"), (Ids{}));
  EXPECT_EQ(find("person"), (Ids{b}));
  database_.remove_clips("test", "b");
  EXPECT_EQ(find("person"), (Ids{}));
  const int64_t c = add("c", {"a person"});
  run_sql(folder_ / "d", "UPDATE caption SET text = 'a horse'");
  EXPECT_EQ(find("person"), (Ids{}));
  EXPECT_EQ(find("horse"), (Ids{c}));
}

TEST_F(CaptionsIndexTest, LastPossibleCaptionBelongsToItsClip) {
  std::vector<std::string> captions(db::kCaptionsOfClip, "walks");
  captions.back() = "jumps";
  const int64_t a = add("a", captions);
  add("b", {"walks"});
  EXPECT_EQ(find("jump"), (Ids{a}));
  captions.push_back("one more");
  EXPECT_NE(error_of([&] { add("c", captions); }).find("at most 1024"), std::string::npos);
}

TEST_F(CaptionsIndexTest, BrokenQueriesNameThePlace) {
  add("a", {"a person walks"});
  EXPECT_NE(error("walk AND").find("at character 9 "), std::string::npos) << error("walk AND");
  EXPECT_NE(error("walk ) run").find("at character 6 "), std::string::npos) << error("walk ) run");
  for (const char* query : {"\"walk", "who: walk", "walk's", "AND", "", "*", "^", "walk -"}) {
    const std::string message = error(query);
    EXPECT_NE(message.find("is not a valid query"), std::string::npos) << query << ": " << message;
    EXPECT_NE(message.find("quotes"), std::string::npos) << query << ": " << message;
  }
}

TEST_F(CaptionsIndexTest, QuotedWordsNeverFail) {
  const int64_t a = add("a", {"a person's \"moonwalk\" AND a turn - to the left; 90 degrees"});
  EXPECT_EQ(db::quote_caption_words("walk  and\tturn"), "\"walk\" \"and\" \"turn\"");
  EXPECT_EQ(db::quote_caption_words("say \"hi\""), "\"say\" \"\"\"hi\"\"\"");
  EXPECT_EQ(db::quote_caption_words(" - * ( "), "");
  for (const char* text : {"person's", "moonwalk AND turn", "\"moonwalk", "turn - left",
                           "NOT-a turn", "left; 90", "text: turn"}) {
    const std::string query = db::quote_caption_words(text);
    EXPECT_EQ(error(query), "") << query;
  }
  EXPECT_EQ(find(db::quote_caption_words("LEFT; moonwalk \"person's\"")), (Ids{a}));
  EXPECT_EQ(find(db::quote_caption_words("turn NOT left")), (Ids{}));
  EXPECT_EQ(error(db::quote_caption_words(std::string("turn l\0eft", 10))), "");
  // A dash that is no ASCII is a word to us and none to SQLite: it asks for nothing.
  EXPECT_EQ(error(db::quote_caption_words("turn \xe2\x80\x94 left")), "");
}

}  // namespace
}  // namespace remomask
