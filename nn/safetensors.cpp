#include "nn/safetensors.h"

#include <ATen/Functions.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/content_hasher.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "nn/safetensors_check.h"
#include "remomask/error.h"

namespace remomask::nn {

namespace {

struct TensorType {
  const char* name;
  at::ScalarType type;
};
constexpr TensorType kTensorTypes[] = {
    {"F32", at::kFloat}, {"F16", at::kHalf}, {"BF16", at::kBFloat16}, {"F64", at::kDouble},
    {"I64", at::kLong},  {"I32", at::kInt},  {"U8", at::kByte},       {"BOOL", at::kBool},
};

const char* type_name(at::ScalarType type) {
  for (const auto& entry : kTensorTypes) {
    if (entry.type == type) return entry.name;
  }
  throw Error(std::string("safetensors: cannot store a tensor of type ") + c10::toString(type));
}

at::ScalarType type_of(const std::string& path, const std::string& name) {
  for (const auto& entry : kTensorTypes) {
    if (name == entry.name) return entry.type;
  }
  throw FileError(path, 0, "tensor type \"" + name + "\" is not supported");
}

constexpr uint64_t kMaxHeaderBytes = 64u << 20;
constexpr size_t kPieceBytes = 1u << 20;
constexpr const char* kMetadata = "__metadata__";
constexpr const char* kTensorChecksums = "tensor_checksums";  // a JSON object as text, by name
constexpr const char* kHeaderChecksum = "header_checksum";    // of the header without itself
constexpr const char* kDamaged =
    "; the file is damaged: restore a copy of it, or make it again by the command that made it";

std::string tensor_checksum(const at::Tensor& tensor) {
  return content_hash({static_cast<const char*>(tensor.data_ptr()), tensor.nbytes()});
}

/// Takes the checksums out of the header. Throws FileError if the header itself is damaged. Files
/// of version 0.2 and before, and of other programs, have none.
nlohmann::json take_checksums(const std::string& path, nlohmann::json& header) {
  const auto metadata = header.find(kMetadata);
  if (metadata == header.end()) return {};
  if (metadata->contains(kHeaderChecksum) != metadata->contains(kTensorChecksums)) {
    throw FileError(path, 0, std::string("a checksum is missing") + kDamaged);
  }
  if (!metadata->contains(kHeaderChecksum)) return {};
  const auto stated = metadata->at(kHeaderChecksum).get<std::string>();
  metadata->erase(kHeaderChecksum);
  if (content_hash(header.dump()) != stated) {
    throw FileError(path, 0, std::string("the checksum of its header differs") + kDamaged);
  }
  nlohmann::json checksums = parse_json(metadata->at(kTensorChecksums).get<std::string>());
  metadata->erase(kTensorChecksums);
  return checksums;
}

/// Reads parts of a file, so that one stage of a large model costs only its own bytes.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path) : path_(path) {
    // Not of a device or a pipe; opening the latter would wait for a writer.
    std::error_code failure;
    size_ = std::filesystem::file_size(path, failure);
    if (failure) throw FileError(path, 0, "cannot open: " + failure.message());
    stream_.open(path, std::ios::binary);
    if (!stream_) throw FileError(path, 0, "cannot open; check its permissions");
  }
  uint64_t size() const { return size_; }

  void read(uint64_t offset, uint64_t count, void* target) {
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(static_cast<char*>(target), static_cast<std::streamsize>(count));
    if (!stream_) throw FileError(path_, 0, "cannot be read to its end");
  }

 private:
  std::string path_;
  std::ifstream stream_;
  uint64_t size_ = 0;
};

}  // namespace

void save_safetensors(const std::string& path, const TensorMap& tensors,
                      const std::map<std::string, std::string>& metadata) {
  nlohmann::json header = nlohmann::json::object();
  header[kMetadata] = metadata;
  nlohmann::json checksums = nlohmann::json::object();
  uint64_t offset = 0;
  std::vector<at::Tensor> contiguous;
  for (const auto& [name, tensor] : tensors) {
    at::Tensor data = tensor.detach().to(at::kCPU).contiguous();
    const uint64_t bytes = data.nbytes();
    header[name] = {{"dtype", type_name(data.scalar_type())},
                    {"shape", data.sizes().vec()},
                    {"data_offsets", {offset, offset + bytes}}};
    offset += bytes;
    checksums[name] = tensor_checksum(data);
    contiguous.push_back(data);
  }
  header[kMetadata][kTensorChecksums] = checksums.dump();
  header[kMetadata][kHeaderChecksum] = content_hash(header.dump());
  std::string head = header.dump();
  head.append((8 - head.size() % 8) % 8, ' ');
  std::string content(8, '\0');
  const uint64_t head_bytes = head.size();
  std::memcpy(content.data(), &head_bytes, 8);
  content.reserve(8 + head.size() + offset);
  content += head;
  for (const auto& data : contiguous) {
    content.append(static_cast<const char*>(data.data_ptr()), data.nbytes());
  }
  write_file_atomically(path, content);
}

