#include "search/language.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/json.h"
#include "db/database.h"
#include "search/spelling.h"
#include "search/word_index.h"
#include "search/word_model.h"

namespace remomask {
namespace {

const std::string kRoot = REMOMASK_SOURCE_DIR;

/// The words of the shipped encoder and the shipped database, as a search has them.
class LanguageTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const db::Database database(kRoot + "/models/motions.sqlite", db::OpenMode::read_only);
    clips_ = new std::vector<db::Clip>(database.clips());
    index_ = new search::WordIndex(clips_->size(),
                                   [](size_t place) { return (*clips_)[place].captions; });
    encoder_ = new encoders::SentenceEncoder(
        encoders::SentenceEncoder::open(kRoot + "/models/text.safetensors"));
  }
  static void TearDownTestSuite() {
    delete encoder_;
    delete index_;
    delete clips_;
  }

  static std::string language(const std::string& sentence) {
    const search::KnownWords known{
        [](const std::string& word) { return index_->has_word(word); },
        [](const std::string& word) { return encoder_->is_word(word) || index_->has_word(word); }};
    const std::string found = search::foreign_language(sentence, known);
    if (found != search::kAnotherLanguage) return found;
    // As in a search: what a typing error explains is none.
    return search::foreign_language(
        search::correct_spelling(sentence, known.is_word, index_->vocabulary()).text, known);
  }
  static std::vector<nlohmann::json> lines(const std::string& name) {
    std::ifstream file(kRoot + "/tests/data/search_prompts/" + name);
    std::vector<nlohmann::json> all;
    for (std::string line; std::getline(file, line);) all.push_back(parse_json(line));
    return all;
  }

  static inline std::vector<db::Clip>* clips_;
  static inline search::WordIndex* index_;
  static inline encoders::SentenceEncoder* encoder_;
};

TEST_F(LanguageTest, ShortSentencesOfOtherLanguagesAreRecognised) {
  int right = 0, foreign = 0, all = 0;
  for (const nlohmann::json& line : lines("languages.jsonl")) {
    const std::string prompt = line.at("prompt"), found = language(prompt);
    ++all;
    foreign += found.empty() ? 0 : 1;
    right += found == line.at("language") ? 1 : 0;
    if (found != line.at("language")) {
      std::cout << prompt << ": '" << found << "', not " << line.at("language") << "\n";
    }
  }
  EXPECT_GE(all, 60);
  EXPECT_GE(foreign, 0.95 * all);
  EXPECT_GE(right, 0.9 * all);
}

TEST_F(LanguageTest, EnglishIsNoOtherLanguage) {
  for (const char* file : {"dev.jsonl", "everyday.jsonl"}) {
    for (const nlohmann::json& line : lines(file)) {
      EXPECT_EQ(language(line.at("prompt")), "") << line.at("prompt");
    }
  }
  for (const db::Clip& clip : *clips_) {
    for (const std::string& caption : clip.captions) EXPECT_EQ(language(caption), "") << caption;
  }
  for (const char* text : {"court",
                           "a kind of dance",
                           "pour water",
                           "the man on the van",
                           "piano",
                           "lance",
                           "karate",
                           "tai chi",
                           "capoeira",
                           "waks foward",
                           "do the moonwalk",
                           "en garde",
                           "no",
                           "a waltz, then",
                           "pirouette",
                           "rent a bike",
                           "sale",
                           "son and father",
                           "pas de deux",
                           "la la land",
                           "a person wlks",
                           "I've met em",
                           "tilt",
                           "heel to toe, till the end"}) {
    EXPECT_EQ(language(text), "") << text;
  }
}

TEST_F(LanguageTest, LettersOfOtherScriptsDecide) {
  EXPECT_EQ(language("走"), "Chinese");
  EXPECT_EQ(language("歩く人"), "Japanese");
  EXPECT_EQ(language("does 太极 slowly"), "");
  EXPECT_EQ(language("\xff\xfe"), "");
  EXPECT_EQ(language("👋"), "");
  EXPECT_EQ(language(""), "");
}

}  // namespace
}  // namespace remomask
