#include "nn/safetensors.h"

#include <ATen/Functions.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/file.h"
#include "remomask/error.h"

namespace remomask::nn {

namespace {

struct TensorType {
  const char* name;
  at::ScalarType type;
};
constexpr TensorType kTensorTypes[] = {
    {"F32", at::kFloat}, {"F16", at::kHalf}, {"F64", at::kDouble}, {"I64", at::kLong},
    {"I32", at::kInt},   {"U8", at::kByte},  {"BOOL", at::kBool},
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

constexpr uint64_t kMostHeaderBytes = 64u << 20;

}  // namespace

void save_safetensors(const std::string& path, const TensorMap& tensors,
                      const std::map<std::string, std::string>& metadata) {
  nlohmann::json header = nlohmann::json::object();
  header["__metadata__"] = metadata;
  uint64_t offset = 0;
  std::vector<at::Tensor> contiguous;
  for (const auto& [name, tensor] : tensors) {
    at::Tensor data = tensor.detach().to(at::kCPU).contiguous();
    const uint64_t bytes = data.nbytes();
    header[name] = {{"dtype", type_name(data.scalar_type())},
                    {"shape", data.sizes().vec()},
                    {"data_offsets", {offset, offset + bytes}}};
    offset += bytes;
    contiguous.push_back(data);
  }
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

TensorFile load_safetensors(const std::string& path) {
  const std::string content = read_file(path);
  if (content.size() < 8) throw FileError(path, 0, "too short for a safetensors file");
  uint64_t head_bytes = 0;
  std::memcpy(&head_bytes, content.data(), 8);
  if (head_bytes > kMostHeaderBytes || head_bytes > content.size() - 8) {
    throw FileError(path, 0, "not a safetensors file, or truncated");
  }
  TensorFile file;
  const char* data = content.data() + 8 + head_bytes;
  const uint64_t data_bytes = content.size() - 8 - head_bytes;
  try {
    const auto header = nlohmann::json::parse(content.data() + 8, data);
    for (const auto& [name, entry] : header.items()) {
      if (name == "__metadata__") {
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
      at::Tensor tensor = at::empty(shape, at::TensorOptions().dtype(type));
      if (bytes > 0) std::memcpy(tensor.data_ptr(), data + range[0], bytes);
      file.tensors.emplace(name, tensor);
    }
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, 0, std::string("broken safetensors header: ") + error.what());
  }
  return file;
}

}  // namespace remomask::nn
