#pragma once

#include <ATen/core/Tensor.h>

#include <functional>
#include <map>
#include <string>

namespace remomask::nn {

/// Tensors by name; an ordered map, so that files are reproducible.
using TensorMap = std::map<std::string, at::Tensor>;

struct TensorFile {
  TensorMap tensors;
  std::map<std::string, std::string> metadata;
  bool has_checksums = false;  ///< false: of an older version or another program; not verified
};

/// Writes a safetensors file atomically (8-byte header length, JSON header,
/// raw little-endian data), with a checksum of the header and one of every tensor in its metadata.
/// Types: float32, float16, int64, int32, uint8, bool.
void save_safetensors(const std::string& path, const TensorMap& tensors,
                      const std::map<std::string, std::string>& metadata);

/// Reads a file: the whole header, and the data of the tensors whose names `wanted` accepts
/// (without it, of all). Every offset is checked, those of unwanted tensors too; throws FileError
/// for a truncated, foreign or damaged file: the header and every tensor that is read are compared
/// with their checksums. Nothing in the file is ever executed.
TensorFile load_safetensors(const std::string& path,
                            const std::function<bool(const std::string& name)>& wanted = {});

}  // namespace remomask::nn
