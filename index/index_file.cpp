#include "index/index_file.h"

#include <faiss/impl/io.h>
#include <faiss/index_io.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/file.h"
#include "base/hash.h"
#include "index/described_file.h"
#include "index/faiss_layout.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

constexpr std::string_view kIndexMagic = "RMMINDEX";
constexpr const char* kRebuild = "run: remomask index DB --rebuild";

struct ViewReader : faiss::IOReader {
  std::string_view rest;
  explicit ViewReader(std::string_view data) : rest(data) {}
  size_t operator()(void* target, size_t size, size_t count) override {
    if (size == 0) return count;
    const size_t whole = std::min(count, rest.size() / size);
    if (whole > 0) std::memcpy(target, rest.data(), whole * size);
    rest.remove_prefix(whole * size);
    return whole;
  }
};

struct StreamWriter : faiss::IOWriter {
  std::ofstream& stream;
  explicit StreamWriter(std::ofstream& target) : stream(target) {}
  size_t operator()(const void* source, size_t size, size_t count) override {
    stream.write(static_cast<const char*>(source), static_cast<std::streamsize>(size * count));
    return stream ? count : 0;
  }
};

template <typename Wanted>
std::unique_ptr<Wanted> read_faiss(std::string_view data, const std::string& path) {
  ViewReader reader(data);
  std::unique_ptr<faiss::Index> index(faiss::read_index(&reader));
  auto* wanted = dynamic_cast<Wanted*>(index.get());
  if (!wanted) {
    throw FileError(path, 0, std::string("holds an index of another type; ") + kRebuild);
  }
  index.release();
  return std::unique_ptr<Wanted>(wanted);
}

/// The parts of an index file, still in the mapped file.
struct IndexParts {
  IndexHeader header;
  std::string_view body, faiss, exact;
};

/// IDMap2 ends with its ids.
std::string_view ids_at_end(std::string_view faiss, size_t count) {
  return faiss.substr(faiss.size() - count * sizeof(int64_t));
}

IndexParts split_index_file(const std::string& path, std::string_view content) {
  const DescribedContent parts = split_described(path, content, kIndexMagic, kRebuild);
  const nlohmann::json& description = parts.description;
  IndexParts result;
  IndexHeader& header = result.header;
  header.stamp = {description.at("database").get<std::string>(),
                  description.at("generation").get<int64_t>(),
                  description.at("retriever").get<std::string>(), description.value("writer", "")};
  header.type.factory = description.at("factory").get<std::string>();
  // Version 1 does not say these; its default was Flat.
  const std::string& factory = header.type.factory;
  header.type.requested = description.value("requested", factory == "Flat" ? "auto" : factory);
  header.type.search_parameters = description.value("search_parameters", "");
  if (description.contains("recall_at_10")) header.type.recall = description.at("recall_at_10");
  header.width = description.at("width").get<int>();
  header.checksum = description.at("checksum").get<std::string>();

  const auto faiss_bytes = description.at("faiss_bytes").get<size_t>();
  const auto exact_bytes = description.at("exact_bytes").get<size_t>();
  const auto count = description.at("count").get<size_t>();
  const FileError damaged(path, 0, std::string("the index is damaged; ") + kRebuild);
  if (faiss_bytes > parts.body.size() || exact_bytes != parts.body.size() - faiss_bytes ||
      count > faiss_bytes / sizeof(int64_t)) {
    throw damaged;
  }
  result.body = parts.body;
  result.faiss = parts.body.substr(0, faiss_bytes);
  result.exact = parts.body.substr(faiss_bytes);
  const std::string_view ids = ids_at_end(result.faiss, count);
  const bool intact = description.contains("ids_checksum")
                          ? description.at("ids_checksum") == content_hash(ids)
                          : header.checksum == content_hash(parts.body);
  if (!intact) throw damaged;
  header.ids.resize(count);
  if (count > 0) std::memcpy(header.ids.data(), ids.data(), ids.size());
  if (!std::is_sorted(header.ids.begin(), header.ids.end())) throw damaged;
  return result;
}

