#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "pipeline/motion_generator.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// Options of a generation that `generate` and `evaluate generation` share.
struct GenerationOptions {
  pipeline::GenerateOptions generate;
  bool no_retrieval = false;
  int best_of = 1;                  ///< candidates a motion, see pipeline::score_candidate()
  std::string length = "evidence";  ///< see parse_length_rule(); only where no length is given

  void add(CLI::App& command);
};

/// What search found for a sentence, for people and for the generator.
struct Evidence {
  std::vector<search::MotionHit> hits;
  std::vector<pipeline::RetrievedMotion> motions;
  size_t read = 0;  ///< so many of `motions`, the first ones, are read (Generator::read_hits)
};

/// hits_json(), each with "read": whether the motion is made with it.
nlohmann::json evidence_list(const Evidence& evidence);

/// A generated motion with the clips it was made from.
struct EvidencedMotion {
  pipeline::Generated generated;
  Evidence evidence;
  pipeline::GenerateOptions options;  ///< of the candidate that was chosen
  uint64_t seed = 0;                  ///< of the candidate that was chosen
  nlohmann::json candidates;          ///< seeds and scores, the best first; empty for one candidate
  nlohmann::json length;              ///< how the length was estimated; null where it was given
};

/// The retrieved motion, of those of hits_json(), that a generated one started from; null
/// without one.
nlohmann::json followed_json(const std::optional<pipeline::FollowedHit>& followed,
                             const nlohmann::json& evidence);

/// Seeds of `count` candidates; the first is `seed` itself.
std::vector<uint64_t> candidate_seeds(uint64_t seed, int count);

/// A whole model with the database that it retrieves from.
class GenerationWorkspace {
 public:
  GenerationWorkspace(const std::map<std::string, nn::ModelStage>& stages,
                      const std::string& model_path, const FileOptions& files,
                      const GenerationOptions& options);

  /// The motions that search finds for a sentence among the clips of the filter; none
  /// with --no-retrieval.
  Evidence find_evidence(const std::string& sentence, const search::ClipFilter& filter) const;

  /// `evidence` says which clips may be retrieved; `frames` 0: --seconds, or the
  /// length of the retrieved motions.
  EvidencedMotion generate(const std::string& prompt, uint64_t seed,
                           const search::ClipFilter& evidence, int frames = 0) const;

  /// hits_json() of what a motion was made from; with `influence` every hit that was used says
  /// what leaving it out would change (hit_influence()).
  nlohmann::json evidence_json(const std::string& prompt, const EvidencedMotion& made,
                               bool influence) const;

  const SearchWorkspace& search() const { return search_; }
  const pipeline::Generator& generator() const { return generator_; }
  /// The options with a seed.
  pipeline::GenerateOptions generate_options(uint64_t seed) const;
  int best_of() const { return options_.best_of; }
  /// Hash of the model and all settings that change the result.
  const std::string& identity() const { return identity_; }

 private:
  /// Sets the seconds where nothing else gives them; says how.
  nlohmann::json choose_length(const std::string& prompt, const search::ClipFilter& filter,
                               pipeline::GenerateOptions& options) const;

  SearchWorkspace search_;
  pipeline::Generator generator_;
  GenerationOptions options_;
  std::string identity_;
};

}  // namespace remomask::tools
