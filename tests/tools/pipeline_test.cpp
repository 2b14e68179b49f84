// The whole road with the program itself, on motions that it makes: database,
// training of every network (preset tiny), index, search, generation,
// evaluation. One model is trained for all tests.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <filesystem>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class PipelineTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TestFolder;
    run_json({"procedural", "--db", path("motions.sqlite"), "--count", "120"});
    const ProgramResult trained = run_program(train_arguments("run"));
    ASSERT_EQ(trained.exit_code, 0) << trained.errors;
    run_json({"index", path("motions.sqlite"), "--model", path("run/model.safetensors")});
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }

  static std::string path(const std::string& name) { return *scratch_ / name; }
  static std::vector<std::string> train_arguments(const std::string& folder) {
    return {"--quiet",  "train", "all", "--db",      path("motions.sqlite"),
            "--preset", "tiny",  "-o",  path(folder)};
  }
  static std::vector<std::string> with_model(std::vector<std::string> arguments) {
    for (const std::string& word : {std::string("--db"), path("motions.sqlite"),
                                    std::string("--model"), path("run/model.safetensors")}) {
      arguments.push_back(word);
    }
    return arguments;
  }

  static TestFolder* scratch_;
};

TestFolder* PipelineTest::scratch_ = nullptr;

TEST_F(PipelineTest, ModelHoldsAllStagesAndSaysSo) {
  const auto info = run_json({"info", path("run/model.safetensors")});
  for (const char* stage : {"retriever", "tokenizer", "masked", "residual"}) {
    EXPECT_TRUE(info["stages"].contains(stage)) << stage;
  }
}

TEST_F(PipelineTest, KilledTrainingResumesToTheSameModel) {
  // Stopped again and again, by Ctrl-C and by SIGKILL; the time is long enough
  // for the start of the program and some steps.
  ProgramResult result;
  int rounds = 0;
  do {
    const bool kill = rounds % 2 == 1;
    result =
        run_program(train_arguments("killed"), {}, rounds < 6 ? 2.5 : 0, kill ? SIGKILL : SIGINT);
    ++rounds;
  } while (result.exit_code != 0 && rounds < 30);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GT(rounds, 1);
  EXPECT_EQ(read_file(path("killed/model.safetensors")), read_file(path("run/model.safetensors")));
}

TEST_F(PipelineTest, TrainingGoesOnFromAModel) {
  const std::string model = path("run/model.safetensors");
  auto arguments = train_arguments("further");
  for (const std::string& word :
       {std::string("--from"), model, std::string("--keep"), std::string("retriever,tokenizer"),
        std::string("--text"), std::string(REMOMASK_SOURCE_DIR "/models/text.safetensors"),
        std::string("--steps"), std::string("2")}) {
    arguments.push_back(word);
  }
  const ProgramResult trained = run_program(arguments);
  ASSERT_EQ(trained.exit_code, 0) << trained.errors;
  const auto before = run_json({"info", model})["stages"];
  const auto after = run_json({"info", path("further/model.safetensors")})["stages"];
  for (const char* stage : {"retriever", "tokenizer"}) EXPECT_EQ(after[stage], before[stage]);
  for (const char* stage : {"masked", "residual"}) EXPECT_NE(after[stage], before[stage]);
  EXPECT_TRUE(fs::exists(path("further/text.safetensors")));
  const ProgramResult keep_alone = run_program(
      {"train", "all", "--db", path("motions.sqlite"), "-o", path("none"), "--keep", "tokenizer"});
  EXPECT_NE(keep_alone.exit_code, 0);
  EXPECT_NE(keep_alone.errors.find("--from"), std::string::npos) << keep_alone.errors;
}

TEST_F(PipelineTest, SearchFiltersAndExplains) {
  const auto found = run_json(with_model({"search", "a person waves", "-k", "5"}));
  ASSERT_EQ(found["hits"].size(), 5u);
  double before = 2;
  for (const auto& hit : found["hits"]) {
    EXPECT_LE(hit["probability"], before);
    before = hit["probability"];
    EXPECT_FALSE(hit["captions"].empty());
  }
  const auto squats = run_json(with_model(
      {"search", "a person waves", "-k", "50", "--label", "content=squat", "--split", "train"}));
  ASSERT_FALSE(squats["hits"].empty());
  for (const auto& hit : squats["hits"]) {
    EXPECT_NE(hit["clip"].get<std::string>().find("squat"), std::string::npos);
    EXPECT_EQ(hit["split"], "train");
  }
}

