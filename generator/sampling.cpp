#include "generator/sampling.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "remomask/error.h"

namespace remomask::generator {

namespace {

void check_stop(const Monitor& monitor) {
  if (monitor.stop_requested()) throw Interrupted("the generation was stopped");
}

// Streams of one sample's seed; passes of the masked transformer come first.
constexpr uint64_t kScoreStream = 1u << 20, kResidualStream = 2u << 20;

double gumbel_noise(const CounterRandom& random, uint64_t counter) {
  return -std::log(-std::log(random.uniform_at(counter)));
}

/// [condition, the same without text and retrieval]; one row when w is 1.
Condition guidance_pair(const Condition& condition, double guidance) {
  if (guidance == 1) return condition;
  Condition without = condition;
  without.use_text = torch::zeros_like(condition.use_text);
  without.use_retrieval = torch::zeros_like(condition.use_retrieval);
  return concatenate_conditions(condition, without);
}

/// Logits of a pair -> guided logits [n, codes], contiguous on the CPU.
at::Tensor guided_logits(const at::Tensor& logits, double guidance) {
  const auto result =
      logits.size(0) == 1 ? logits[0] : logits[1] + guidance * (logits[0] - logits[1]);
  return result.to(torch::kCPU).contiguous();
}

int64_t kept_codes(double share, int64_t codes) {
  return std::clamp<int64_t>(
      static_cast<int64_t>(std::ceil(share * static_cast<double>(codes) - 1e-9)), 1, codes);
}

/// Checks `known` against the size of the map; all cells are free without it.
std::vector<int64_t> free_cells(const std::optional<KnownTokens>& known, int64_t count) {
  std::vector<int64_t> cells;
  const auto mask = known ? known->known.to(torch::kCPU).contiguous() : at::Tensor();
  if (known && mask.numel() != count) {
    throw Error("sampling: the known cells have " + std::to_string(mask.numel()) +
                " entries, the map has " + std::to_string(count));
  }
  for (int64_t cell = 0; cell < count; ++cell) {
    if (!known || !mask.data_ptr<bool>()[cell]) cells.push_back(cell);
  }
  return cells;
}

struct BaseSampler {
  MaskedTransformer& model;
  const SamplingOptions& options;
  std::vector<ConditionCache> caches;
  int64_t frames, rows, codes, pair;
  uint64_t seed;
  at::Tensor tokens;                // [T * rows]
  std::vector<double> confidences;  // log-probability of what was sampled

  /// One pass: masks `cells`, then draws a code and a confidence for each.
  void draw(const std::vector<int64_t>& cells, uint64_t stream) {
    int64_t* ids = tokens.data_ptr<int64_t>();
    for (const int64_t cell : cells) ids[cell] = model->mask_token();
    const auto logits = model->forward(
        tokens.reshape({1, frames, rows}).expand({pair, frames, rows}).to(device()), caches);
    const auto guided = guided_logits(logits, options.guidance);
    // Guided logits are nearly 0 or 1 after softmax: confidence is judged without guidance.
    const auto log_probability = torch::log_softmax(logits[0].to(torch::kCPU), 1).contiguous();
    const CounterRandom random(seed, stream);
    const int64_t kept = kept_codes(options.top_share, codes);
    for (const int64_t cell : cells) {
      ids[cell] = sample_code(guided.data_ptr<float>() + cell * codes, codes, kept,
                              options.temperature, random, static_cast<uint64_t>(cell * codes));
      confidences[static_cast<size_t>(cell)] =
          log_probability.data_ptr<float>()[cell * codes + ids[cell]];
    }
  }

  /// The `count` cells of the lowest confidence, in the order of the map.
  std::vector<int64_t> least_confident(std::vector<int64_t> cells, int64_t count, double noise,
                                       uint64_t stream) const {
    const CounterRandom random(seed, stream);
    std::vector<std::pair<double, int64_t>> scored;
    for (const int64_t cell : cells) {
      double score = confidences[static_cast<size_t>(cell)];
      if (noise > 0) score += noise * gumbel_noise(random, static_cast<uint64_t>(cell));
      scored.emplace_back(score, cell);
    }
    std::sort(scored.begin(), scored.end());
    cells.clear();
    for (int64_t i = 0; i < count; ++i) cells.push_back(scored[static_cast<size_t>(i)].second);
    std::sort(cells.begin(), cells.end());
    return cells;
  }

