#include "lab/variants.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "pipeline/motion_generator.h"
#include "remomask/error.h"
#include "tests/encoders/tiny_words.h"
#include "tests/tokenizer/tokenizer_test_tools.h"
#include "training/model_training.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

/// Stages whose description differs from that of the full model.
std::set<std::string> changed_stages(const std::string& variant) {
  training::TrainingRecipe full = training::training_recipe(parse_preset("small")), other = full;
  lab::apply_variant(other, variant);
  std::set<std::string> changed;
  for (const std::string& stage : training::recipe_stages(full)) {
    if (training::stage_description(full, stage) != training::stage_description(other, stage))
      changed.insert(stage);
  }
  return changed;
}

// All else equal: a variant touches the stages that it is about and no other.
TEST(Variants, ChangeOneThing) {
  using Stages = std::set<std::string>;
  EXPECT_EQ(changed_stages("full"), Stages{});
  EXPECT_EQ(changed_stages("momask"), (Stages{"tokenizer", "masked", "residual"}));
  EXPECT_EQ(changed_stages("no-retrieval"), Stages{"masked"});
  EXPECT_EQ(changed_stages("no-hit-sequences"), Stages{"masked"});
  EXPECT_EQ(changed_stages("no-queues"), Stages{"retriever"});
  EXPECT_EQ(changed_stages("no-ssta"), Stages{"masked"});
  EXPECT_EQ(changed_stages("no-rag-cfg"), Stages{"masked"});
  EXPECT_EQ(changed_stages("no-part-encoders"), Stages{"retriever"});
  EXPECT_EQ(changed_stages("levels-2"), (Stages{"tokenizer", "residual"}));
  EXPECT_EQ(changed_stages("quantizer-dropout-0"), Stages{"tokenizer"});
}

TEST(Variants, EveryOptionOfTheCodebooksTellsStagesApart) {
  const training::TrainingRecipe recipe = training::training_recipe(parse_preset("tiny"));
  const auto differs = [&](auto change) {
    training::TrainingRecipe other = recipe;
    change(other.tokenizer_training.codebooks);
    return training::stage_description(recipe, "tokenizer") !=
           training::stage_description(other, "tokenizer");
  };
  EXPECT_FALSE(differs([](tokenizer::CodebookTraining&) {}));
  EXPECT_TRUE(differs([](tokenizer::CodebookTraining& codebooks) { codebooks.decay = 0.5; }));
  EXPECT_TRUE(differs([](tokenizer::CodebookTraining& codebooks) { codebooks.reset_every = 7; }));
  EXPECT_TRUE(differs([](tokenizer::CodebookTraining& codebooks) { codebooks.dead_share = 0.5; }));
  EXPECT_TRUE(
      differs([](tokenizer::CodebookTraining& codebooks) { codebooks.level_dropout = 0.9; }));
  EXPECT_TRUE(
      differs([](tokenizer::CodebookTraining& codebooks) { codebooks.sample_temperature = 1; }));
}

TEST(Variants, UnknownOnesAreRefused) {
  for (const char* name :
       {"no-legs", "levels-0", "levels-9", "levels-", "levels-2x", "quantizer-dropout-95", ""}) {
    EXPECT_THROW(lab::find_variant(name), Error) << name;
  }
  training::TrainingRecipe baseline = training::training_recipe(parse_preset("momask-tiny"));
  EXPECT_THROW(lab::apply_variant(baseline, "no-ssta"), Error);
  EXPECT_NO_THROW(lab::apply_variant(baseline, "full"));
}

TEST(Variants, EveryPresetHasARecipeForEveryStage) {
  for (const std::string& preset : preset_names()) {
    const training::TrainingRecipe recipe = training::training_recipe(parse_preset(preset));
    for (const std::string& stage : training::recipe_stages(recipe)) {
      EXPECT_EQ(training::stage_trainer(recipe, stage).stage_name, stage) << preset;
      EXPECT_GT(training::stage_trainer(recipe, stage).steps, 0) << preset;
      EXPECT_FALSE(training::stage_description(recipe, stage).at("config").empty());
    }
  }
  training::TrainingRecipe one_level = training::training_recipe(parse_preset("tiny"));
  lab::apply_variant(one_level, "levels-1");
  EXPECT_EQ(training::recipe_stages(one_level).back(), "masked");
  EXPECT_THROW(training::stage_trainer(one_level, "evaluator"), Error);
}

