#include "remomask/library.h"

#include "db/storing_database.h"
#include "encoders/sentence_encoder.h"
#include "exchange/add_files.h"
#include "index/update_index.h"
#include "nn/model_file.h"
#include "remomask/error.h"
#include "retriever/embed_database.h"
#include "search/embed_captions.h"
#include "search/word_model.h"

namespace remomask {

AddReport add_motion_files(const std::string& database, std::span<const std::string> files,
                           const AddOptions& options, const Monitor& monitor) {
  exchange::AddOptions add;
  add.source = options.source;
  add.captions = options.captions;
  add.tags = options.tags;
  add.licence = options.licence;
  add.split = options.split;
  db::StoringDatabase storing(database);
  AddReport report;
  for (size_t i = 0; i < files.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted("stopped; the files before " + files[i] + " are stored");
    }
    const exchange::AddReport added = exchange::add_files(*storing, {files[i]}, add);
    for (const auto& [id, name] : added.clips) report.clips.push_back(name);
    for (const RejectedFile& rejected : added.rejected) {
      report.rejected.push_back({rejected.file, rejected.reason});
    }
    monitor.report(
        {"add", static_cast<double>(i + 1), static_cast<double>(files.size()), files[i]});
  }
  return report;
}

IndexReport index_database(const std::string& database_path, const std::string& model,
                           const Monitor& monitor) {
  const retriever::Retriever retriever = retriever::open_retriever(model);
  db::Database database(database_path, db::OpenMode::read_write);
  IndexReport report;
  report.embedded = retriever::embed_database(database, retriever, monitor);
  search::embed_captions(database, *retriever.words(), monitor);
  report.indexed = index::update_index(index::default_index_path(database_path), database,
                                       retriever.hash(), {}, monitor)
                       .count;
  return report;
}

}  // namespace remomask
