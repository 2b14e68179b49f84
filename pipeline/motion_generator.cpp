#include "pipeline/motion_generator.h"

#include <fmt/format.h>
#include <torch/types.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/time.h"
#include "generator/token_windows.h"
#include "motion/features.h"
#include "nn/tensor_values.h"
#include "nn/threads.h"
#include "pipeline/draft.h"
#include "pipeline/motion_finish.h"
#include "pipeline/stage_gate.h"
#include "remomask/error.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::pipeline {

namespace {

// Frames. Tokens of neighbouring patches do not quite fit: without it the jerk of
// generated motions is more than twice that of real ones.
constexpr double kDecodeSmoothing = 0.8;

// Token frames beside known motion that follow nothing: the seam is the transformer's.
constexpr int64_t kSeamFrames = 2;

constexpr double kDefaultSeconds = 5;

void need_equal(int64_t a, int64_t b, const std::string& what) {
  if (a != b) {
    throw Error("the stages of this model do not fit together: " + what + " is " +
                std::to_string(a) + " in one and " + std::to_string(b) + " in another");
  }
}

class Stopwatch {
 public:
  /// Seconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void copy_vector(const std::vector<float>& values, const at::Tensor& out, int64_t clip_id) {
  if (static_cast<int64_t>(values.size()) != out.size(0)) {
    throw Error("clip " + std::to_string(clip_id) + " has a vector of width " +
                std::to_string(values.size()) + ", the model's retriever makes " +
                std::to_string(out.size(0)) + ": embed the database with this model first");
  }
  std::copy(values.begin(), values.end(), out.data_ptr<float>());
}

}  // namespace

struct Generator::Impl {
  std::shared_ptr<const retriever::Retriever> retriever;
  tokenizer::Tokenizer tokenizer;
  generator::MaskedTransformer masked;
  generator::ResidualTransformer residual{nullptr};
  const Skeleton& skeleton;
  std::optional<EvidenceGate> gate;  // none: every hit is trusted in full

  Impl(std::shared_ptr<const retriever::Retriever> shared,
       const std::map<std::string, nn::ModelStage>& stages)
      : retriever(std::move(shared)),
        tokenizer(nn::require_stage(stages, "tokenizer", "the model")),
        masked(generator::load_masked(nn::require_stage(stages, "masked", "the model"))),
        skeleton(skeleton_named(tokenizer.config().skeleton)) {
    gate = stage_gate(nn::require_stage(stages, "masked", "the model"));
    const tokenizer::TokenizerConfig& tokens = tokenizer.config();
    const generator::MaskedConfig& base = masked->config();
    need_equal(base.rows, tokens.rows, "the number of rows");
    need_equal(base.codes, tokens.codes, "the number of codes");
    need_equal(base.embedding_width, retriever->embedding_width(), "the width of the shared space");
    need_equal(base.text_width, retriever->text_width(), "the width of the text states");
    if (tokens.levels == 1) return;
    residual = generator::load_residual(nn::require_stage(stages, "residual", "the model"));
    const generator::ResidualConfig& upper = residual->config();
    need_equal(upper.rows, tokens.rows, "the number of rows");
    need_equal(upper.codes, tokens.codes, "the number of codes");
    need_equal(upper.levels, tokens.levels, "the number of levels");
    need_equal(upper.embedding_width, retriever->embedding_width(),
               "the width of the shared space");
    need_equal(upper.text_width, retriever->text_width(), "the width of the text states");
  }

  /// All levels of a motion, int64 [frames / 4, rows, levels].
  at::Tensor encode(const Motion& motion) const {
    const motion::FeatureMode mode = motion::parse_feature_mode(tokenizer.config().feature_mode);
    return tokenizer.encode(motion::extract_features_all_frames(motion, skeleton, mode));
  }

