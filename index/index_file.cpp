#include "index/index_file.h"

#include <faiss/impl/io.h>
#include <faiss/index_io.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"

namespace remomask {

namespace {

constexpr std::string_view kIndexMagic = "RMMINDEX";
constexpr int kIndexVersion = 1;
constexpr const char* kRebuild = "run: remomask index DB";

static_assert(std::endian::native == std::endian::little, "index files are little-endian");

struct StringWriter : faiss::IOWriter {
  std::string data;
  size_t operator()(const void* source, size_t size, size_t count) override {
    data.append(static_cast<const char*>(source), size * count);
    return count;
  }
};

struct StringReader : faiss::IOReader {
  std::string_view rest;
  explicit StringReader(std::string_view data) : rest(data) {}
  size_t operator()(void* target, size_t size, size_t count) override {
    if (size == 0) return count;
    const size_t whole = std::min(count, rest.size() / size);
    if (whole > 0) std::memcpy(target, rest.data(), whole * size);
    rest.remove_prefix(whole * size);
    return whole;
  }
};

std::unique_ptr<faiss::Index> read_faiss(std::string_view data) {
  StringReader reader(data);
  return std::unique_ptr<faiss::Index>(faiss::read_index(&reader));
}

template <typename Wanted>
std::unique_ptr<Wanted> take_as(std::unique_ptr<faiss::Index> index, const std::string& path) {
  auto* wanted = dynamic_cast<Wanted*>(index.get());
  if (!wanted) {
    throw FileError(path, 0, std::string("holds another type of index; ") + kRebuild);
  }
  index.release();
  return std::unique_ptr<Wanted>(wanted);
}

struct IndexParts {
  nlohmann::json description;
  std::string_view vectors;  ///< all bytes before the description
};

IndexParts split_index_file(const std::string& path, std::string_view content) {
  constexpr size_t kEnd = 8 + kIndexMagic.size();
  if (content.size() < kEnd || !content.ends_with(kIndexMagic)) {
    throw FileError(path, 0, std::string("is no index, or is cut off; ") + kRebuild);
  }
  uint64_t length = 0;
  std::memcpy(&length, content.data() + content.size() - kEnd, 8);
  if (length > content.size() - kEnd) {
    throw FileError(path, 0, std::string("the index is damaged; ") + kRebuild);
  }
  const size_t start = content.size() - kEnd - static_cast<size_t>(length);
  IndexParts parts{nlohmann::json::parse(content.substr(start, length), nullptr, false),
                   content.substr(0, start)};
  if (parts.description.is_discarded()) {
    throw FileError(path, 0, std::string("the index is damaged; ") + kRebuild);
  }
  return parts;
}

}  // namespace

void write_index_file(const std::string& path, const IndexStamp& stamp, const std::string& factory,
                      const faiss::IndexIDMap2& index, const faiss::IndexFlat* exact) {
  StringWriter writer;
  faiss::write_index(&index, &writer);
  const size_t faiss_bytes = writer.data.size();
  if (exact) faiss::write_index(exact, &writer);
  const nlohmann::json description = {{"format", "remomask index"},
                                      {"version", kIndexVersion},
                                      {"database", stamp.database_uuid},
                                      {"generation", stamp.generation},
                                      {"retriever", stamp.retriever_hash},
                                      {"factory", factory},
                                      {"count", index.ntotal},
                                      {"width", index.d},
                                      {"faiss_bytes", faiss_bytes},
                                      {"exact_bytes", writer.data.size() - faiss_bytes},
                                      {"checksum", content_hash(writer.data)}};
  const std::string text = description.dump();
  const uint64_t length = text.size();
  writer.data += text;
  writer.data.append(reinterpret_cast<const char*>(&length), sizeof length);
  writer.data += kIndexMagic;
  write_file_atomically(path, writer.data);
}

IndexFile read_index_file(const std::string& path) {
  if (!std::filesystem::exists(path)) {
    throw FileError(path, 0, std::string("there is no index; ") + kRebuild);
  }
  const std::string content = read_file(path);
  const IndexParts parts = split_index_file(path, content);
  IndexFile file;
  try {
    const nlohmann::json& description = parts.description;
    if (description.at("version").get<int>() > kIndexVersion) {
      throw FileError(path, 0, std::string("was made by a newer version of remomask; ") + kRebuild);
    }
    const auto faiss_bytes = description.at("faiss_bytes").get<size_t>();
    const auto exact_bytes = description.at("exact_bytes").get<size_t>();
    if (faiss_bytes > parts.vectors.size() || exact_bytes != parts.vectors.size() - faiss_bytes ||
        description.at("checksum").get<std::string>() != content_hash(parts.vectors)) {
      throw FileError(path, 0, std::string("the index is damaged; ") + kRebuild);
    }
    file.stamp = {description.at("database").get<std::string>(),
                  description.at("generation").get<int64_t>(),
                  description.at("retriever").get<std::string>()};
    file.factory = description.at("factory").get<std::string>();
    file.index =
        take_as<faiss::IndexIDMap2>(read_faiss(parts.vectors.substr(0, faiss_bytes)), path);
    if (exact_bytes > 0) {
      file.exact = take_as<faiss::IndexFlat>(read_faiss(parts.vectors.substr(faiss_bytes)), path);
    } else if (!dynamic_cast<faiss::IndexFlat*>(file.index->index)) {
      throw FileError(path, 0, std::string("the index has no exact vectors; ") + kRebuild);
    }
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {  // of FAISS and of the JSON library
    throw FileError(path, 0,
                    std::string("the index is damaged (") + error.what() + "); " + kRebuild);
  }
  return file;
}

}  // namespace remomask
