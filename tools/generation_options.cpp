#include "tools/generation_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "base/hash.h"
#include "base/random.h"
#include "pipeline/influence.h"
#include "pipeline/length_estimate.h"
#include "tools/candidate_list.h"

namespace remomask::tools {

namespace {

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

constexpr double kMostEvaluatedSeconds = 9.8;  // what the transformers see at once

}  // namespace

void GenerationOptions::add(CLI::App& command) {
  generator::SamplingOptions& sampling = generate.sampling;
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
  command.add_flag("--read-untrusted", generate.read_untrusted,
                   "read retrieved motions even where none fits the sentence well");
  command
      .add_option("--follow", generate.follow,
                  "share of the frames that keep the codes of a retrieved motion, less where it "
                  "fits less; 0: none, 1: that motion as it is")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  command.add_flag("!--slide", generate.held_feet,
                   "leave the feet as the model made them: do not hold standing ones in place, "
                   "do not raise swinging ones off the floor");
  command
      .add_option("--best-of", best_of,
                  "make so many candidates, keep the one that fits the sentence best and moves "
                  "like a body")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
}

GenerationWorkspace::GenerationWorkspace(const std::map<std::string, nn::ModelStage>& stages,
                                         const std::string& model_path, const FileOptions& files,
                                         const GenerationOptions& options)
    : search_(stages, model_path, files.database_path(), files.index_path()),
      generator_(stages),
      options_(options) {
  std::string digest = search_.database().uuid();
  for (const auto& [kind, stage] : stages) digest += nn::stage_hash(stage);
  const generator::SamplingOptions& sampling = options.generate.sampling;
  const char* retrieval = options.no_retrieval              ? "off"
                          : options.generate.read_untrusted ? "all"
                                                            : "trusted";
  identity_ = fmt::format(
      "model {} steps {} guidance {:g} temperature {:g} top {:g} corrections {} "
      "residual guidance {:g} residual temperature {:g} retrieval {} follow {:g} best of {} "
      "length {} feet {}",
      content_hash(digest), sampling.steps, sampling.guidance, sampling.temperature,
      sampling.top_share, sampling.correction_rounds, sampling.residual_guidance,
      sampling.residual_temperature, retrieval, options.generate.follow, options.best_of,
      options.length, options.generate.held_feet ? "held and raised" : "free");
}

pipeline::GenerateOptions GenerationWorkspace::generate_options(uint64_t seed) const {
  pipeline::GenerateOptions result = options_.generate;
  result.seed = seed;
  result.use_retrieval = !options_.no_retrieval;
  return result;
}

Evidence GenerationWorkspace::find_evidence(const std::string& sentence,
                                            const search::ClipFilter& filter) const {
  Evidence result;
  const auto k = static_cast<int>(generator_.max_hits());
  if (options_.no_retrieval || k == 0) return result;
  result.hits = search_.search(sentence, k, filter);
  const std::vector<float> query = text_vector(search_.retriever(), sentence);
  for (const search::MotionHit& hit : result.hits) {
    const auto vectors = search_.database().embedding(search_.retriever().hash(), hit.clip.id);
    if (!vectors || vectors->text.empty()) continue;
    pipeline::RetrievedMotion motion;
    motion.clip_id = hit.clip.id;
    motion.motion = vectors->motion;
    motion.text = vectors->text;
    motion.similarity = hit.similarity;
    motion.caption_similarity = dot(query, motion.text);
    motion.frames = hit.clip.frames;
    if (options_.generate.follow > 0 ||
        static_cast<int64_t>(result.motions.size()) < generator_.sequence_hits()) {
      motion.poses = search_.database().motion(hit.clip.id);
    }
    result.motions.push_back(std::move(motion));
  }
  result.read = generator_.read_hits(result.motions, options_.generate).size();
  return result;
}

nlohmann::json GenerationWorkspace::choose_length(const std::string& prompt,
                                                  const search::ClipFilter& filter,
                                                  pipeline::GenerateOptions& options) const {
  const pipeline::LengthRule rule = pipeline::parse_length_rule(options_.length);
  if (options.seconds) return nullptr;
  if (rule == pipeline::LengthRule::evidence) return {{"rule", options_.length}};
  std::vector<pipeline::LengthNeighbour> neighbours;
  for (const search::MotionHit& hit : search_.search(prompt, pipeline::kLengthNeighbours, filter)) {
    neighbours.push_back({hit.similarity, hit.clip.frames});
  }
  const std::vector<double> distribution = pipeline::length_distribution(neighbours);
  options.seconds = pipeline::estimate_seconds(distribution, rule, options.seed);
  return {
      {"rule", options_.length},
      {"neighbours", neighbours.size()},
      {"likely_seconds", pipeline::estimate_seconds(distribution, pipeline::LengthRule::likely, 0)},
      {"distribution", distribution}};
}

nlohmann::json followed_json(const std::optional<pipeline::FollowedHit>& followed,
                             const nlohmann::json& evidence) {
  if (!followed) return nullptr;
  for (const auto& hit : evidence) {
    if (hit.at("clip_id") != followed->clip_id) continue;
    return {{"clip_id", followed->clip_id}, {"clip", hit.at("clip")}, {"share", followed->share}};
  }
  throw std::logic_error("a motion followed a clip that was not retrieved");
}

nlohmann::json evidence_list(const Evidence& evidence) {
  nlohmann::json list = hits_json(evidence.hits);
  for (auto& hit : list) {
    const auto last = evidence.motions.begin() + static_cast<std::ptrdiff_t>(evidence.read);
    hit["read"] =
        std::any_of(evidence.motions.begin(), last, [&](const pipeline::RetrievedMotion& motion) {
          return hit.at("clip_id") == motion.clip_id;
        });
  }
  return list;
}

std::vector<uint64_t> candidate_seeds(uint64_t seed, int count) {
  std::vector<uint64_t> seeds = {seed};
  for (int i = 1; i < count; ++i) seeds.push_back(mix_seed(seed, static_cast<uint64_t>(i)));
  return seeds;
}

nlohmann::json GenerationWorkspace::evidence_json(const std::string& prompt,
                                                  const EvidencedMotion& made,
                                                  bool influence) const {
  nlohmann::json list = evidence_list(made.evidence);
  if (!influence) return list;
  const std::vector<double> shares = pipeline::hit_influence(
      generator_, prompt, made.evidence.motions, made.options, made.generated);
  for (size_t i = 0; i < shares.size(); ++i) {
    for (auto& hit : list) {
      if (hit.at("clip_id") == made.evidence.motions[i].clip_id) hit["influence"] = shares[i];
    }
  }
  return list;
}

EvidencedMotion GenerationWorkspace::generate(const std::string& prompt, uint64_t seed,
                                              const search::ClipFilter& evidence,
                                              int frames) const {
  const Evidence found = find_evidence(prompt, evidence);
  CandidateList<EvidencedMotion> candidates(search_.retriever(), prompt);
  for (const uint64_t number : candidate_seeds(seed, options_.best_of)) {
    pipeline::GenerateOptions options = generate_options(number);
    if (frames > 0) options.seconds = std::min(frames / 20.0, kMostEvaluatedSeconds);
    EvidencedMotion made;
    made.seed = number;
    made.length = choose_length(prompt, evidence, options);
    made.generated = generator_.generate(prompt, found.motions, options);
    made.evidence = found;
    made.options = options;
    const Motion motion = made.generated.motion;
    candidates.add(std::move(made), number, motion);
  }
  EvidencedMotion best = candidates.take_best();
  best.candidates = candidates.ranking();
  return best;
}

}  // namespace remomask::tools
