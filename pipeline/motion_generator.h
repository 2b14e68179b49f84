#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "generator/sampling.h"
#include "nn/model_file.h"
#include "remomask/generation.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"
#include "tokenizer/tokenizer.h"

namespace remomask::pipeline {

/// A motion that search found for the prompt.
struct RetrievedMotion {
  int64_t clip_id = 0;
  std::vector<float> motion;       ///< R_m, width E, of the same retriever as the model's
  std::vector<float> text;         ///< R_t
  double similarity = 0;           ///< cosine of prompt and motion
  double caption_similarity = -1;  ///< cosine of prompt and R_t, which the evidence gate reads too
  /// That it shows what the prompt asks for, where a search by words found it.
  std::optional<double> probability;
  int frames = 0;  ///< its length at the skeleton's rate; 0: unknown
  /// Its motion, for models that read hits frame by frame (sequence_hits());
  /// without it the hit is its vectors only.
  std::optional<Motion> poses;
};

/// The hit whose codes a motion started from.
struct FollowedHit {
  int64_t clip_id = 0;
  double share = 0;  ///< of the token frames that it covers
};

/// What a stretch was filled from.
struct FillReport {
  int hits_used = 0;
  std::optional<FollowedHit> followed;
};

struct Generated {
  Motion motion;      ///< uniform bone lengths, not below the floor
  at::Tensor tokens;  ///< int64 [T, rows, levels]
  int hits_used = 0;
  std::optional<FollowedHit> followed;
  GenerationTimes times;
};

/// A token map of any length that is filled piece by piece.
struct TokenCanvas {
  at::Tensor tokens;  ///< int64 [T, rows, levels]
  at::Tensor known;   ///< bool [T, rows]; the other tokens mean nothing
};

/// A whole model: prompt and hits -> motion. Const functions may be called
/// from several threads. The result is a function of prompt, hits, options and
/// model alone.
class Generator {
 public:
  /// Needs the stages retriever, tokenizer, masked and residual (the last one
  /// only where the tokenizer has several levels). Throws Error when one lacks
  /// or when their sizes do not fit together.
  Generator(const std::map<std::string, nn::ModelStage>& stages,
            std::shared_ptr<const encoders::SentenceEncoder> words);
  /// The same with a retriever that is loaded already.
  Generator(std::shared_ptr<const retriever::Retriever> retriever,
            const std::map<std::string, nn::ModelStage>& stages);
  ~Generator();
  Generator(Generator&&) noexcept;
  Generator& operator=(Generator&&) noexcept;

  /// An empty prompt means: no text. At most the model's max_hits best hits are
  /// used. Throws Error for a hit of another width or seconds that are no number.
  Generated generate(const std::string& prompt, const std::vector<RetrievedMotion>& hits,
                     const GenerateOptions& options = {}, const Monitor& monitor = {}) const;

  /// A map of `frames` token frames of which nothing is known.
  TokenCanvas canvas(int64_t frames) const;
  /// Samples the unknown cells of token frames [first, last) under one prompt; all
  /// are known afterwards. Long stretches are cut as plan_windows() says. Of the
  /// options `seconds` is not read. `times` is added to. Throws Error for frames outside of the
  /// map, and as generate() does.
  FillReport fill(TokenCanvas& canvas, int64_t first, int64_t last, const std::string& prompt,
                  const std::vector<RetrievedMotion>& hits, const GenerateOptions& options,
                  GenerationTimes* times = nullptr, const Monitor& monitor = {}) const;
  /// Tokens of any length -> a motion of four frames each with the bone lengths
  /// of the skeleton, smoothed by a Gaussian of 40 ms. It starts at the origin and faces +Z. With
  /// `held_feet` standing feet do not slide (hold_feet).
  Motion decode(const at::Tensor& tokens, bool held_feet = true) const;

  const retriever::Retriever& retriever() const;
  const tokenizer::Tokenizer& tokenizer() const;
  const Skeleton& skeleton() const;
  int64_t max_hits() const;
  /// Those of `hits`, the best first, that are read: at most max_hits(), up to the first that
  /// the model's evidence gate does not trust at all. A sentence that finds nothing that
  /// fits is better made from the text alone. None without `options.use_retrieval`.
  std::vector<RetrievedMotion> read_hits(const std::vector<RetrievedMotion>& hits,
                                         const GenerateOptions& options) const;
  /// How far a hit is trusted, 0 to 1: by its probability (kProbabilityGate); without one, by the
  /// model's evidence gate, and in full by a model without a gate.
  double trust(const RetrievedMotion& hit) const;
  /// The retriever's vector of a sentence [E], L2-normalised.
  std::vector<float> sentence_vector(const std::string& sentence) const;
  /// Of how many hits, the best ones, the poses are read.
  int64_t sequence_hits() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Length in frames: round(seconds x fps), else the median of the known lengths
/// of the hits, else 5 s, the latter two clamped to 1 .. 9.8 s. Throws Error for
/// seconds that are no number from 1 to 600.
int motion_frames(const std::optional<double>& seconds, const std::vector<RetrievedMotion>& hits,
                  double fps);

}  // namespace remomask::pipeline
