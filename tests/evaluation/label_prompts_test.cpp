#include "evaluation/label_prompts.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "remomask/error.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

/// Ten clips "walk", two "run", one "jump" in test; others that do not count.
std::vector<db::Clip> clips_of_three_contents() {
  std::vector<db::Clip> clips;
  const auto add = [&](const std::string& content, const std::string& split) {
    db::Clip clip = named_clip("clip" + std::to_string(clips.size()));
    clip.id = static_cast<int64_t>(clips.size()) + 1;
    clip.split = split;
    clip.frames = 60;
    clip.captions = {content + " one", content + " two"};
    clip.labels = {{"content", content}};
    clips.push_back(clip);
  };
  for (int i = 0; i < 10; ++i) add("walk", "test");
  add("run", "test");
  add("run", "test");
  add("jump", "test");
  add("climb", "train");
  add("swim", "test");
  clips.back().mirrored = true;
  add("", "test");
  add("fly", "test");
  clips.back().captions.clear();
  return clips;
}

TEST(LabelPrompts, GoThroughTheContentsInTurn) {
  const auto prompts = evaluation::choose_label_prompts(clips_of_three_contents(), "test", 12, 5);
  ASSERT_EQ(prompts.size(), 12u);
  std::map<std::string, int> counts;
  std::set<std::string> walks;
  std::set<uint64_t> seeds;
  for (const evaluation::LabelPrompt& prompt : prompts) {
    ++counts[prompt.content];
    seeds.insert(prompt.seed);
    EXPECT_EQ(prompt.text.substr(0, prompt.content.size()), prompt.content);
    EXPECT_EQ(prompt.frames, 60);
    if (prompt.content == "walk") walks.insert(prompt.clip);
  }
  EXPECT_EQ(counts, (std::map<std::string, int>{{"jump", 4}, {"run", 4}, {"walk", 4}}));
  EXPECT_EQ(walks.size(), 4u) << "a clip was taken twice before all were taken once";
  EXPECT_EQ(seeds.size(), 12u);
  // The only clip "jump" comes with its other caption the second time.
  EXPECT_NE(prompts[0].text, prompts[3].text);
  EXPECT_EQ(prompts[0].text, prompts[6].text);
}

TEST(LabelPrompts, AUniformDrawTakesEveryClipAlike) {
  const auto clips = clips_of_three_contents();
  int walks = 0;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const auto prompts =
        evaluation::choose_label_prompts(clips, "test", 1, seed, evaluation::PromptDraw::uniform);
    walks += prompts.at(0).content == "walk";
  }
  // 10 of 13 clips walk; the standard error of 100 draws is 4.2.
  EXPECT_NEAR(walks, 77, 17);
  const auto all =
      evaluation::choose_label_prompts(clips, "test", 13, 1, evaluation::PromptDraw::uniform);
  std::set<std::string> names;
  for (const evaluation::LabelPrompt& prompt : all) names.insert(prompt.clip);
  EXPECT_EQ(names.size(), 13u);
  EXPECT_THROW(evaluation::parse_prompt_draw("uneven"), Error);
}

TEST(LabelPrompts, AreAFunctionOfTheSeed) {
  const auto clips = clips_of_three_contents();
  const auto texts = [&](uint64_t seed) {
    std::string all;
    for (const evaluation::LabelPrompt& prompt :
         evaluation::choose_label_prompts(clips, "test", 9, seed)) {
      all += prompt.clip + prompt.text + std::to_string(prompt.seed) + "\n";
    }
    return all;
  };
  EXPECT_EQ(texts(1), texts(1));
  EXPECT_NE(texts(1), texts(2));
}

TEST(LabelPrompts, ZeroMeansEveryClipOnce) {
  auto clips = clips_of_three_contents();
  clips[3].labels["unseen"] = "pair";
  const auto prompts = evaluation::choose_label_prompts(clips, "test", 0, 5);
  ASSERT_EQ(prompts.size(), 13u);
  std::set<std::string> names;
  std::set<uint64_t> seeds;
  for (const evaluation::LabelPrompt& prompt : prompts) {
    names.insert(prompt.clip);
    seeds.insert(prompt.seed);
    EXPECT_EQ(prompt.unseen, prompt.clip == clips[3].name ? "pair" : "");
  }
  EXPECT_EQ(names.size(), 13u);
  EXPECT_EQ(seeds.size(), 13u);
}

TEST(LabelPrompts, RefuseASplitWithoutContents) {
  EXPECT_NE(error_of([] {
              evaluation::choose_label_prompts(clips_of_three_contents(), "val", 3, 1);
            }).find("'val'"),
            std::string::npos);
}

}  // namespace
}  // namespace remomask
