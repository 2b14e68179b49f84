#include "tools/core.h"

#include <dlfcn.h>
#include <malloc.h>

#include <climits>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "remomask/error.h"
#include "remomask/settings.h"

namespace remomask::tools {

namespace {

namespace fs = std::filesystem;

constexpr const char* kCoreFile = "remomask-core.so";

/// Beside the program in the build tree, in PREFIX/lib/remomask of an installed one.
std::vector<fs::path> core_places() {
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  std::vector<fs::path> places = {folder / kCoreFile};
  for (const char* library : {REMOMASK_LIBRARY_FOLDER, "lib"}) {
    places.push_back(folder / ".." / library / "remomask" / kCoreFile);
  }
  return places;
}

void apply_settings() {
  for (const Setting& setting : recommended_settings()) {
    setenv(setting.name.c_str(), setting.value.c_str(), /*overwrite=*/0);
  }
  // Activations of several MB would be mapped and faulted in on every call.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
}

const Core& load_core(int threads) {
  apply_settings();
  for (const fs::path& place : core_places()) {
    std::error_code ignored;
    if (!fs::exists(place, ignored)) continue;
    void* object = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (object == nullptr) throw Error(std::string("cannot load the core: ") + dlerror());
    const auto entry = reinterpret_cast<CoreEntry>(dlsym(object, "remomask_core"));
    if (entry == nullptr) throw Error(place.string() + ": is not the core of this program");
    return *entry(threads);
  }
  throw Error(std::string(kCoreFile) +
              " was not found beside the program or in its lib/remomask; install it again");
}

}  // namespace

const Core& core(const Program& program) {
  static const Core& loaded = load_core(program.threads);
  return loaded;
}

}  // namespace remomask::tools