training::TrainingSplits variant_clips() {
  training::TrainingSplits splits;
  splits.train = swinging_clips({40, 48, 60, 44, 52, 72, 41, 64});
  const std::vector<std::string> texts = {"a person walks", "someone runs in a circle",
                                          "a man waves", "a person jumps and turns"};
  for (size_t i = 0; i < splits.train.size(); ++i) {
    db::TrainingClip& clip = splits.train[i];
    clip.split = "train";
    clip.group = static_cast<int>(i / 2);
    clip.content = texts[i % 4];
    for (const char* how : {"", " slowly", " quickly"}) clip.captions.push_back(texts[i % 4] + how);
  }
  splits.val = {splits.train[0]};
  return splits;
}

// Every variant goes the whole road: trained, stored, loaded, used.
TEST(Variants, TrainStoreAndGenerate) {
  const fs::path folder = fs::temp_directory_path() / "remomask_variants_test";
  fs::remove_all(folder);
  const training::TrainingSplits clips = variant_clips();
  std::vector<std::string> names;
  for (const lab::ModelVariant& variant : lab::model_variants()) names.push_back(variant.name);
  names.push_back("levels-1");
  for (const std::string& name : names) {
    training::TrainingRecipe recipe = training::training_recipe(parse_preset("tiny"));
    lab::apply_variant(recipe, name);
    recipe.tokenizer_training.window = 32;
    const training::StageFile file = [&](const std::string& stage) {
      return (folder / name / (stage + ".safetensors")).string();
    };
    fs::create_directories(folder / name);
    nn::save_model(file("text"), {tiny_text_stage()});
    training::GeneratorDataCache prepared;
    for (const std::string& stage : training::recipe_stages(recipe)) {
      training::set_stage_steps(recipe, stage, 2);
      training::set_stage_batch(recipe, stage, 4);
      training::train_stage(recipe, stage, file, clips, prepared, {});
      EXPECT_FALSE(fs::exists(file(stage) + ".checkpoint"));
    }
    training::join_stages(recipe, file, clips, file("model"), {});
    const auto stages = nn::load_model(file("model"));
    const nlohmann::json masked = stages.at("masked").config;
    const nlohmann::json retriever = stages.at("retriever").config;
    EXPECT_EQ(masked.at("rows"), name == "momask" ? 1 : 6) << name;
    EXPECT_EQ(masked.at("max_hits") == 0, name == "momask" || name == "no-retrieval") << name;
    EXPECT_EQ(masked.at("sequence_hits") == 0,
              name == "momask" || name == "no-retrieval" || name == "no-hit-sequences");
    EXPECT_EQ(masked.contains("evidence_gate"), masked.at("max_hits") > 0) << name;
    EXPECT_EQ(masked.at("attention"), name == "momask" || name == "no-ssta" ? "joined" : "ssta");
    EXPECT_EQ(masked.at("drops_conditions"), name != "no-rag-cfg") << name;
    EXPECT_EQ(retriever.at("encoders"), name == "no-part-encoders" ? 1 : 6) << name;
    EXPECT_EQ(retriever.at("recipe").at("training").at("queues"),
              name == "no-queues" ? "none" : "both");
    const pipeline::Generator generator(stages, tiny_words());
    GenerateOptions options;
    options.seconds = 2.0;
    options.sampling = recipe.sampling;
    const pipeline::Generated made = generator.generate("a person walks", {}, options);
    EXPECT_EQ(made.motion.frames, 40) << name;
    EXPECT_EQ(made.tokens.size(2), name == "levels-1" ? 1 : 3) << name;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace remomask