TEST_F(PipelineTest, SameSeedSameMotionForAnyThreadsAndCount) {
  const auto generate = [&](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> arguments =
        with_model({"generate", "a person walks forward", "--seconds", "3", "-o", path(file)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_json(arguments);
  };
  generate("one.npy", {"--seed", "5", "--threads", "1"});
  generate("four.npy", {"--seed", "5", "--threads", "4"});
  generate("many.npy", {"--seed", "4", "-n", "3", "--threads", "2"});
  const std::string expected = read_file(path("one.npy"));
  EXPECT_EQ(expected, read_file(path("four.npy")));
  EXPECT_EQ(expected, read_file(path("many-2.npy")));
  EXPECT_NE(expected, read_file(path("many-1.npy")));
}

TEST_F(PipelineTest, GeneratedFileCarriesItsEvidence) {
  const auto made =
      run_json(with_model({"generate", "someone kicks with the left leg", "--seed", "3", "-o",
                           path("kick.bvh"), "--sheet", path("kick.png")}));
  const auto& motion = made["motions"][0];
  const auto& segment = motion["segments"][0];
  ASSERT_FALSE(segment["evidence"].empty());
  EXPECT_TRUE(segment["evidence"][0].contains("licence"));
  EXPECT_EQ(segment["sentence"], "someone kicks with the left leg");
  EXPECT_EQ(motion["seed"], "3");
  // The sidecar is the answer without the place and time of its making.
  auto stored = nlohmann::json::parse(read_file(path("kick.bvh.json")));
  stored["file"] = motion["file"];
  stored["seconds_of_work"] = motion["seconds_of_work"];
  stored["file_fps"] = motion["file_fps"];
  stored["file_frames"] = motion["file_frames"];
  EXPECT_EQ(stored["motion_hash"].get<std::string>().size(), 32u);
  stored.erase("motion_hash");
  stored.erase("checksum");
  EXPECT_EQ(stored, motion);
  EXPECT_EQ(read_file(path("kick.png")).substr(1, 3), "PNG");
  const auto back = run_json({"convert", path("kick.bvh"), path("kick.npy")});
  EXPECT_EQ(back["frames"], motion["frames"]);
  const auto alone = run_json(with_model({"generate", "someone kicks with the left leg", "--seed",
                                          "3", "--no-retrieval", "-o", path("alone.bvh")}));
  EXPECT_TRUE(alone["motions"][0]["segments"][0]["evidence"].empty());
  EXPECT_NE(read_file(path("alone.bvh")), read_file(path("kick.bvh")));
}

TEST_F(PipelineTest, EvaluationsReportTheirProtocol) {
  const auto retrieval = run_json(with_model({"evaluate", "retrieval"}));
  EXPECT_EQ(retrieval["split_hash"].get<std::string>().size(), 32u);
  EXPECT_EQ(retrieval["protocols"].size(), 5u);
  for (const auto& protocol : retrieval["protocols"]) {
    EXPECT_FALSE(protocol["definition"].get<std::string>().empty());
    const auto& figures = protocol["all"]["text_to_motion"];
    EXPECT_LE(figures["intervals"]["R@1"][0].get<double>(), figures["R@1"].get<double>());
  }
  const auto chosen =
      run_json(with_model({"evaluate", "retrieval", "--protocol", "all,small-batch"}));
  EXPECT_EQ(chosen["protocols"].size(), 2u);
  const ProgramResult unknown =
      run_program(with_model({"evaluate", "retrieval", "--protocol", "best"}));
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.errors.find("small-batch"), std::string::npos);
  const auto calibration =
      run_json(with_model({"evaluate", "calibration", "--plot", path("calibration.png")}));
  EXPECT_GE(calibration["calibration"]["pairs"].get<int>(), 10);
  EXPECT_EQ(read_file(path("calibration.png")).substr(1, 3), "PNG");
  const auto moments = run_json(with_model({"evaluate", "moments", "--tasks", "3"}));
  EXPECT_GT(moments["alone"]["mean_iou"].get<double>(), 0);
  const auto queries = run_json(with_model({"evaluate", "queries", "--resamples", "0"}));
  EXPECT_EQ(queries["forms"][1]["overlap"], 100);  // upper case changes nothing
  const auto tokenizer = run_json(with_model({"evaluate", "tokenizer"}));
  EXPECT_GT(tokenizer["all_levels"]["mpjpe"].get<double>(), 0);
}

TEST_F(PipelineTest, TheShippedEvaluatorJudgesMotions) {
  const auto quality = run_json(
      {"evaluate", "evaluator", "--db", path("motions.sqlite"), "--batch", "4", "--draws", "2"});
  // Procedural motions are in its training data; chance is 3 of 4.
  EXPECT_GT(quality["subsets"][0]["captions"]["r_precision"][2]["mean"].get<double>(), 0.85);
  EXPECT_GT(quality["sides"]["train"]["hands"]["asked"].get<int>(), 0);
  const std::string shipped = quality["model"];
  const auto tokenizer = run_json(with_model({"evaluate", "tokenizer", "--evaluator", shipped}));
  EXPECT_GT(tokenizer["fid"]["all_levels"].get<double>(), 0);
  const std::vector<std::string> generate =
      with_model({"evaluate", "generation", "--prompts", "4", "--modality-prompts", "1",
                  "--results", path("outcomes.jsonl")});
  const auto generation = run_json(generate);
  const auto& all = generation["subsets"][0];
  EXPECT_EQ(all["prompts"], 4);
  EXPECT_EQ(all["generated"]["physical"]["not_finite"], 0);
  EXPECT_GT(all["generated"]["captions"]["fid"]["mean"].get<double>(), 0);
  EXPECT_GT(generation["multimodality"]["mean"].get<double>(), 0);
  const ProgramResult table = run_program(generate);  // nothing is generated again
  EXPECT_EQ(table.exit_code, 0) << table.errors;
  EXPECT_NE(table.output.find("MultiModality"), std::string::npos);
}

TEST_F(PipelineTest, AnEvaluatorIsTrained) {
  const ProgramResult trained =
      run_program({"--quiet", "train", "evaluator", "--db", path("motions.sqlite"), "--preset",
                   "tiny", "--steps", "20", "-o", path("judge")});
  ASSERT_EQ(trained.exit_code, 0) << trained.errors;
  EXPECT_FALSE(fs::exists(path("judge/evaluator.safetensors.checkpoint")));
  EXPECT_FALSE(fs::exists(path("judge/evaluator.safetensors.checkpoint.movement")));
  const auto quality =
      run_json({"evaluate", "evaluator", "--db", path("motions.sqlite"), "--evaluator",
                path("judge/evaluator.safetensors"), "--batch", "4", "--draws", "2"});
  EXPECT_GT(quality["subsets"][0]["captions"]["r_precision"][2]["mean"].get<double>(), 0);
}

TEST_F(PipelineTest, AnIndexFollowsItsDatabase) {
  fs::copy_file(path("motions.sqlite"), path("copy.sqlite"));
  fs::copy_file(path("motions.sqlite.index"), path("copy.sqlite.index"));
  const std::vector<std::string> search = {
      "search", "walk", "--db", path("copy.sqlite"), "--model", path("run/model.safetensors")};
  const std::vector<std::string> index = {"index", path("copy.sqlite"), "--model",
                                          path("run/model.safetensors")};
  EXPECT_EQ(run_json(search)["clips_without_vectors"], 0);
  run_json({"procedural", "--db", path("copy.sqlite"), "--count", "3", "--seed", "9"});
  EXPECT_EQ(run_json(search)["clips_without_vectors"], 3);
  const ProgramResult told = run_program(search);
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_NE(told.errors.find("vectors are missing: 3 clips"), std::string::npos) << told.errors;
  EXPECT_NE(told.errors.find("remomask index"), std::string::npos) << told.errors;

  const auto added = run_json(index);
  EXPECT_EQ(added["embedded"], 3);
  EXPECT_EQ(added["added"], 3);
  EXPECT_EQ(added["dropped"], 0);
  EXPECT_EQ(run_json(search)["clips_without_vectors"], 0);
  const auto unchanged = run_json(index);
  EXPECT_EQ(unchanged["embedded"], 0);
  EXPECT_TRUE(unchanged["rebuilt"].is_null());
  auto rebuild = index;
  rebuild.insert(rebuild.end(), {"--rebuild", "--factory", "IVF2,Flat"});
  const auto rebuilt = run_json(rebuild);
  EXPECT_EQ(rebuilt["factory"], "IVF2,Flat");
  EXPECT_GT(rebuilt["recall_at_10"].get<double>(), 0);
  EXPECT_EQ(rebuilt["clips"], added["clips"]);
}

TEST_F(PipelineTest, ModelOfAnotherPresetIsRefused) {
  const ProgramResult result =
      run_program({"--quiet", "train", "masked", "--db", path("motions.sqlite"), "--preset", "tiny",
                   "-o", path("nothing")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("tokenizer.safetensors"), std::string::npos) << result.errors;
  const ProgramResult missing = run_program(
      with_model({"generate", "walk", "-o", path("x.bvh"), "--index", path("none.index")}));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.errors.find("none.index"), std::string::npos);
  EXPECT_FALSE(fs::exists(path("x.bvh")));
}

TEST_F(PipelineTest, ExtremePromptsWork) {
  std::string endless;
  while (endless.size() < 10000) endless += "a person walks and waves ";
  const ProgramResult result =
      run_program(with_model({"generate", endless, "--seconds", "2", "-o", path("long.bvh")}));
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.errors.find("warning"), std::string::npos);
  EXPECT_EQ(run_program(with_model({"generate", "", "-o", path("e.bvh")})).exit_code, 1);
}

}  // namespace
}  // namespace remomask
