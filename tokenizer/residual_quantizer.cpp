#include "tokenizer/residual_quantizer.h"

#include <torch/nn/functional/loss.h>

#include <numeric>

#include "base/random.h"

namespace remomask::tokenizer {

namespace {

constexpr double kInitialNoise = 0.01;  // keeps codes apart when rows are used twice
constexpr uint64_t kDropoutStream = 0x64726f70, kInitStream = 0x696e6974, kResetStream = 0x72657365;

}  // namespace

ResidualQuantizerImpl::ResidualQuantizerImpl(const QuantizerOptions& options) : options_(options) {
  const auto& o = options_;
  codebook_ = register_buffer("codebook", torch::zeros({o.levels, o.groups, o.codes, o.width}));
  sum_ = register_buffer("sum", torch::zeros({o.levels, o.groups, o.codes, o.width}));
  count_ = register_buffer("count", torch::zeros({o.levels, o.groups, o.codes}));
  initialised_ = register_buffer("initialised", torch::zeros({o.levels}, torch::kBool));
}

bool ResidualQuantizerImpl::initialised() const { return initialised_.all().item<bool>(); }

void ResidualQuantizerImpl::set_codebook(int64_t level, const at::Tensor& codes) {
  at::NoGradGuard no_grad;
  codebook_[level].copy_(codes);
  sum_[level].copy_(codes);
  count_[level].fill_(1);
  initialised_[level].fill_(true);
}

at::Tensor ResidualQuantizerImpl::assign(const at::Tensor& residual, int64_t level,
                                         double temperature) const {
  const auto codes = codebook_[level];
  // -(squared distance) without |residual|^2, which all codes share.
  const auto score = torch::baddbmm(codes.square().sum(-1).unsqueeze(1), residual,
                                    codes.transpose(1, 2), -1.0, 2.0);
  if (temperature <= 0) return score.argmax(-1);
  const auto nearest =
      (residual.square().sum(-1) - score.amax(-1)).clamp_min(1e-12).mean(-1).view({-1, 1, 1});
  const auto gumbel = -(-torch::rand_like(score).clamp_min(1e-9).log()).log();
  return (score / (temperature * nearest) + gumbel).argmax(-1);
}

at::Tensor ResidualQuantizerImpl::look_up(const at::Tensor& index, int64_t level) const {
  const auto offset = torch::arange(options_.groups, index.options()).unsqueeze(1) * options_.codes;
  return codebook_[level]
      .reshape({-1, options_.width})
      .index_select(0, (index + offset).flatten())
      .view({index.size(0), index.size(1), options_.width});
}

at::Tensor ResidualQuantizerImpl::random_rows(const at::Tensor& residual, uint64_t seed) const {
  const int64_t rows = residual.size(1);
  std::vector<int64_t> picks;
  for (int64_t group = 0; group < options_.groups; ++group) {
    CounterRandom random(seed, static_cast<uint64_t>(group));
    std::vector<size_t> order = random.permutation(static_cast<size_t>(rows));
    for (int64_t code = 0; code < options_.codes; ++code) {
      picks.push_back(static_cast<int64_t>(order[code % rows]) + group * rows);
    }
  }
  return residual.reshape({-1, options_.width})
      .index_select(0, torch::tensor(picks, torch::kLong).to(residual.device()))
      .view({options_.groups, options_.codes, options_.width});
}

void ResidualQuantizerImpl::initialise_level(int64_t level, const at::Tensor& residual,
                                             uint64_t seed) {
  auto codes = random_rows(residual, seed);
  if (residual.size(1) < options_.codes) {
    codes = codes + torch::randn_like(codes) * (kInitialNoise * residual.std());
  }
  set_codebook(level, codes);
}

double ResidualQuantizerImpl::update_level(int64_t level, const at::Tensor& residual,
                                           const at::Tensor& index, double decay) {
  const int64_t all = options_.groups * options_.codes;
  const auto offset = torch::arange(options_.groups, index.options()).unsqueeze(1) * options_.codes;
  const auto flat = (index + offset).flatten();
  const auto hits =
      torch::bincount(flat, {}, all).to(torch::kFloat).view({options_.groups, options_.codes});
  const auto totals = torch::zeros({all, options_.width}, residual.options())
                          .index_add_(0, flat, residual.reshape({-1, options_.width}))
                          .view({options_.groups, options_.codes, options_.width});
  auto count = count_[level], sum = sum_[level];
  count.mul_(decay).add_(hits, 1 - decay);
  sum.mul_(decay).add_(totals, 1 - decay);
  codebook_[level].copy_(sum / count.clamp_min(1e-6).unsqueeze(-1));
  const auto share = hits / hits.sum(-1, true);
  return (-(share * share.clamp_min(1e-10).log()).sum(-1)).exp().mean().item<double>();
}

void ResidualQuantizerImpl::reset_dead_codes(int64_t level, const at::Tensor& residual,
                                             double dead_share, uint64_t seed) {
  auto count = count_[level];
  const auto mean_use = count.mean(-1, true);
  const auto dead = count < dead_share * mean_use;
  if (!dead.any().item<bool>()) return;
  const auto fresh = random_rows(residual, seed);
  const auto wide = dead.unsqueeze(-1);
  // A new code starts with the weight of an average one: with a smaller weight its first
  // few rows would drag it anywhere, with none it would die again.
  const auto weight = mean_use.expand_as(count);
  codebook_[level].copy_(torch::where(wide, fresh, codebook_[level]));
  sum_[level].copy_(torch::where(wide, fresh * weight.unsqueeze(-1), sum_[level]));
  count.copy_(torch::where(dead, weight, count));
}

Quantized ResidualQuantizerImpl::train_step(const at::Tensor& z, const CodebookTraining& training,
                                            uint64_t seed, int64_t step) {
  TORCH_CHECK(z.dim() == 3 && z.size(0) == options_.groups && z.size(2) == options_.width,
              "quantizer input must be [groups, N, width]");
  const auto step_number = static_cast<uint64_t>(step);
  CounterRandom dropout(mix_seed(seed, kDropoutStream), step_number);
  int64_t active = options_.levels;
  // Before all levels are initialised none may be dropped.
  if (initialised() && dropout.uniform() < training.level_dropout) {
    active = 1 + static_cast<int64_t>(dropout.below(static_cast<size_t>(options_.levels)));
  }
  const bool reset = training.reset_every > 0 && step > 0 && step % training.reset_every == 0;
  Quantized result;
  result.commitment = torch::zeros({}, z.options());
  at::Tensor total = torch::zeros_like(z);
  for (int64_t level = 0; level < active; ++level) {
    const auto target = z - total;  // gradient to z only; codes carry none
    at::Tensor code;
    {
      at::NoGradGuard no_grad;
      const auto residual = target.detach();
      const uint64_t level_seed = static_cast<uint64_t>(level);
      if (!initialised_[level].item<bool>()) {
        initialise_level(level, residual, mix_seed(seed, kInitStream, level_seed));
      }
      const auto index = assign(residual, level, training.sample_temperature);
      code = look_up(index, level);
      result.perplexity.push_back(update_level(level, residual, index, training.decay));
      if (reset) {
        reset_dead_codes(level, residual, training.dead_share,
                         mix_seed(seed, kResetStream + level_seed, step_number));
      }
    }
    result.commitment = result.commitment + torch::mse_loss(target, code);
    total = total + code;
  }
  result.commitment = result.commitment / static_cast<double>(active);
  result.value = z + (total - z).detach();
  return result;
}

at::Tensor ResidualQuantizerImpl::encode(const at::Tensor& z) const {
  at::NoGradGuard no_grad;
  auto residual = z.contiguous();
  std::vector<at::Tensor> indices;
  for (int64_t level = 0; level < options_.levels; ++level) {
    indices.push_back(assign(residual, level, 0));
    residual = residual - look_up(indices.back(), level);
  }
  return torch::stack(indices, -1);
}

at::Tensor ResidualQuantizerImpl::decode(const at::Tensor& indices) const {
  at::NoGradGuard no_grad;
  at::Tensor total = look_up(indices.select(-1, 0), 0);
  for (int64_t level = 1; level < indices.size(-1); ++level) {
    total = total + look_up(indices.select(-1, level), level);
  }
  return total;
}

}  // namespace remomask::tokenizer
