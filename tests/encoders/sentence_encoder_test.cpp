// The shipped sentence encoder against vectors that its authors' weights give in full precision.
#include "encoders/sentence_encoder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/json.h"
#include "encoders/bert_encoder.h"
#include "encoders/bert_import.h"
#include "nn/model_file.h"
#include "remomask/error.h"
#include "tests/base/test_folder.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

const std::string kTextFile = REMOMASK_SOURCE_DIR "/models/text.safetensors";

struct GoldenText {
  std::string text;
  std::vector<int64_t> ids;
  std::vector<float> embedding;
};

std::vector<GoldenText> golden_texts() {
  std::ifstream file(REMOMASK_SOURCE_DIR "/tests/data/minilm_golden.jsonl");
  std::vector<GoldenText> texts;
  for (std::string line; std::getline(file, line);) {
    const nlohmann::json json = parse_json(line);
    texts.push_back({json.at("text"), json.at("ids"), json.at("embedding")});
  }
  return texts;
}

double dot(const std::vector<float>& left, const std::vector<float>& right) {
  return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

TEST(SentenceEncoder, EveryGoldenTextHasItsIdsAndItsVector) {
  const auto texts = golden_texts();
  ASSERT_EQ(texts.size(), 39u);
  const nn::ModelStage stage = nn::load_stage(kTextFile, encoders::kTextEncoderStage);
  const encoders::BertConfig config = encoders::read_bert_config(stage.config);
  encoders::BertEncoder encoder(config, stage.tensors, "golden");
  encoder.eval();
  const auto shipped = encoders::SentenceEncoder::open(kTextFile);
  ASSERT_FALSE(shipped.has_adapter());
  std::vector<std::string> all;
  for (const GoldenText& one : texts) {
    EXPECT_EQ(encoder.read(one.text).ids, one.ids) << one.text;
    all.push_back(one.text);
  }
  const auto vectors = shipped.embed(all);
  for (size_t i = 0; i < texts.size(); ++i) {
    EXPECT_GE(dot(vectors[i], texts[i].embedding), 0.99999) << texts[i].text;
    EXPECT_NEAR(dot(vectors[i], vectors[i]), 1, 1e-5);
    // Alone as in the batch.
    EXPECT_GE(dot(shipped.embed({all[i]}).front(), vectors[i]), 0.999999) << texts[i].text;
  }
}

TEST(SentenceEncoder, WordsAreReadInTheirSentence) {
  const auto encoder = encoders::SentenceEncoder::open(kTextFile);
  const auto words = encoder.words("He does Push-ups, doesn't he?");
  std::vector<std::string> typed;
  for (const auto& word : words) {
    typed.push_back(word.typed);
    EXPECT_NEAR(dot(word.state, word.state), 1, 1e-5) << word.typed;
  }
  EXPECT_EQ(typed, (std::vector<std::string>{"He", "does", "Push-ups", "doesn't", "he"}));
  EXPECT_EQ(words[2].normal, "push-ups");
  const auto state = [&](const char* sentence, size_t number) {
    return encoder.words(sentence).at(number).state;
  };
  // Like words in like sentences are near each other, others are not.
  EXPECT_GT(dot(state("she strolls", 1), state("a person walks", 2)), 0.6);
  EXPECT_LT(dot(state("he plays the violin", 3), state("a person walks", 2)), 0.5);
  EXPECT_TRUE(encoder.is_word("violin"));
  EXPECT_FALSE(encoder.is_word("waks"));
  EXPECT_TRUE(encoder.words("").empty());
}

TEST(SentenceEncoder, AlienAndDamagedFilesAreRefused) {
  const TestFolder folder;
  EXPECT_THROW(encoders::SentenceEncoder::open(folder / "none"), Error);
  EXPECT_THROW(encoders::SentenceEncoder::open(REMOMASK_SOURCE_DIR "/models/base.safetensors"),
               Error);
  const std::string cut = folder / "cut.safetensors";
  fs::copy_file(kTextFile, cut);
  fs::permissions(cut, fs::perms::owner_write, fs::perm_options::add);
  fs::resize_file(cut, fs::file_size(cut) / 2);
  EXPECT_THROW(encoders::SentenceEncoder::open(cut), Error);
}

/// A folder as encoders are published, with random weights of small sizes.
class BertImport : public ::testing::Test {
 protected:
  void SetUp() override {
    write("config.json",
          R"({"model_type": "bert", "hidden_act": "gelu", "hidden_size": 8,
             "num_hidden_layers": 1, "num_attention_heads": 2, "intermediate_size": 16,
             "max_position_embeddings": 16, "vocab_size": 7, "layer_norm_eps": 1e-12})");
    write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\n[MASK]\nwalk\n##s\n");
    encoders::BertConfig config;
    config.width = 8;
    config.layers = 1;
    config.heads = 2;
    config.hidden = 16;
    config.positions = config.max_tokens = 16;
    config.vocabulary = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]", "walk", "##s"};
    own_ = encoders::random_bert_weights(config);
    save(own_);
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  /// Under the names of the published weights, with a head of the pretraining beside them.
  void save(const nn::TensorMap& weights) {
    static const std::map<std::string, std::string> names = {
        {"words", "embeddings.word_embeddings.weight"},
        {"positions", "embeddings.position_embeddings.weight"},
        {"type", "embeddings.token_type_embeddings.weight"},
        {"norm.", "embeddings.LayerNorm."},
        {"block0.query", "encoder.layer.0.attention.self.query"},
        {"block0.key", "encoder.layer.0.attention.self.key"},
        {"block0.value", "encoder.layer.0.attention.self.value"},
        {"block0.attention_output", "encoder.layer.0.attention.output.dense"},
        {"block0.attention_norm", "encoder.layer.0.attention.output.LayerNorm"},
        {"block0.expand", "encoder.layer.0.intermediate.dense"},
        {"block0.contract", "encoder.layer.0.output.dense"},
        {"block0.output_norm", "encoder.layer.0.output.LayerNorm"}};
    nn::TensorMap published;
    for (const auto& [own, value] : weights) {
      for (const auto& [from, to] : names) {
        if (own.starts_with(from)) published["bert." + to + own.substr(from.size())] = value;
      }
    }
    published["cls.predictions.bias"] = torch::zeros({7});
    nn::save_safetensors(folder_ / "model.safetensors", published, {});
  }
  std::string refusal() {
    try {
      encoders::import_bert(folder_ / "");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TestFolder folder_;
  nn::TensorMap own_;
};

TEST_F(BertImport, ReadsThePublishedLayout) {
  const nn::ModelStage stage = encoders::import_bert(folder_ / "");
  EXPECT_EQ(stage.tensors.size(), own_.size());
  nn::save_model(folder_ / "text.safetensors", {stage});
  const auto encoder = encoders::SentenceEncoder::open(folder_ / "text.safetensors");
  EXPECT_EQ(encoder.width(), 8);
  EXPECT_EQ(encoder.embed({"walks"}).front().size(), 8u);
}

TEST_F(BertImport, NamesWhatIsWrong) {
  write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\n[MASK]\nwalk\n");
  EXPECT_NE(refusal().find("vocab_size"), std::string::npos) << refusal();
  write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\n[MASK]\nwalk\n\xff\xfe\n");
  EXPECT_NE(refusal().find("vocab.txt"), std::string::npos) << refusal();
  write("vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\n[MASK]\nwalk\n##s\n");
  EXPECT_EQ(refusal(), "");
  nn::TensorMap lacking = own_;
  lacking.erase("block0.query.weight");
  save(lacking);
  EXPECT_NE(refusal().find("attention.self.query"), std::string::npos) << refusal();
  nn::TensorMap wrong = own_;
  wrong["block0.query.weight"] = torch::zeros({8, 9});
  save(wrong);
  EXPECT_NE(refusal().find("attention.self.query"), std::string::npos) << refusal();
  save(own_);
  write("config.json", R"({"model_type": "roberta"})");
  EXPECT_NE(refusal().find("model_type"), std::string::npos) << refusal();
  fs::remove(folder_ / "config.json");
  EXPECT_NE(refusal().find("config.json"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace remomask