  /// Base tokens of the best hits [1, s, T, rows], -1 where no frame is.
  at::Tensor hit_tokens(const std::vector<RetrievedMotion>& hits) const {
    const auto count =
        std::min<int64_t>(masked->config().sequence_hits, static_cast<int64_t>(hits.size()));
    std::vector<at::Tensor> maps;
    int64_t longest = 0;
    for (int64_t i = 0; i < count; ++i) {
      const auto& poses = hits[static_cast<size_t>(i)].poses;
      at::Tensor map = torch::empty({0, tokenizer.config().rows}, torch::kLong);
      if (poses && poses->frames >= kFramesPerToken) {
        map = encode(*poses).select(2, 0).slice(0, 0, kMaxTokenFrames);
      }
      longest = std::max(longest, map.size(0));
      maps.push_back(map);
    }
    const auto tokens = torch::full({1, count, longest, tokenizer.config().rows}, -1, torch::kLong);
    for (int64_t i = 0; i < count; ++i) {
      const at::Tensor& map = maps[static_cast<size_t>(i)];
      tokens[0][i].slice(0, 0, map.size(0)).copy_(map);
    }
    return tokens;
  }

  generator::Condition condition(const std::string& prompt,
                                 const std::vector<RetrievedMotion>& hits) const {
    const retriever::TextEncoding text = retriever->encode_text({prompt});
    const auto count = static_cast<int64_t>(hits.size());
    generator::Condition result;
    result.text_states = text.states;
    result.text_mask = text.mask;
    result.text_query = text.query;
    result.hit_motion = torch::zeros({1, count, retriever->embedding_width()});
    result.hit_text = torch::zeros_like(result.hit_motion);
    result.hit_similarity = torch::zeros({1, count});
    for (int64_t i = 0; i < count; ++i) {
      const RetrievedMotion& hit = hits[static_cast<size_t>(i)];
      copy_vector(hit.motion, result.hit_motion[0][i], hit.clip_id);
      copy_vector(hit.text, result.hit_text[0][i], hit.clip_id);
      result.hit_similarity.data_ptr<float>()[i] = static_cast<float>(hit.similarity);
    }
    result.hit_mask = torch::ones({1, count}, torch::kBool);
    result.hit_tokens = hit_tokens(hits);
    result.use_text = torch::full({1}, !prompt.empty(), torch::kBool);
    result.use_retrieval = torch::full({1}, count > 0, torch::kBool);
    return result;
  }

  double trust(const RetrievedMotion& hit) const {
    if (hit.probability) return kProbabilityGate.trust(*hit.probability);
    return gate ? gate->trust(hit.similarity, hit.caption_similarity) : 1;
  }

  /// The hit that a stretch of `frames` token frames follows, and how far.
  std::optional<FollowedHit> choose_followed(const std::vector<RetrievedMotion>& hits,
                                             int64_t frames, const GenerateOptions& options,
                                             const RetrievedMotion** hit) const {
    std::vector<DraftCandidate> candidates;
    for (const RetrievedMotion& found : hits) {
      candidates.push_back(
          {found.probability.value_or(found.similarity), found.poses ? found.poses->frames : 0});
    }
    const auto chosen =
        choose_draft(candidates, static_cast<int>(frames * kFramesPerToken), options.seed);
    if (!chosen) return std::nullopt;
    *hit = &hits[*chosen];
    const double share = options.follow * trust(**hit);
    if (share <= 0) return std::nullopt;
    return FollowedHit{(*hit)->clip_id, share};
  }

