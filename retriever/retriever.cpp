#include "retriever/retriever.h"

#include <torch/utils.h>

#include "encoders/text_file.h"
#include "remomask/error.h"
#include "retriever/retriever_model.h"

namespace remomask::retriever {

struct Retriever::Impl {
  RetrieverConfig config;
  std::shared_ptr<const encoders::SentenceEncoder> words;
  std::shared_ptr<RetrieverModel> model;
  std::string hash;
};

Retriever::Retriever(const nn::ModelStage& stage,
                     std::shared_ptr<const encoders::SentenceEncoder> words)
    : impl_(std::make_unique<Impl>()) {
  if (stage.kind != "retriever") {
    throw Error("a model stage '" + stage.kind + "' is no retriever; train one first");
  }
  try {
    impl_->config = read_retriever_config(stage.config);
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("the retriever is not described completely: ") + error.what());
  }
  if (impl_->config.text_encoder != words->tower_hash()) {
    throw Error(
        "the retriever was trained over another sentence encoder than the text file holds; put the "
        "text.safetensors that belongs to the model beside it");
  }
  impl_->words = std::move(words);
  impl_->model = std::make_shared<RetrieverModel>(impl_->config, impl_->words->tower());
  nn::load_module_tensors(*impl_->model, stage.tensors, "retriever");
  impl_->model->eval();
  impl_->hash = nn::stage_hash(stage);
}

Retriever::~Retriever() = default;
Retriever::Retriever(Retriever&&) noexcept = default;
Retriever& Retriever::operator=(Retriever&&) noexcept = default;

TextEncoding Retriever::encode_text(const std::vector<std::string>& captions) const {
  at::NoGradGuard no_grad;
  if (captions.empty()) throw Error("there is no caption to encode");
  const encoders::TokenBatch tokens = impl_->model->text_tower().tokenize(captions);
  TextVectors vectors = impl_->model->encode_text(tokens.ids, tokens.mask);
  return {vectors.states, tokens.mask, vectors.query, vectors.parts};
}

MotionEncoding Retriever::encode_motion(const std::vector<const motion::Features*>& clips) const {
  at::NoGradGuard no_grad;
  if (clips.empty()) throw Error("there is no motion to encode");
  std::vector<MotionCrop> crops;
  for (const motion::Features* clip : clips) crops.push_back(whole_clip(*clip));
  MotionEncoder& encoder = impl_->model->motion_encoder();
  MotionVectors vectors = encoder.forward(encoder.patches(crops));
  return {vectors.global, vectors.parts};
}

int64_t Retriever::embedding_width() const { return impl_->config.embedding; }
int64_t Retriever::part_width() const { return impl_->config.part_embedding; }
int64_t Retriever::text_width() const { return impl_->config.text_encoder_width; }
motion::FeatureMode Retriever::feature_mode() const { return impl_->config.mode; }
const std::string& Retriever::hash() const { return impl_->hash; }
const std::shared_ptr<const encoders::SentenceEncoder>& Retriever::words() const {
  return impl_->words;
}

Retriever open_retriever(const std::string& model_path,
                         std::shared_ptr<const encoders::SentenceEncoder> words) {
  const nn::ModelStage stage = nn::load_stage(model_path, "retriever");
  try {
    return {stage, std::move(words)};
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(model_path, 0, error.what());
  }
}

Retriever open_retriever(const std::string& model_path, const std::string& text_path) {
  return open_retriever(
      model_path, std::make_shared<const encoders::SentenceEncoder>(encoders::SentenceEncoder::open(
                      text_path.empty() ? encoders::text_file_of(model_path) : text_path)));
}

}  // namespace remomask::retriever
