#include "lab/ablation_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "lab/ablation_cost.h"
#include "remomask/error.h"

namespace remomask {
namespace {

lab::AblationOptions small_ablation() {
  lab::AblationOptions options;
  options.folder = "ablation";
  options.preset = "tiny";
  options.variants = {"full", "momask", "no-retrieval", "no-queues", "no-ssta"};
  options.seeds = {1, 2};
  return options;
}

std::map<std::string, int> jobs_by_kind(const lab::AblationPlan& plan) {
  std::map<std::string, int> count;
  for (const lab::AblationJob& job : plan.jobs) ++count[job.kind];
  return count;
}

TEST(AblationPlan, EqualStagesAreTrainedOnce) {
  const lab::AblationPlan plan = lab::plan_ablation(small_ablation(), {"clips", "exam"});
  EXPECT_EQ(plan.models.size(), 10u);
  EXPECT_EQ(plan.trials.size(), 10u);
  const auto jobs = jobs_by_kind(plan);
  EXPECT_FALSE(jobs.contains("text"));
  EXPECT_EQ(jobs.at("tokenizer"), 2);  // six rows, one row
  EXPECT_EQ(jobs.at("retriever"), 4);  // with and without queues, two seeds
  EXPECT_EQ(jobs.at("masked"), 10);
  EXPECT_EQ(jobs.at("residual"), 6);  // full, momask, no-queues, two seeds
  EXPECT_EQ(jobs.at("trial"), 10);
  std::set<std::string> files;
  for (const lab::AblationJob& job : plan.jobs) {
    EXPECT_TRUE(files.insert(job.file).second) << job.file;
    EXPECT_GT(job.gigaoperations, 0) << job.title;
  }
}

TEST(AblationPlan, EveryJobFindsWhatItNeeds) {
  const lab::AblationPlan plan = lab::plan_ablation(small_ablation(), {"clips", "exam"});
  std::set<std::string> made;
  for (const lab::AblationJob& job : plan.jobs) {
    const lab::AblationModel& model =
        plan.models[job.kind == "trial" ? plan.trials[job.item].model : job.item];
    for (const auto& [stage, file] : model.files) {
      const bool needed =
          job.kind == "trial" || ((job.kind == "masked" || job.kind == "residual") &&
                                  (stage == "tokenizer" || stage == "retriever"));
      if (needed) {
        EXPECT_TRUE(made.contains(file)) << job.title << " before " << stage;
      }
    }
    made.insert(job.file);
  }
}

TEST(AblationPlan, FilesFollowWhatTheirContentDependsOn) {
  const lab::AblationOptions options = small_ablation();
  const auto files = [](const lab::AblationPlan& plan) { return plan.models.front().files; };
  const lab::AblationPlan plan = lab::plan_ablation(options, {"clips", "exam"});
  const auto before = files(plan);
  lab::AblationOptions longer = options;
  longer.steps["masked"] = 61;
  const auto after = files(lab::plan_ablation(longer, {"clips", "exam"}));
  EXPECT_EQ(before.at("residual"), after.at("residual"));
  EXPECT_NE(before.at("masked"), after.at("masked"));
  // Another tokenizer: other transformers, the same retriever.
  longer = options;
  longer.steps["tokenizer"] = 121;
  const auto tokens = files(lab::plan_ablation(longer, {"clips", "exam"}));
  EXPECT_EQ(before.at("retriever"), tokens.at("retriever"));
  EXPECT_NE(before.at("residual"), tokens.at("residual"));
  EXPECT_NE(before.at("retriever"),
            files(lab::plan_ablation(options, {"others", "exam"})).at("retriever"));
  // Another judge asks again and trains nothing.
  const lab::AblationPlan judged = lab::plan_ablation(options, {"clips", "another"});
  EXPECT_EQ(before, files(judged));
  EXPECT_NE(plan.trials.front().file, judged.trials.front().file);
  // More variants and seeds keep what is there.
  lab::AblationOptions fewer = options;
  fewer.variants = {"full"};
  fewer.seeds = {1};
  EXPECT_EQ(before, files(lab::plan_ablation(fewer, {"clips", "exam"})));
}

TEST(AblationPlan, SweepsSampleTheFirstModel) {
  lab::AblationOptions options = small_ablation();
  options.guidance_sweep = {1, 4};
  options.steps_sweep = {1, 18};
  const lab::AblationPlan plan = lab::plan_ablation(options, {"clips", "exam"});
  ASSERT_EQ(plan.trials.size(), 14u);
  EXPECT_EQ(plan.trials[10].sampling.guidance, 1);
  EXPECT_EQ(plan.trials[13].sampling.steps, 18);
  EXPECT_EQ(plan.trials[13].model, 0u);
  // Guidance 4 is what the full model is sampled with anyway.
  EXPECT_EQ(plan.trials[11].file, plan.trials[0].file);
  EXPECT_EQ(jobs_by_kind(plan).at("trial"), 13);
  options.variants = {"no-rag-cfg"};
  EXPECT_THROW(lab::plan_ablation(options, {"clips", "exam"}), Error);
}

TEST(AblationPlan, RefusesWhatCannotBeCompared) {
  const auto refused = [](auto change) {
    lab::AblationOptions options = small_ablation();
    change(options);
    EXPECT_THROW(lab::plan_ablation(options, {"clips", "exam"}), Error);
  };
  refused([](lab::AblationOptions& o) { o.variants = {}; });
  refused([](lab::AblationOptions& o) { o.variants = {"full", "full"}; });
  refused([](lab::AblationOptions& o) { o.variants = {"no-legs"}; });
  refused([](lab::AblationOptions& o) { o.seeds = {}; });
  refused([](lab::AblationOptions& o) { o.preset = "huge"; });
  refused([](lab::AblationOptions& o) { o.steps["dance"] = 3; });
  refused([](lab::AblationOptions& o) { o.batch["masked"] = 0; });
  refused([](lab::AblationOptions& o) { o.prompts = 0; });
}

TEST(AblationCost, GrowsWithSizesAndSteps) {
  const training::TrainingRecipe tiny = training::training_recipe(parse_preset("tiny")),
                                 base = training::training_recipe(parse_preset("base"));
  for (const std::string& stage : training::recipe_stages(tiny)) {
    EXPECT_LT(lab::training_cost(tiny, stage), lab::training_cost(base, stage)) << stage;
    training::TrainingRecipe twice = tiny;
    training::stage_trainer(twice, stage).steps *= 2;
    EXPECT_NEAR(lab::training_cost(twice, stage), 2 * lab::training_cost(tiny, stage), 1e-9)
        << stage;
  }
  EXPECT_LT(lab::trial_cost(tiny, tiny.sampling, 10), lab::trial_cost(base, base.sampling, 10));
}

}  // namespace
}  // namespace remomask