  /// The codes of `hit` that token frames [first, last) of the canvas are to keep.
  generator::KnownTokens make_draft(const RetrievedMotion& hit, const TokenCanvas& canvas,
                                    int64_t first, int64_t last, double share,
                                    uint64_t seed) const {
    const at::Tensor codes =
        encode(fit_length(*hit.poses, static_cast<int>((last - first) * kFramesPerToken)));
    const int64_t frames = std::min(codes.size(0), last - first);
    const std::vector<bool> followed = followed_frames(frames, share, seed);
    generator::KnownTokens draft{torch::zeros_like(canvas.tokens), torch::zeros_like(canvas.known)};
    draft.tokens.slice(0, first, first + frames).copy_(codes.slice(0, 0, frames));
    for (int64_t t = first; t < first + frames; ++t) {
      const int64_t before = std::max<int64_t>(0, t - kSeamFrames);
      const int64_t behind = std::min(canvas.known.size(0), t + kSeamFrames + 1);
      const bool at_seam = canvas.known.slice(0, before, behind).any().item<bool>();
      if (followed[static_cast<size_t>(t - first)] && !at_seam) draft.known[t].fill_(true);
    }
    return draft;
  }
};

Generator::Generator(std::shared_ptr<const retriever::Retriever> retriever,
                     const std::map<std::string, nn::ModelStage>& stages)
    : impl_(std::make_unique<Impl>(std::move(retriever), stages)) {}
Generator::Generator(const std::map<std::string, nn::ModelStage>& stages,
                     std::shared_ptr<const encoders::SentenceEncoder> words)
    : Generator(std::make_shared<retriever::Retriever>(
                    nn::require_stage(stages, "retriever", "the model"), std::move(words)),
                stages) {}
Generator::~Generator() = default;
Generator::Generator(Generator&&) noexcept = default;
Generator& Generator::operator=(Generator&&) noexcept = default;

const retriever::Retriever& Generator::retriever() const { return *impl_->retriever; }
double Generator::trust(const RetrievedMotion& hit) const { return impl_->trust(hit); }

std::vector<float> Generator::sentence_vector(const std::string& sentence) const {
  return nn::float_vector(impl_->retriever->encode_text({sentence}).query);
}

const tokenizer::Tokenizer& Generator::tokenizer() const { return impl_->tokenizer; }
int64_t Generator::max_hits() const { return impl_->masked->config().max_hits; }
int64_t Generator::sequence_hits() const { return impl_->masked->config().sequence_hits; }

std::vector<RetrievedMotion> Generator::read_hits(const std::vector<RetrievedMotion>& hits,
                                                  const GenerateOptions& options) const {
  if (!options.use_retrieval) return {};
  const auto most = hits.begin() + std::min(static_cast<int64_t>(hits.size()), max_hits());
  if (options.read_untrusted) return {hits.begin(), most};
  return {hits.begin(), std::find_if(hits.begin(), most, [&](const RetrievedMotion& hit) {
            return impl_->trust(hit) <= 0;
          })};
}

const Skeleton& Generator::skeleton() const { return impl_->skeleton; }

int motion_frames(const std::optional<double>& seconds, const std::vector<RetrievedMotion>& hits,
                  double fps) {
  if (seconds) {
    if (!(*seconds >= kMinMotionSeconds && *seconds <= kMaxMotionSeconds)) {
      throw Error(fmt::format("a motion lasts {:g} to {:g} seconds, not {:g}", kMinMotionSeconds,
                              kMaxMotionSeconds, *seconds));
    }
    return static_cast<int>(std::lround(*seconds * fps));
  }
  double length = kDefaultSeconds;
  std::vector<int> lengths;
  for (const auto& hit : hits) {
    if (hit.frames > 0) lengths.push_back(hit.frames);
  }
  if (!lengths.empty()) {
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    length = *middle / fps;
  }
  return static_cast<int>(
      std::lround(std::clamp(length, kMinMotionSeconds, kMaxClipSeconds) * fps));
}

TokenCanvas Generator::canvas(int64_t frames) const {
  const tokenizer::TokenizerConfig& config = impl_->tokenizer.config();
  return {torch::zeros({frames, config.rows, config.levels}, torch::kLong),
          torch::zeros({frames, config.rows}, torch::kBool)};
}

