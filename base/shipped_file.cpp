#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "remomask/error.h"
#include "remomask/library.h"

namespace remomask {

namespace {

namespace fs = std::filesystem;

/// The folder of the program or shared library that holds this function.
fs::path own_folder() {
  Dl_info info{};
  std::error_code ignored;
  if (dladdr(reinterpret_cast<void*>(&own_folder), &info) == 0) return {};
  return fs::canonical(info.dli_fname, ignored).parent_path();
}

/// Where the files are that came with a program or library in `folder`: installed in PREFIX/bin,
/// PREFIX/lib, PREFIX/lib/remomask or PREFIX/lib/TRIPLET, or built inside the source tree.
std::vector<fs::path> candidate_folders(fs::path folder) {
  std::vector<fs::path> result = {folder / "models"};
  for (int up = 0; up < 4 && folder.has_relative_path(); ++up) {
    folder = folder.parent_path();
    result.push_back(folder / "share" / "remomask");
    result.push_back(folder / "models");
  }
  return result;
}

}  // namespace

std::string shipped_file(const std::string& name) {
  if (const char* chosen = std::getenv("REMOMASK_MODELS")) {
    const fs::path path = fs::path(chosen) / name;
    if (fs::exists(path)) return path.string();
    throw Error("REMOMASK_MODELS names the folder \"" + std::string(chosen) +
                "\", which does not hold " + name + "; correct the variable or unset it");
  }
  for (const fs::path& folder : candidate_folders(own_folder())) {
    std::error_code ignored;
    if (fs::exists(folder / name, ignored)) return (folder / name).string();
  }
  throw Error("the shipped file " + name +
              " was not found; set REMOMASK_MODELS to the folder that holds it, or name a file");
}

std::string shipped_model() { return shipped_file("base.safetensors"); }
std::string shipped_database() { return shipped_file("motions.sqlite"); }

}  // namespace remomask
