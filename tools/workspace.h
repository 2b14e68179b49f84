#pragma once

#include <CLI/App.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"
#include "index/query.h"
#include "index/search_answer.h"
#include "index/search_scene.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/program.h"

namespace remomask {

/// --model and --db with the shipped files as defaults.
struct FileOptions {
  std::string model, database, index;

  void add_model(CLI::App& command);
  void add_database(CLI::App& command);
  std::string model_path() const;
  std::string database_path() const;
  std::string index_path() const;  ///< --index, or beside the database
};

/// Options that choose which clips a search may return.
struct FilterOptions {
  std::vector<std::string> splits, labels, tags, licences;
  std::optional<double> min_seconds, max_seconds, min_speed, max_speed;
  std::string words, caption_query;

  void add(CLI::App& command);
  ClipFilter filter() const;
};

/// A retriever with the database and index that it searches.
class SearchWorkspace {
 public:
  /// Throws Error when the index is missing or of another database or retriever.
  SearchWorkspace(const std::map<std::string, ModelStage>& stages, const std::string& model_path,
                  const std::string& database_path, const std::string& index_path);

  const Retriever& retriever() const { return retriever_; }
  const Database& database() const { return database_; }
  const VectorIndex& index() const { return state_->index; }
  /// The best `k` clips, one a group, in the state of the database that was opened.
  std::vector<MotionHit> search(const std::string& text, int k, const ClipFilter& filter) const;

 private:
  Retriever retriever_;
  Database database_;
  std::shared_ptr<const SearchState> state_;
};

/// The stage of `kind`; throws Error that names the model file when it lacks it.
const ModelStage& require_stage(const std::map<std::string, ModelStage>& stages,
                                const std::string& kind, const std::string& model_path);

/// One hit as it is printed.
nlohmann::json hit_json(const MotionHit& hit);

/// The vector of a text in the shared space [E], L2-normalised.
std::vector<float> text_vector(const Retriever& retriever, const std::string& text);

/// Evidence as it is printed and stored in generated files.
nlohmann::json hits_json(const std::vector<MotionHit>& hits);

/// The hits of evidence_list() that a motion was made with, in one line: "retrieved: NAME
/// (0.81), ..."; empty without any. Files of older versions do not say which were: all.
std::string evidence_line(const nlohmann::json& hits);

}  // namespace remomask