FillReport Generator::fill(TokenCanvas& canvas, int64_t first, int64_t last,
                           const std::string& prompt, const std::vector<RetrievedMotion>& hits,
                           const GenerateOptions& options, GenerationTimes* times,
                           const Monitor& monitor) const {
  const torch::NoGradGuard no_grad;
  Stopwatch watch;
  GenerationTimes spent;
  const std::vector<RetrievedMotion> used = read_hits(hits, options);
  const std::vector<generator::TokenWindow> windows =
      generator::plan_windows(canvas.known, first, last);
  const generator::Condition condition = impl_->condition(prompt, used);
  FillReport report;
  report.hits_used = static_cast<int>(used.size());
  generator::KnownTokens draft{canvas.tokens, canvas.known};
  const RetrievedMotion* hit = nullptr;
  if (options.follow > 0) {
    report.followed = impl_->choose_followed(used, last - first, options, &hit);
  }
  if (report.followed) {
    draft = impl_->make_draft(*hit, canvas, first, last, report.followed->share, options.seed);
    draft.tokens = torch::where(canvas.known.unsqueeze(2), canvas.tokens, draft.tokens);
    draft.known = draft.known.logical_or(canvas.known);
  }
  spent.text = watch.lap();
  for (size_t i = 0; i < windows.size(); ++i) {
    const generator::TokenWindow& window = windows[i];
    const uint64_t seed = i == 0 ? options.seed : mix_seed(options.seed, i);
    // Tokens of the piece before take the place of those that were drafted.
    const generator::KnownTokens known{draft.tokens.slice(0, window.first, window.last),
                                       draft.known.slice(0, window.first, window.last)};
    const auto base = generator::sample_base(
        impl_->masked, condition, window.last - window.first, seed, options.sampling,
        generator::KnownTokens{known.tokens.select(2, 0), known.known}, monitor);
    spent.base += watch.lap();
    const auto tokens = impl_->residual
                            ? generator::sample_residual(impl_->residual, condition, base, seed,
                                                         options.sampling, known, monitor)
                            : base.unsqueeze(2);
    spent.residual += watch.lap();
    canvas.tokens.slice(0, window.first, window.last).copy_(tokens);
    canvas.known.slice(0, window.first, window.last).fill_(true);
    draft.tokens.slice(0, window.first, window.last).copy_(tokens);
    draft.known.slice(0, window.first, window.last).fill_(true);
    monitor.report(
        {"generate", static_cast<double>(i + 1), static_cast<double>(windows.size()), ""});
  }
  if (times) {
    times->text += spent.text;
    times->base += spent.base;
    times->residual += spent.residual;
  }
  return report;
}

Motion Generator::decode(const at::Tensor& tokens, bool held_feet) const {
  const nn::SerialScope serial;
  const motion::Features features = impl_->tokenizer.decode(tokens);
  Motion motion = motion::recover_motion(features, impl_->skeleton);
  smooth_over_time(motion, kDecodeSmoothing);
  impose_bone_lengths(motion, impl_->skeleton);
  if (held_feet) hold_feet(motion, features, impl_->skeleton);
  return motion;
}

Generated Generator::generate(const std::string& prompt, const std::vector<RetrievedMotion>& hits,
                              const GenerateOptions& options, const Monitor& monitor) const {
  Generated result;
  const int frames = motion_frames(options.seconds, read_hits(hits, options), impl_->skeleton.fps);
  TokenCanvas map = canvas((frames + kFramesPerToken - 1) / kFramesPerToken);
  const FillReport filled =
      fill(map, 0, map.tokens.size(0), prompt, hits, options, &result.times, monitor);
  result.hits_used = filled.hits_used;
  result.followed = filled.followed;
  result.tokens = map.tokens;
  Stopwatch watch;
  result.motion = slice(decode(result.tokens, options.held_feet), 0, frames);
  result.times.decode = watch.lap();
  lift_to_floor(result.motion, impl_->skeleton);
  result.times.finish = watch.lap();
  return result;
}

}  // namespace remomask::pipeline
