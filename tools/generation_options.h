#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "generator/pipeline.h"
#include "tools/workspace.h"

namespace remomask {

/// Options of a generation that `generate` and `evaluate generation` share.
struct GenerationOptions {
  GenerateOptions generate;
  bool no_retrieval = false;

  void add(CLI::App& command);
};

/// A generated motion with the clips it was made from.
struct EvidencedMotion {
  Generated generated;
  std::vector<MotionHit> hits;
};

/// A whole model with the database that it retrieves from.
class GenerationWorkspace {
 public:
  GenerationWorkspace(const std::map<std::string, ModelStage>& stages,
                      const std::string& model_path, const FileOptions& files,
                      const GenerationOptions& options);

  /// `evidence` says which clips may be retrieved; `frames` 0: --seconds, or the
  /// length of the retrieved motions.
  EvidencedMotion generate(const std::string& prompt, uint64_t seed, const ClipFilter& evidence,
                           int frames = 0) const;

  const SearchWorkspace& search() const { return search_; }
  /// Hash of the model and all settings that change the result.
  const std::string& identity() const { return identity_; }

 private:
  SearchWorkspace search_;
  Generator generator_;
  GenerationOptions options_;
  std::string identity_;
};

}  // namespace remomask