/// Turns exceptions of FAISS and the JSON library into FileError.
template <typename Read>
auto reading(const std::string& path, const Read& read) {
  if (!std::filesystem::exists(path)) {
    throw FileError(path, 0, "there is no index; run: remomask index DB");
  }
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(path, 0,
                    std::string("the index is damaged (") + error.what() + "); " + kRebuild);
  }
}

/// A temporary file that is written piece by piece.
class PieceWriter {
 public:
  explicit PieceWriter(const std::string& path)
      : path_(path), stream_(path, std::ios::binary | std::ios::trunc) {}

  size_t add(const faiss::Index& index) {
    StreamWriter writer(stream_);
    try {
      faiss::write_index(&index, &writer);
    } catch (const std::exception&) {  // FAISS does not know the reason; the stream does
      stream_.setstate(std::ios::failbit);
    }
    return flush();
  }
  size_t add(std::string_view text) {
    stream_ << text;
    return flush();
  }

 private:
  /// Size of the file so far.
  size_t flush() {
    stream_.flush();
    if (!stream_) {
      throw FileError(path_, 0, "cannot write (is the disk full?); the old index was kept");
    }
    return static_cast<size_t>(stream_.tellp());
  }

  std::string path_;
  std::ofstream stream_;
};

}  // namespace

std::string write_index_file(const std::string& path, const IndexStamp& stamp,
                             const IndexType& type, const faiss::IndexIDMap2& index,
                             const faiss::IndexFlat* exact) {
  AtomicFile file(path);
  PieceWriter writer(file.temporary_path());
  const size_t faiss_bytes = writer.add(index);
  const size_t body_bytes = exact ? writer.add(*exact) : faiss_bytes;
  nlohmann::json description = {
      {"format", "remomask index"},     {"database", stamp.database_uuid},
      {"generation", stamp.generation}, {"retriever", stamp.retriever_hash},
      {"writer", stamp.writer},         {"requested", type.requested},
      {"factory", type.factory},        {"search_parameters", type.search_parameters},
      {"count", index.ntotal},          {"width", index.d},
      {"faiss_bytes", faiss_bytes},     {"exact_bytes", body_bytes - faiss_bytes}};
  if (type.recall) description["recall_at_10"] = *type.recall;
  std::string checksum;
  {
    const MappedFile written(file.temporary_path());
    const auto count = static_cast<size_t>(index.ntotal);
    checksum = content_hash(written.content());
    description["checksum"] = checksum;
    description["ids_checksum"] =
        content_hash(ids_at_end(written.content().substr(0, faiss_bytes), count));
  }
  writer.add(describe(std::move(description), kIndexMagic));
  file.commit();
  return checksum;
}

IndexFile read_index_file(const std::string& path) {
  return reading(path, [&] {
    const MappedFile mapped(path);
    IndexParts parts = split_index_file(path, mapped.content());
    if (content_hash(parts.body) != parts.header.checksum) {
      throw FileError(path, 0, std::string("the index is damaged; ") + kRebuild);
    }
    const FaissSize size{static_cast<int64_t>(parts.header.ids.size()), parts.header.width};
    if (!fits_layout(parts.faiss, size, /*with_ids=*/true) ||
        (!parts.exact.empty() && !fits_layout(parts.exact, size, /*with_ids=*/false))) {
      throw FileError(path, 0,
                      std::string("the index holds something else than it says; ") + kRebuild);
    }
    IndexFile file;
    file.index = read_faiss<faiss::IndexIDMap2>(parts.faiss, path);
    if (!parts.exact.empty()) {
      file.exact = read_faiss<faiss::IndexFlat>(parts.exact, path);
    } else if (!dynamic_cast<faiss::IndexFlat*>(file.index->index)) {
      throw FileError(path, 0, std::string("the index has no exact vectors; ") + kRebuild);
    }
    file.header = std::move(parts.header);
    return file;
  });
}

IndexHeader read_index_header(const std::string& path) {
  return reading(path, [&] {
    const MappedFile mapped(path);
    return split_index_file(path, mapped.content()).header;
  });
}

}  // namespace remomask::index