  c10::Device device() const { return caches.front().keys.device(); }
};

}  // namespace

int64_t sample_code(const float* logits, int64_t count, int64_t kept, double temperature,
                    const CounterRandom& random, uint64_t first_counter) {
  std::vector<int64_t> order(static_cast<size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  const auto larger = [&](int64_t a, int64_t b) {
    return logits[a] != logits[b] ? logits[a] > logits[b] : a < b;
  };
  std::nth_element(order.begin(), order.begin() + (kept - 1), order.end(), larger);
  if (temperature <= 0) return *std::min_element(order.begin(), order.begin() + kept, larger);
  int64_t best = -1;
  double best_score = -std::numeric_limits<double>::infinity();
  for (int64_t i = 0; i < kept; ++i) {
    const int64_t code = order[static_cast<size_t>(i)];
    const double score = static_cast<double>(logits[code]) / temperature +
                         gumbel_noise(random, first_counter + static_cast<uint64_t>(code));
    if (score > best_score || (score == best_score && code < best)) {
      best = code;
      best_score = score;
    }
  }
  return best;
}

std::vector<int64_t> masked_counts(int64_t count, int steps) {
  std::vector<int64_t> counts;
  for (int i = 0; i < steps && (i == 0 || counts.back() > 1); ++i) {
    const double ratio = std::cos(std::numbers::pi / 2 * i / steps);
    int64_t masked = std::llround(ratio * static_cast<double>(count));
    if (i > 0) masked = std::min(masked, counts.back() - 1);
    counts.push_back(std::max<int64_t>(1, masked));
  }
  return counts;
}

at::Tensor sample_base(MaskedTransformer model, const Condition& condition, int64_t frames,
                       uint64_t seed, const SamplingOptions& options,
                       const std::optional<KnownTokens>& known, const Monitor& monitor) {
  const torch::NoGradGuard no_grad;
  model->eval();
  const MaskedConfig& config = model->config();
  if (!config.drops_conditions && options.guidance != 1) {
    throw Error(
        "this model was trained without dropped conditions, so that there is nothing to guide it "
        "away from; use guidance 1");
  }
  const int64_t count = frames * config.rows;
  std::vector<int64_t> cells = free_cells(known, count);
  BaseSampler sampler{model,
                      options,
                      model->prepare(guidance_pair(condition, options.guidance)),
                      frames,
                      config.rows,
                      config.codes,
                      options.guidance == 1 ? 1 : 2,
                      seed,
                      torch::full({count}, model->mask_token(), torch::kLong),
                      std::vector<double>(static_cast<size_t>(count), 0)};
  if (known) sampler.tokens = known->tokens.to(torch::kCPU).reshape({count}).clone();
  if (cells.empty()) return sampler.tokens.reshape({frames, config.rows});

  const auto counts = masked_counts(static_cast<int64_t>(cells.size()), options.steps);
  std::vector<int64_t> masked = cells;
  for (size_t i = 0; i < counts.size(); ++i) {
    check_stop(monitor);
    sampler.draw(masked, i);
    if (i + 1 < counts.size()) {
      // Cells that were kept once stay: only the newest draws compete.
      const double noise = options.score_noise *
                           (1 - static_cast<double>(i + 1) / static_cast<double>(counts.size()));
      masked = sampler.least_confident(masked, counts[i + 1], noise, kScoreStream + i);
    }
  }
  const auto tenth = std::max<int64_t>(1, static_cast<int64_t>(cells.size()) / 10);
  for (int round = 0; round < options.correction_rounds; ++round) {
    check_stop(monitor);
    const auto weak = sampler.least_confident(cells, tenth, 0, 0);
    sampler.draw(weak, counts.size() + static_cast<size_t>(round));
  }
  return sampler.tokens.reshape({frames, config.rows});
}

at::Tensor sample_residual(ResidualTransformer model, const Condition& condition,
                           const at::Tensor& base, uint64_t seed, const SamplingOptions& options,
                           const std::optional<KnownTokens>& known, const Monitor& monitor) {
  const torch::NoGradGuard no_grad;
  model->eval();
  const ResidualConfig& config = model->config();
  const int64_t frames = base.size(0), rows = config.rows, codes = config.codes;
  const std::vector<int64_t> cells = free_cells(known, frames * rows);
  at::Tensor tokens = torch::zeros({frames, rows, config.levels}, torch::kLong);
  if (known) tokens.copy_(known->tokens);
  tokens.select(2, 0).copy_(base);
  if (cells.empty()) return tokens;

  const double guidance = options.residual_guidance;
  const int64_t pair = guidance == 1 ? 1 : 2;
  const auto caches = model->prepare(guidance_pair(condition, guidance));
  const auto device = caches.front().keys.device();
  const int64_t kept = kept_codes(options.top_share, codes);
  for (int64_t level = 1; level < config.levels; ++level) {
    check_stop(monitor);
    const auto logits = guided_logits(
        model->forward(tokens.unsqueeze(0).expand({pair, frames, rows, config.levels}).to(device),
                       torch::full({pair}, level, torch::kLong), caches),
        guidance);
    const CounterRandom random(seed, kResidualStream + static_cast<uint64_t>(level));
    for (const int64_t cell : cells) {
      tokens.data_ptr<int64_t>()[cell * config.levels + level] =
          sample_code(logits.data_ptr<float>() + cell * codes, codes, kept,
                      options.residual_temperature, random, static_cast<uint64_t>(cell * codes));
    }
  }
  return tokens;
}

}  // namespace remomask::generator
