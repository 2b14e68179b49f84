// Linked into tests and benchmarks, which link libtorch directly. Runs before the constructors of
// any shared library, so that OpenBLAS, libgomp and libtorch see the recommended settings: setenv()
// would be lost (libc resets environ) and an initialiser inside a library comes too late, hence one
// execve. Every setting that the user made stays as it is.
#include <unistd.h>

#include <cstdio>
#include <cstring>

#include "base/process_settings.h"

namespace {

constexpr int kMaxVariables = 4096;

struct Environment {
  char* variables[kMaxVariables];
  char added[8][64];
  int count = 0, additions = 0;
};

bool holds(const Environment& environment, const char* name) {
  const size_t length = strlen(name);
  for (int i = 0; i < environment.count; ++i) {
    const char* variable = environment.variables[i];
    if (strncmp(variable, name, length) == 0 && variable[length] == '=') return true;
  }
  return false;
}

void add_setting(const char* name, const char* value, void* data) {
  auto& environment = *static_cast<Environment*>(data);
  if (environment.additions == 8 || environment.count + 2 >= kMaxVariables) return;
  if (holds(environment, name)) return;
  char* text = environment.added[environment.additions++];
  snprintf(text, sizeof environment.added[0], "%s=%s", name, value);
  environment.variables[environment.count++] = text;
}

void choose_settings(int, char** arguments, char** variables) {
  static Environment environment;
  for (; variables[environment.count]; ++environment.count) {
    if (environment.count + 16 >= kMaxVariables) return;
    environment.variables[environment.count] = variables[environment.count];
  }
  if (holds(environment, "REMOMASK_STARTED")) return;
  remomask::visit_recommended_settings(add_setting, &environment);
  // Activations of several MB would be mapped and faulted in on every call.
  add_setting("MALLOC_MMAP_MAX_", "0", &environment);
  add_setting("MALLOC_TRIM_THRESHOLD_", "2147483647", &environment);
  if (environment.additions == 0) return;
  add_setting("REMOMASK_STARTED", "1", &environment);
  environment.variables[environment.count] = nullptr;
  // Returns only on failure: then the process continues, slower.
  execve("/proc/self/exe", arguments, environment.variables);
}

__attribute__((section(".preinit_array"), used)) void (*run_first)(int, char**,
                                                                   char**) = choose_settings;

}  // namespace
