#include <fmt/format.h>

#include <fstream>

#include "base/counted.h"
#include "index/index_changes.h"
#include "index/index_file.h"
#include "nn/model_file.h"
#include "nn/safetensors_check.h"
#include "remomask/error.h"
#include "tools/check_command.h"

namespace remomask::tools {

namespace {

bool is_index(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (file.tellg() < 8) return false;
  file.seekg(-8, std::ios::end);
  std::string magic(8, '\0');
  file.read(magic.data(), 8);
  return magic == "RMMINDEX" || magic == "RMMDELTA";
}

CheckedFile check_index(const std::string& path) {
  const std::string ending = ".delta";
  // A delta is checked with the index that it belongs to.
  const std::string base =
      path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
  const index::IndexFile file = index::read_index_file(base);
  const auto delta = index::read_index_delta(base, file.header);
  std::string content = counted(static_cast<int64_t>(file.header.ids.size()), "clip");
  if (delta) {
    content += fmt::format(", {} added and {} dropped since", delta->changes.added.size(),
                           delta->changes.dropped.size());
  }
  return {.kind = "index", .content = content};
}

CheckedFile check_tensors(const std::string& path) {
  const nn::CheckedTensors file = nn::check_safetensors(path);
  const bool is_model = file.format == "remomask-model";
  if (is_model) nn::has_stage(path, "");  // reads the list of its stages
  return {.kind = is_model                               ? "model"
                  : file.format == "remomask-checkpoint" ? "checkpoint"
                                                         : "safetensors file",
          .content = counted(file.tensors, "tensor"),
          .has_checksums = file.has_checksums};
}

}  // namespace

CheckedFile check_core_file(const std::string& path) {
  if (is_index(path)) return check_index(path);
  return check_tensors(path);
}

}  // namespace remomask::tools
