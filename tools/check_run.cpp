#include <fmt/format.h>

#include "base/counted.h"
#include "base/file.h"
#include "index/index_changes.h"
#include "index/index_file.h"
#include "nn/safetensors.h"
#include "remomask/error.h"
#include "tools/check_command.h"

namespace remomask::tools {

namespace {

bool is_index(const std::string& content) {
  return content.ends_with("RMMINDEX") || content.ends_with("RMMDELTA");
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
  const nn::TensorFile file = nn::load_safetensors(path);
  const auto format = file.metadata.find("format");
  const std::string name = format == file.metadata.end() ? "" : format->second;
  return {.kind = name == "remomask-model"        ? "model"
                  : name == "remomask-checkpoint" ? "checkpoint"
                                                  : "safetensors file",
          .content = counted(static_cast<int64_t>(file.tensors.size()), "tensor"),
          .has_checksums = file.has_checksums};
}

}  // namespace

CheckedFile check_core_file(const std::string& path) {
  if (is_index(read_file(path))) return check_index(path);
  return check_tensors(path);
}

}  // namespace remomask::tools