namespace {

/// A tensor as the header says it lies in the file.
struct StoredTensor {
  std::string name;
  at::ScalarType type;
  std::vector<int64_t> shape;
  uint64_t begin = 0, bytes = 0;  // in the file
};

struct Header {
  std::vector<StoredTensor> tensors;
  std::map<std::string, std::string> metadata;
  nlohmann::json checksums;  // null: the file has none
};

StoredTensor stored_tensor(const std::string& path, const std::string& name,
                           const nlohmann::json& entry, uint64_t data_start, uint64_t data_bytes) {
  const at::ScalarType type = type_of(path, entry.at("dtype").get<std::string>());
  const auto shape = entry.at("shape").get<std::vector<int64_t>>();
  const auto range = entry.at("data_offsets").get<std::vector<uint64_t>>();
  uint64_t elements = 1;
  for (const int64_t size : shape) {
    if (size < 0 || (size > 0 && elements > data_bytes / static_cast<uint64_t>(size) + 1)) {
      throw FileError(path, 0, "tensor \"" + name + "\" has an impossible shape");
    }
    elements *= static_cast<uint64_t>(size);
  }
  const uint64_t bytes = elements * c10::elementSize(type);
  if (range.size() != 2 || range[0] > range[1] || range[1] > data_bytes ||
      range[1] - range[0] != bytes) {
    throw FileError(path, 0, "tensor \"" + name + "\" lies outside the file (truncated?)");
  }
  return {name, type, shape, data_start + range[0], bytes};
}

Header read_header(const std::string& path, FileBytes& source) {
  if (source.size() < 8) throw FileError(path, 0, "too short for a safetensors file");
  uint64_t head_bytes = 0;
  source.read(0, 8, &head_bytes);
  if (head_bytes > kMaxHeaderBytes || head_bytes > source.size() - 8) {
    throw FileError(path, 0, "not a safetensors file, or truncated");
  }
  std::string head(head_bytes, '\0');
  source.read(8, head_bytes, head.data());
  // The JSON library takes it for the end of the text.
  if (head.find('\0') != std::string::npos) {
    throw FileError(path, 0, std::string("broken safetensors header") + kDamaged);
  }
  const uint64_t data_start = 8 + head_bytes;
  nlohmann::json json = parse_json(head);
  Header header;
  header.checksums = take_checksums(path, json);
  uint64_t data_end = data_start;
  for (const auto& [name, entry] : json.items()) {
    if (name == kMetadata) {
      header.metadata = entry.get<std::map<std::string, std::string>>();
      continue;
    }
    header.tensors.push_back(
        stored_tensor(path, name, entry, data_start, source.size() - data_start));
    data_end = std::max(data_end, header.tensors.back().begin + header.tensors.back().bytes);
  }
  if (data_end != source.size()) {
    throw FileError(path, 0, "bytes follow the last tensor" + std::string(kDamaged));
  }
  return header;
}

void compare_checksum(const std::string& path, const Header& header, const std::string& name,
                      const std::string& checksum) {
  if (header.checksums.at(name) == checksum) return;
  throw FileError(path, 0, "the checksum of tensor \"" + name + "\" differs" + kDamaged);
}

/// Calls `read` with the open file; what the JSON library throws becomes a FileError.
template <typename Read>
void reading(const std::string& path, const Read& read) {
  try {
    FileBytes source(path);
    read(source, read_header(path, source));
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, 0, "broken safetensors header: " + json_reason(error));
  }
}

}  // namespace

TensorFile load_safetensors(const std::string& path,
                            const std::function<bool(const std::string& name)>& wanted) {
  TensorFile file;
  reading(path, [&](FileBytes& source, const Header& header) {
    for (const StoredTensor& stored : header.tensors) {
      if (wanted && !wanted(stored.name)) continue;
      at::Tensor tensor = at::empty(stored.shape, at::TensorOptions().dtype(stored.type));
      if (stored.bytes > 0) source.read(stored.begin, stored.bytes, tensor.data_ptr());
      if (!header.checksums.is_null()) {
        compare_checksum(path, header, stored.name, tensor_checksum(tensor));
      }
      file.tensors.emplace(stored.name, tensor);
    }
    file.metadata = header.metadata;
    file.has_checksums = !header.checksums.is_null();
  });
  return file;
}

CheckedTensors check_safetensors(const std::string& path) {
  CheckedTensors checked;
  reading(path, [&](FileBytes& source, const Header& header) {
    std::vector<char> piece(kPieceBytes);
    for (const StoredTensor& stored : header.tensors) {
      if (header.checksums.is_null()) break;
      ContentHasher hasher;
      for (uint64_t done = 0; done < stored.bytes;) {
        const uint64_t count = std::min<uint64_t>(piece.size(), stored.bytes - done);
        source.read(stored.begin + done, count, piece.data());
        hasher.add({piece.data(), count});
        done += count;
      }
      compare_checksum(path, header, stored.name, hasher.hash());
    }
    const auto format = header.metadata.find("format");
    if (format != header.metadata.end()) checked.format = format->second;
    checked.tensors = static_cast<int64_t>(header.tensors.size());
    checked.has_checksums = !header.checksums.is_null();
  });
  return checked;
}

}  // namespace remomask::nn
