#pragma once

#include <ATen/core/Tensor.h>

#include <map>
#include <string>

namespace remomask::nn {

/// Tensors by name; an ordered map, so that files are reproducible.
using TensorMap = std::map<std::string, at::Tensor>;

struct TensorFile {
  TensorMap tensors;
  std::map<std::string, std::string> metadata;
};

/// Writes a safetensors file atomically (8-byte header length, JSON header,
/// raw little-endian data). Types: float32, float16, int64, int32, uint8, bool.
void save_safetensors(const std::string& path, const TensorMap& tensors,
                      const std::map<std::string, std::string>& metadata);

/// Reads one. Every offset is checked; throws FileError for a truncated,
/// overlapping or foreign file. Nothing in the file is ever executed.
TensorFile load_safetensors(const std::string& path);

}  // namespace remomask::nn
