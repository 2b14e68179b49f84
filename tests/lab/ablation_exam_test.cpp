#include "lab/ablation_exam.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/features.h"
#include "remomask/error.h"
#include "tests/evaluation/evaluator_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

/// Clips of three contents; the asked ones are two of them, of which one is the
/// repetition ("take") of something that was trained.
struct ExamClips {
  std::vector<db::TrainingClip> clips;
  std::vector<const db::TrainingClip*> train, asked;
  std::vector<evaluation::LabelPrompt> prompts;

  ExamClips() {
    const std::vector<std::string> contents = {"walk", "wave", "jump"};
    for (int i = 0; i < 45; ++i) {
      db::TrainingClip clip;
      clip.clip_id = i;
      clip.group = i;
      // Twenty walks, twenty waves, five jumps.
      clip.content = contents[static_cast<size_t>(i / 20)];
      clip.captions = {"a person " + clip.content + "s"};
      clip.features = random_features(40, static_cast<uint64_t>(i + 1));
      clips.push_back(std::move(clip));
    }
    for (const db::TrainingClip& clip : clips) train.push_back(&clip);
    clips[1].unseen = "take";
    for (const int i : {1, 41}) {
      const db::TrainingClip& clip = clips[static_cast<size_t>(i)];
      asked.push_back(&clip);
      prompts.push_back({i, "clip", "group", clip.captions[0], clip.content, clip.unseen, 40, 1});
    }
  }
};

TEST(AblationExam, RealClipsAreTheirOwnNearestOnes) {
  const evaluation::Evaluator judge(untrained_evaluator_stage(3));
  const ExamClips set;
  const lab::AblationExam exam(judge, set.train, set.asked, set.prompts);
  EXPECT_EQ(exam.groups(), (std::vector<int>{1, 41}));
  const lab::ExamResult real = exam.grade_real();
  ASSERT_EQ(real.size(), 3u);  // all, take, rare; nothing is of an unseen pair
  EXPECT_EQ(real.at("all").prompts, 2);
  EXPECT_EQ(real.at("all").content_right, 1);
  EXPECT_NEAR(real.at("all").metrics.fid.mean, 0, 1e-6);
  EXPECT_EQ(real.at("take").prompts, 1);
  EXPECT_EQ(real.at("rare").prompts, 1);  // five jumps
}

TEST(AblationExam, BrokenMotionsAreWrong) {
  const evaluation::Evaluator judge(untrained_evaluator_stage(3));
  const ExamClips set;
  const lab::AblationExam exam(judge, set.train, set.asked, set.prompts);
  Motion standing(40, 22);
  for (int t = 0; t < 40; ++t) {
    for (int j = 0; j < 22; ++j)
      set_joint_position(standing, t, j, Vec3(0.1 * j, 0.05 * j, 0.01 * t));
  }
  Motion broken = standing;
  set_joint_position(broken, 7, 3, Vec3(std::nan(""), 0, 0));
  const lab::ExamResult result = exam.grade({standing, broken});
  EXPECT_EQ(result.at("rare").content_right, 0);
  EXPECT_EQ(result.at("all").metrics.motions, 1);
  EXPECT_THROW(exam.grade({standing}), Error);
  auto prompts = set.prompts;
  prompts[0].clip_id = 7;
  EXPECT_THROW(lab::AblationExam(judge, set.train, set.asked, prompts), Error);
}

}  // namespace
}  // namespace remomask
