#include "nn/safetensors.h"

#include <ATen/Functions.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
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
  explicit FileBytes(const std::string& path) : path_(path), stream_(path, std::ios::binary) {
    std::error_code failure;
    size_ = std::filesystem::file_size(path, failure);
    if (failure) throw FileError(path, 0, "cannot open: " + failure.message());
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

TensorFile load_safetensors(const std::string& path,
                            const std::function<bool(const std::string& name)>& wanted) {
  FileBytes source(path);
  if (source.size() < 8) throw FileError(path, 0, "too short for a safetensors file");
  uint64_t head_bytes = 0;
  source.read(0, 8, &head_bytes);
  if (head_bytes > kMaxHeaderBytes || head_bytes > source.size() - 8) {
    throw FileError(path, 0, "not a safetensors file, or truncated");
  }
  std::string head(head_bytes, '\0');
  source.read(8, head_bytes, head.data());
  TensorFile file;
  const uint64_t data_start = 8 + head_bytes;
  const uint64_t data_bytes = source.size() - data_start;
  try {
    auto header = parse_json(head);
    const nlohmann::json checksums = take_checksums(path, header);
    uint64_t data_end = 0;
    for (const auto& [name, entry] : header.items()) {
      if (name == kMetadata) {
        file.metadata = entry.get<std::map<std::string, std::string>>();
        continue;
      }
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
      data_end = std::max(data_end, range[1]);
      if (wanted && !wanted(name)) continue;
      at::Tensor tensor = at::empty(shape, at::TensorOptions().dtype(type));
      if (bytes > 0) source.read(data_start + range[0], bytes, tensor.data_ptr());
      if (!checksums.is_null() && checksums.at(name) != tensor_checksum(tensor)) {
        throw FileError(path, 0, "the checksum of tensor \"" + name + "\" differs" + kDamaged);
      }
      file.tensors.emplace(name, tensor);
    }
    if (data_end != data_bytes) {
      throw FileError(path, 0, "bytes follow the last tensor" + std::string(kDamaged));
    }
    file.has_checksums = !checksums.is_null();
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, 0, "broken safetensors header: " + json_reason(error));
  }
  return file;
}

}  // namespace remomask::nn
