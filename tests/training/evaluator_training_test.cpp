#include "training/evaluator_training.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <filesystem>

#include "evaluation/evaluator_quality.h"
#include "remomask/error.h"
#include "tests/evaluation/evaluator_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

training::EvaluatorTrainingOptions quick_evaluator_options(int64_t steps) {
  training::EvaluatorTrainingOptions options(ModelSize::tiny);
  options.window = 20;
  options.movement.steps = 4;
  options.trainer.steps = steps;
  options.batch = 16;
  options.validation_every = 2;
  return options;
}

TEST(EvaluatorLoss, ByHand) {
  const at::Tensor text = torch::tensor({{0.f, 0.f}, {3.f, 0.f}});
  const at::Tensor motion = torch::tensor({{0.f, 4.f}, {3.f, 1.f}});
  // Matched: 16 and 1. Text 0 to motion 1: 10; text 1 to motion 0: 25.
  const at::Tensor none = torch::zeros({2, 2}, torch::kBool);
  EXPECT_NEAR(training::evaluator_loss(text, motion, none, 10).item<double>(), 8.5, 1e-5);
  at::Tensor one = none.clone();
  one.index_put_({1, 0}, true);
  EXPECT_NEAR(training::evaluator_loss(text, motion, one, 10).item<double>(), 8.5 + 25, 1e-4);
  at::Tensor both = one.clone();
  both.index_put_({0, 1}, true);
  const double far = 10 - std::sqrt(10.0);
  EXPECT_NEAR(training::evaluator_loss(text, motion, both, 10).item<double>(),
              8.5 + (25 + far * far) / 2, 1e-4);
  EXPECT_NEAR(training::evaluator_loss(text, motion, both, 3).item<double>(), 8.5,
              1e-5);  // far enough
}

TEST(EvaluatorLoss, AlikePairsAreNoMismatches) {
  std::vector<db::TrainingClip> clips(4);
  for (int i = 0; i < 4; ++i) clips[static_cast<size_t>(i)].group = i;
  clips[1].meaning = clips[2].meaning = "walk/proud";
  clips[3].group = 0;
  const at::Tensor allowed = training::may_mismatch({&clips[0], &clips[1], &clips[2], &clips[3]},
                                                    {"a run", "b", "A run.", "c"});
  const at::Tensor expected = torch::tensor({{false, true, false, false},
                                             {true, false, false, true},
                                             {false, false, false, true},
                                             {false, true, true, false}});
  EXPECT_TRUE(allowed.equal(expected)) << allowed;
}

TEST(EvaluatorTraining, ResumedRunEqualsTheUninterrupted) {
  const auto clips = separable_clips(12, 3, 1);
  const std::string path = testing::TempDir() + "/evaluator_checkpoint.safetensors";
  const auto remove_files = [&] {
    std::filesystem::remove(path);
    std::filesystem::remove(path + ".movement");
  };
  remove_files();
  training::EvaluatorTrainingOptions options = quick_evaluator_options(5);
  const evaluation::EvaluatorConfig config = evaluation::evaluator_preset(ModelSize::tiny);
  const nn::ModelStage whole = training::train_evaluator(clips, clips, config, options, {});

  options.trainer.checkpoint_path = path;
  options.trainer.checkpoint_seconds = 0;
  for (const std::string stage : {"train evaluator movement", "train evaluator"}) {
    std::stop_source stop;
    Monitor monitor;
    monitor.stop = stop.get_token();
    monitor.progress = [&](const Progress& progress) {
      if (progress.stage == stage) stop.request_stop();
    };
    EXPECT_THROW(training::train_evaluator(clips, clips, config, options, monitor), Interrupted);
  }
  const nn::ModelStage resumed = training::train_evaluator(clips, clips, config, options, {});
  EXPECT_EQ(resumed.config, whole.config);
  ASSERT_EQ(resumed.tensors.size(), whole.tensors.size());
  for (const auto& [name, tensor] : whole.tensors) {
    EXPECT_TRUE(tensor.equal(resumed.tensors.at(name))) << name;
  }
  // Another run must not continue from it.
  options.margin = 5;
  EXPECT_THROW(training::train_evaluator(clips, clips, config, options, {}), Error);
  remove_files();
}

TEST(EvaluatorTraining, LearnsSeparableMotionsSelectsOnValAndSurvivesTheFile) {
  const auto train = separable_clips(24, 8, 1), val = separable_clips(24, 2, 50),
             test = separable_clips(24, 2, 99);
  training::EvaluatorTrainingOptions options = quick_evaluator_options(100);
  options.batch = 32;
  options.movement.steps = 30;
  options.validation_every = 50;
  const nn::ModelStage stage = training::train_evaluator(
      train, val, evaluation::evaluator_preset(ModelSize::tiny), options, {});
  // The step of the best validation, the first of equals.
  int64_t best_step = 0;
  double best = -1;
  for (const auto& entry : stage.config.at("history")) {
    const double figure = entry.at("top1").get<double>() + entry.at("top2").get<double>() +
                          entry.at("top3").get<double>();
    if (figure > best + 1e-12) {
      best = figure;
      best_step = entry.at("step");
    }
  }
  EXPECT_EQ(stage.config.at("selected_step"), best_step);

  const std::string path = testing::TempDir() + "/evaluator.safetensors";
  nn::save_model(path, {stage}, /*half=*/true);
  const evaluation::Evaluator evaluator = evaluation::load_evaluator(path);
  std::filesystem::remove(path);
  evaluation::GenerationFigureOptions measure;
  measure.batch = 24;
  measure.draws = 3;
  const auto figures = measure_pairs(
      evaluation::real_pairs(evaluator, test, evaluation::DistinctBy::captions, 3, 1), measure);
  EXPECT_GT(figures.r_precision[0].mean, 0.5);  // chance: 1 of 24
  EXPECT_GT(figures.r_precision[2].mean, figures.r_precision[0].mean - 1e-9);
}

TEST(EvaluatorTraining, NeedsCaptionsAndFrames) {
  auto clips = separable_clips(4, 1, 1);
  training::EvaluatorTrainingOptions options = quick_evaluator_options(2);
  options.window = 100;  // longer than the clips
  EXPECT_THROW(training::train_evaluator(clips, {}, evaluation::evaluator_preset(ModelSize::tiny),
                                         options, {}),
               Error);
  for (db::TrainingClip& clip : clips) clip.captions = {" . "};
  EXPECT_THROW(training::train_evaluator(clips, {}, evaluation::evaluator_preset(ModelSize::tiny),
                                         quick_evaluator_options(2), {}),
               Error);
}

}  // namespace
}  // namespace remomask
