#include "encoders/sentence_encoder.h"

#include <torch/utils.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "base/hash.h"
#include "base/json.h"
#include "encoders/bert_encoder.h"
#include "nn/tensor_values.h"
#include "remomask/error.h"

namespace remomask::encoders {

namespace {

constexpr size_t kTextsAtOnce = 64;
constexpr size_t kTokensAtOnce = 4096;  // with padding: bounds the memory of long texts
constexpr double kShortestVector = 1e-12;

/// Puts texts of like length together and gives each batch to `encode`: the numbers of its texts
/// and its tokens.
void for_each_batch(
    const BertEncoder& encoder, const std::vector<text::BertTokens>& texts,
    const std::function<void(const std::vector<size_t>&, const TokenBatch&)>& encode) {
  std::vector<size_t> order(texts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return texts[a].ids.size() > texts[b].ids.size(); });
  for (size_t first = 0; first < order.size();) {
    const size_t fitting = std::max<size_t>(1, kTokensAtOnce / texts[order[first]].ids.size());
    const size_t last = std::min(order.size(), first + std::min(kTextsAtOnce, fitting));
    const std::vector<size_t> chosen(order.begin() + static_cast<std::ptrdiff_t>(first),
                                     order.begin() + static_cast<std::ptrdiff_t>(last));
    std::vector<const text::BertTokens*> tokens;
    for (const size_t i : chosen) tokens.push_back(&texts[i]);
    encode(chosen, encoder.batch(tokens));
    first = last;
  }
}

std::vector<text::BertTokens> read_texts(const BertEncoder& encoder,
                                         const std::vector<std::string>& texts) {
  std::vector<text::BertTokens> result;
  result.reserve(texts.size());
  for (const std::string& text : texts) result.push_back(encoder.read(text));
  return result;
}

at::Tensor unit_rows(const at::Tensor& rows) {
  return rows / rows.norm(2, -1, /*keepdim=*/true).clamp_min(kShortestVector);
}

}  // namespace

struct SentenceEncoder::Impl {
  std::shared_ptr<BertEncoder> plain;
  std::shared_ptr<BertEncoder> adapted;  ///< `plain` itself without an adapter
  std::string tower_hash, hash;
};

SentenceEncoder::SentenceEncoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SentenceEncoder::~SentenceEncoder() = default;
SentenceEncoder::SentenceEncoder(SentenceEncoder&&) noexcept = default;
SentenceEncoder& SentenceEncoder::operator=(SentenceEncoder&&) noexcept = default;

SentenceEncoder SentenceEncoder::open(const std::string& path) {
  return of_stages(nn::load_model(path), path);
}

SentenceEncoder SentenceEncoder::of_stages(const std::map<std::string, nn::ModelStage>& stages,
                                           const std::string& origin) {
  const nn::ModelStage base = nn::require_stage(stages, kTextEncoderStage, origin);
  auto impl = std::make_unique<Impl>();
  try {
    const BertConfig config = read_bert_config(base.config);
    impl->plain = std::make_shared<BertEncoder>(config, base.tensors, "text encoder");
    impl->tower_hash = impl->hash = nn::stage_hash(base);
    impl->adapted = impl->plain;
    const auto adapter = stages.find(kAdapterStage);
    if (adapter != stages.end()) {
      impl->adapted = impl->plain->merged(
          *read_adapter(adapter->second, impl->hash, bert_linear_layers(config)));
      impl->hash = content_hash(impl->hash + nn::stage_hash(adapter->second));
    }
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(origin, 0, error.what());
  }
  impl->plain->eval();
  impl->adapted->eval();
  return SentenceEncoder(std::move(impl));
}

std::vector<std::vector<float>> SentenceEncoder::embed(
    const std::vector<std::string>& texts) const {
  at::NoGradGuard no_grad;
  std::vector<std::vector<float>> result(texts.size());
  for_each_batch(*impl_->adapted, read_texts(*impl_->adapted, texts),
                 [&](const std::vector<size_t>& chosen, const TokenBatch& tokens) {
                   const at::Tensor vectors =
                       unit_rows(impl_->adapted->encode(tokens.ids, tokens.mask).pooled);
                   for (size_t i = 0; i < chosen.size(); ++i) {
                     result[chosen[i]] = nn::float_vector(vectors[static_cast<int64_t>(i)]);
                   }
                 });
  return result;
}

std::vector<WordState> SentenceEncoder::words(const std::string& text) const {
  return std::move(words(std::vector<std::string>{text}).front());
}

std::vector<std::vector<WordState>> SentenceEncoder::words(
    const std::vector<std::string>& texts) const {
  at::NoGradGuard no_grad;
  const std::vector<text::BertTokens> read = read_texts(*impl_->plain, texts);
  std::vector<std::vector<WordState>> result(texts.size());
  for_each_batch(*impl_->plain, read,
                 [&](const std::vector<size_t>& chosen, const TokenBatch& tokens) {
                   const at::Tensor states = impl_->plain->encode(tokens.ids, tokens.mask).states;
                   for (size_t i = 0; i < chosen.size(); ++i) {
                     const std::string& text = texts[chosen[i]];
                     for (const text::WordSpan& word : read[chosen[i]].words) {
                       const at::Tensor pieces = states[static_cast<int64_t>(i)].narrow(
                           0, static_cast<int64_t>(word.first), static_cast<int64_t>(word.count));
                       result[chosen[i]].push_back({text.substr(word.begin, word.end - word.begin),
                                                    word.normal, word.known,
                                                    nn::float_vector(unit_rows(pieces.mean(0)))});
                     }
                   }
                 });
  return result;
}

bool SentenceEncoder::is_word(const std::string& word) const {
  return impl_->plain->wordpiece().has_word(word);
}

int64_t SentenceEncoder::width() const { return impl_->plain->width(); }
int64_t SentenceEncoder::max_tokens() const { return impl_->plain->max_tokens(); }
bool SentenceEncoder::has_adapter() const { return impl_->adapted != impl_->plain; }
const std::string& SentenceEncoder::hash() const { return impl_->hash; }
std::shared_ptr<TextTower> SentenceEncoder::tower() const { return impl_->plain; }
const std::string& SentenceEncoder::tower_hash() const { return impl_->tower_hash; }

}  // namespace remomask::encoders
