// Readers of what the program stores: databases, archives, tensors and indexes. Checksums would
// refuse nearly every changed input, so that they are left out or made to fit.
#include <filesystem>

#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "db/check.h"
#include "encoders/bert_import.h"
#include "exchange/archive.h"
#include "index/described_file.h"
#include "index/index_changes.h"
#include "index/index_file.h"
#include "index/update_index.h"
#include "nn/model_file.h"
#include "remomask/error.h"
#include "tests/db/db_test_tools.h"
#include "tests/fuzz/fuzz_test_tools.h"
#include "tests/fuzz/mutator.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class StoreReaderFuzz : public ReaderFuzz {
 protected:
  /// A file of the index without its checksums: the description as text, then the body.
  static std::string taken_apart(const std::string& content, const char* magic) {
    const index::DescribedContent parts = index::split_described("seed", content, magic, "");
    return parts.description.dump() + "\n" + std::string(parts.body);
  }

  /// The opposite. Whatever is wrong, the checksums fit.
  static std::string put_together(const std::string& content, const char* magic) {
    const size_t end = std::min(content.find('\n'), content.size());
    const std::string body = content.substr(std::min(end + 1, content.size()));
    nlohmann::json description = try_parse_json(content.substr(0, end));
    if (!description.is_object()) return body;
    description["checksum"] = content_hash(body);
    const auto number = [&](const char* name) -> size_t {
      const auto found = description.find(name);
      return found != description.end() && found->is_number() ? found->get<size_t>() : 0;
    };
    const size_t faiss = std::min(number("faiss_bytes"), body.size());
    const size_t ids = std::min(number("count"), faiss / 8) * 8;
    if (description.contains("ids_checksum")) {
      description["ids_checksum"] = content_hash(body.substr(faiss - ids, ids));
    }
    try {
      return body + index::describe(description, magic);
    } catch (const nlohmann::json::exception&) {
      return body;  // text that is no UTF-8
    }
  }

  void make_database(const std::string& path, int clips) {
    db::Database database(path, db::OpenMode::create);
    for (int i = 0; i < clips; ++i) {
      db::Clip clip = named_clip("clip " + std::to_string(i));
      clip.captions = {"a person walks."};
      clip.tags = {"best"};
      const int64_t id = database.add_clip(clip, walking_motion(8, i));
      database.add_embeddings("r", {{id, {0.6f, 0.8f}, {0.5f}, {1.f, 0.f}}});
    }
  }
};

TEST_F(StoreReaderFuzz, Database) {
  std::vector<std::string> seeds;
  for (const char* version : {"2", "3", "4"}) {
    seeds.push_back(read_file(std::string(REMOMASK_SOURCE_DIR) + "/tests/data/formats/database_" +
                              version + ".sqlite"));
  }
  make_database(folder_ / "d", 1);
  seeds.push_back(read_file(folder_ / "d"));
  fuzz(seeds, 1, [&](const std::string& content) {
    const std::string path = place("input.sqlite", content);
    for (const char* ending : {"-wal", "-shm", "-journal"}) fs::remove(path + ending);
    db::check_database(path);
    const db::Database database(path, db::OpenMode::read_only);
    for (const db::Clip& clip : database.clips()) database.motion(clip.id);
    database.match_captions("person");
    for (const std::string& retriever : database.retrievers()) database.embeddings(retriever);
    for (const std::string& encoder : database.caption_encoders()) {
      database.caption_vectors(encoder);
    }
  });
}

TEST_F(StoreReaderFuzz, Archive) {
  fuzz(corpus("archive"), 2, [&](const std::string& content) {
    exchange::UnpackedArchive archive(place("input.tar", content), {});
  });
}

TEST_F(StoreReaderFuzz, Model) {
  fuzz(corpus("model"), 20,
       [&](const std::string& content) { nn::load_model(place("model", content)); });
}

TEST_F(StoreReaderFuzz, EncoderFolder) {
  const std::string source = std::string(REMOMASK_SOURCE_DIR) + "/tests/fuzz/corpus/encoder/";
  fs::copy(source, folder_ / "encoder");
  for (const char* name : {"config.json", "vocab.txt", "model.safetensors"}) {
    const std::string sound = read_file(source + name);
    fuzz({sound}, 4, [&](const std::string& content) {
      place(std::string("encoder/") + name, content);
      encoders::import_bert(folder_ / "encoder");
    });
    place(std::string("encoder/") + name, sound);
  }
}

TEST_F(StoreReaderFuzz, Index) {
  make_database(folder_ / "d", 8);
  const db::Database database(folder_ / "d", db::OpenMode::read_only);
  std::vector<std::string> seeds;
  for (const char* factory : {"Flat", "IVF2,Flat", "HNSW4"}) {
    index::UpdateOptions options;
    options.type = index::VectorIndexOptions{};
    options.type->factory = factory;
    index::update_index(folder_ / factory, database, "r", options);
    seeds.push_back(taken_apart(read_file(folder_ / factory), "RMMINDEX"));
  }
  fuzz(seeds, 10, [&](const std::string& content) {
    index::read_index_file(place("input.index", put_together(content, "RMMINDEX")));
  });
}

TEST_F(StoreReaderFuzz, IndexDelta) {
  // So many that one less is no reason to build the base anew.
  make_database(folder_ / "d", 40);
  db::Database database(folder_ / "d", db::OpenMode::read_write);
  const std::string path = folder_ / "d.index";
  index::update_index(path, database, "r");
  database.remove({3});
  index::update_index(path, database, "r");
  const index::IndexHeader base = index::read_index_header(path);
  const std::string seed = taken_apart(read_file(index::delta_path(path)), "RMMDELTA");
  fuzz({seed}, 10, [&](const std::string& content) {
    place("d.index.delta", put_together(content, "RMMDELTA"));
    index::read_index_delta(path, base);
  });
}

}  // namespace
}  // namespace remomask
