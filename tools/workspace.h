#pragma once

#include <CLI/App.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "search/query.h"
#include "search/search_answer.h"
#include "search/search_scene.h"
#include "tools/program.h"

namespace remomask::tools {

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
  search::ClipFilter filter() const;
};

/// A retriever with the database and index that it searches.
class SearchWorkspace {
 public:
  /// Throws Error when the index is missing or of another database or retriever.
  SearchWorkspace(const std::map<std::string, nn::ModelStage>& stages,
                  const std::string& model_path, const std::string& database_path,
                  const std::string& index_path);

  const retriever::Retriever& retriever() const { return retriever_; }
  const db::Database& database() const { return database_; }
  const index::VectorIndex& index() const { return state_->index; }
  /// The best `k` clips, one a group, in the state of the database that was opened.
  std::vector<search::MotionHit> search(const std::string& text, int k,
                                        const search::ClipFilter& filter) const;

 private:
  retriever::Retriever retriever_;
  db::Database database_;
  std::shared_ptr<const search::SearchState> state_;
};

/// The stage of `kind`; throws Error that names the model file when it lacks it.
const nn::ModelStage& require_stage(const std::map<std::string, nn::ModelStage>& stages,
                                    const std::string& kind, const std::string& model_path);

/// One hit as it is printed.
nlohmann::json hit_json(const search::MotionHit& hit);

/// The vector of a text in the shared space [E], L2-normalised.
std::vector<float> text_vector(const retriever::Retriever& retriever, const std::string& text);

/// Evidence as it is printed and stored in generated files.
nlohmann::json hits_json(const std::vector<search::MotionHit>& hits);

/// The hits of evidence_list() that a motion was made with, in one line: "retrieved: NAME
/// (0.81), ..."; empty without any. Files of older versions do not say which were: all.
std::string evidence_line(const nlohmann::json& hits);

}  // namespace remomask::tools
