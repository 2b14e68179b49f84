#include "tools/generation_options.h"

#include <fmt/format.h>

#include "base/hash.h"

namespace remomask {

void GenerationOptions::add(CLI::App& command) {
  SamplingOptions& sampling = generate.sampling;
  command.add_option("--steps", sampling.steps, "passes of the masked transformer")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command
      .add_option("--guidance", sampling.guidance,
                  "w of un + w (con - un); 1: none; the papers' scale is w - 1")
      ->capture_default_str();
  command.add_option("--temperature", sampling.temperature, "0: always the likeliest code")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command.add_option("--top", sampling.top_share, "share of the codes that can be sampled")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option("--correction-rounds", sampling.correction_rounds,
                  "passes that draw the least likely tenth again")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command.add_option("--residual-guidance", sampling.residual_guidance, "of the detail levels")
      ->capture_default_str();
  command
      .add_option("--residual-temperature", sampling.residual_temperature, "of the detail levels")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--no-retrieval", no_retrieval, "from the text alone");
}

GenerationWorkspace::GenerationWorkspace(const std::map<std::string, ModelStage>& stages,
                                         const std::string& model_path, const FileOptions& files,
                                         const GenerationOptions& options)
    : search_(stages, model_path, files.database_path(), files.index_path()),
      generator_(stages),
      options_(options) {
  std::string digest = search_.database().uuid();
  for (const auto& [kind, stage] : stages) digest += stage_hash(stage);
  const SamplingOptions& sampling = options.generate.sampling;
  identity_ = fmt::format(
      "model {} steps {} guidance {:g} temperature {:g} top {:g} corrections {} "
      "residual guidance {:g} residual temperature {:g} retrieval {}",
      content_hash(digest), sampling.steps, sampling.guidance, sampling.temperature,
      sampling.top_share, sampling.correction_rounds, sampling.residual_guidance,
      sampling.residual_temperature, options.no_retrieval ? "off" : "on");
}

EvidencedMotion GenerationWorkspace::generate(const std::string& prompt, uint64_t seed,
                                              const ClipFilter& evidence, int frames) const {
  EvidencedMotion result;
  std::vector<RetrievedMotion> retrieved;
  GenerateOptions options = options_.generate;
  options.seed = seed;
  options.use_retrieval = !options_.no_retrieval;
  if (frames > 0) options.seconds = frames / 20.0;
  if (!options_.no_retrieval) {
    const auto k = static_cast<int>(generator_.max_hits());
    if (k > 0) result.hits = search_.search(prompt, k, evidence);
    for (const MotionHit& hit : result.hits) {
      const auto vectors = search_.database().embedding(search_.retriever().hash(), hit.clip.id);
      if (!vectors || vectors->text.empty()) continue;
      RetrievedMotion motion{hit.clip.id,    vectors->motion, vectors->text,
                             hit.similarity, hit.clip.frames, {}};
      if (static_cast<int64_t>(retrieved.size()) < generator_.sequence_hits()) {
        motion.poses = search_.database().motion(hit.clip.id);
      }
      retrieved.push_back(std::move(motion));
    }
  }
  result.generated = generator_.generate(prompt, retrieved, options);
  return result;
}

}  // namespace remomask
