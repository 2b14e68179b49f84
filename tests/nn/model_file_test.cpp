#include "nn/model_file.h"

#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "nn/safetensors_check.h"
#include "nn/threads.h"
#include "remomask/error.h"

namespace remomask {
namespace {

class ModelFileTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = (std::filesystem::temp_directory_path() /
                             ("remomask_model_" + std::to_string(::getpid()) + ".safetensors"))
                                .string();
  nn::ModelStage stage(const std::string& kind) const {
    return {kind,
            {{"preset", "tiny"}},
            {{"weight", torch::randn({3, 4})},
             {"count", torch::arange(5)},
             {"flag", torch::ones({1}, torch::kBool)}}};
  }
};

TEST_F(ModelFileTest, SaveAndLoadIsExact) {
  const nn::ModelStage a = stage("tokenizer"), b = stage("masked");
  nn::save_model(path_, {a, b});
  const auto loaded = nn::load_model(path_);
  ASSERT_EQ(loaded.size(), 2u);
  EXPECT_TRUE(loaded.at("tokenizer").tensors.at("weight").equal(a.tensors.at("weight")));
  EXPECT_TRUE(loaded.at("masked").tensors.at("count").equal(b.tensors.at("count")));
  EXPECT_EQ(loaded.at("masked").config, b.config);
  EXPECT_EQ(nn::stage_hash(loaded.at("masked")), nn::stage_hash(b));
  EXPECT_NE(nn::stage_hash(a), nn::stage_hash(b));
}

TEST_F(ModelFileTest, HalfPrecisionRoundsOnce) {
  const nn::ModelStage a = stage("tokenizer");
  nn::save_model(path_, {a}, /*half=*/true);
  const nn::ModelStage once = nn::load_stage(path_, "tokenizer");
  EXPECT_EQ(once.tensors.at("weight").scalar_type(), torch::kFloat);
  EXPECT_LT((once.tensors.at("weight") - a.tensors.at("weight")).abs().max().item<float>(), 2e-3);
  nn::save_model(path_, {once}, true);
  EXPECT_EQ(nn::stage_hash(nn::load_stage(path_, "tokenizer")), nn::stage_hash(once));
}

TEST_F(ModelFileTest, MissingStageNamesWhatIsThere) {
  nn::save_model(path_, {stage("tokenizer")});
  try {
    nn::load_stage(path_, "masked");
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("it holds: tokenizer"), std::string::npos);
  }
}

TEST_F(ModelFileTest, StagesAreReadAlone) {
  const nn::ModelStage a = stage("tokenizer"), b = stage("masked"), c = stage("residual");
  nn::save_model(path_, {a, b, c});
  const auto some = nn::load_stages(path_, {"residual", "tokenizer"});
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(nn::stage_hash(some.at("tokenizer")), nn::stage_hash(a));
  EXPECT_EQ(nn::stage_hash(some.at("residual")), nn::stage_hash(c));
  EXPECT_EQ(nn::stage_hash(nn::load_stage(path_, "masked")), nn::stage_hash(b));
  EXPECT_THROW(nn::load_stages(path_, {"masked", "retriever"}), FileError);
  EXPECT_THROW(nn::require_stage(some, "masked", path_), FileError);
}

TEST_F(ModelFileTest, BrokenFilesAreRefused) {
  nn::save_model(path_, {stage("tokenizer")});
  const std::string good = read_file(path_);
  std::string alien(good);
  alien.replace(alien.find("remomask-model"), 14, "another--model");
  std::string newer(good);
  newer.replace(newer.find("\"version\":\"1\""), 13, "\"version\":\"9\"");
  std::string huge_header(good);
  huge_header[6] = '\x7f';
  std::string shape(good);
  shape.replace(shape.find("[3,4]"), 5, "[9,9]");
  const std::vector<std::string> broken = {
      "",          "short", good.substr(0, good.size() - 1), good.substr(0, 40), alien, newer,
      huge_header, shape,   std::string(1000, '\0')};
  for (size_t i = 0; i < broken.size(); ++i) {
    write_file_atomically(path_, broken[i]);
    EXPECT_THROW(nn::load_model(path_), FileError) << "case " << i;
    EXPECT_THROW(nn::load_stage(path_, "tokenizer"), FileError) << "case " << i;
  }
}

TEST_F(ModelFileTest, EveryFlippedBitIsNoticed) {
  nn::save_model(path_, {stage("tokenizer")});
  const std::string good = read_file(path_);
  EXPECT_EQ(nn::check_safetensors(path_).format, "remomask-model");
  for (size_t i = 0; i < good.size() * 8; ++i) {
    std::string flipped(good);
    flipped[i / 8] = static_cast<char>(flipped[i / 8] ^ (1 << (i % 8)));
    write_file_atomically(path_, flipped, Durability::kills);
    EXPECT_THROW(nn::check_safetensors(path_), FileError) << "byte " << i / 8;
    if (i % 8 != i / 8 % 8) continue;
    EXPECT_THROW(nn::load_model(path_), FileError) << "byte " << i / 8;
  }
  write_file_atomically(path_, good + std::string(8, '\0'));
  EXPECT_THROW(nn::load_model(path_), FileError);
}

TEST_F(ModelFileTest, FilesWithoutChecksumsAreReadAndSaySo) {
  const nn::TensorMap tensors = {{"a/x", torch::arange(6).reshape({2, 3})}};
  nn::save_safetensors(path_, tensors, {{"note", "old"}});
  EXPECT_TRUE(nn::load_safetensors(path_).has_checksums);
  const std::string content = read_file(path_);
  uint64_t length = 0;
  std::memcpy(&length, content.data(), sizeof length);
  auto header = nlohmann::json::parse(content.substr(8, length));
  header["__metadata__"].erase("tensor_checksums");
  header["__metadata__"].erase("header_checksum");
  const std::string head = header.dump();
  const uint64_t new_length = head.size();
  std::string old(reinterpret_cast<const char*>(&new_length), sizeof new_length);
  write_file_atomically(path_, old + head + content.substr(8 + length));
  const nn::TensorFile file = nn::load_safetensors(path_);
  EXPECT_FALSE(file.has_checksums);
  EXPECT_EQ(file.metadata.at("note"), "old");
  EXPECT_TRUE(file.tensors.at("a/x").equal(tensors.at("a/x")));
}

TEST_F(ModelFileTest, EveryTensorMustFit) {
  torch::nn::Linear linear(3, 2);
  nn::TensorMap tensors = nn::module_tensors(*linear);
  EXPECT_NO_THROW(nn::load_module_tensors(*linear, tensors, "test"));
  nn::TensorMap missing = tensors;
  missing.erase("bias");
  EXPECT_THROW(nn::load_module_tensors(*linear, missing, "test"), Error);
  nn::TensorMap extra = tensors;
  extra["more"] = torch::ones({1});
  EXPECT_THROW(nn::load_module_tensors(*linear, extra, "test"), Error);
  nn::TensorMap other = tensors;
  other["bias"] = torch::ones({5});
  EXPECT_THROW(nn::load_module_tensors(*linear, other, "test"), Error);
}

TEST(ThreadsTest, NegativeNumbersAreRefused) { EXPECT_THROW(nn::set_compute_threads(-1), Error); }

}  // namespace
}  // namespace remomask
