#include "base/process_settings.h"

#include <sched.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "remomask/settings.h"

namespace remomask {

namespace {

/// Kernels for the Intel processors that Debian's OpenBLAS 0.3.21 does not know; null for others.
const char* openblas_core() {
  __builtin_cpu_init();
  if (!__builtin_cpu_is("intel")) return nullptr;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
    return __builtin_cpu_supports("avx512bf16") ? "Cooperlake" : "SkylakeX";
  }
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? "Haswell" : nullptr;
}

struct LogSink {
  std::mutex mutex;
  LogFunction log = [](const std::string& line) {
    std::fprintf(stderr, "remomask: %s\n", line.c_str());
  };
};

LogSink& log_sink() {
  static LogSink sink;
  return sink;
}

}  // namespace

void visit_recommended_settings(void (*visit)(const char*, const char*, void*), void* data) {
  if (const char* core = openblas_core()) visit("OPENBLAS_CORETYPE", core, data);
  visit("OMP_WAIT_POLICY", "passive", data);
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return;
  static char cpus[16];
  std::snprintf(cpus, sizeof cpus, "%d", CPU_COUNT(&set));
  visit("OMP_NUM_THREADS", cpus, data);
  visit("OPENBLAS_NUM_THREADS", cpus, data);
}

std::vector<Setting> recommended_settings() {
  std::vector<Setting> settings;
  visit_recommended_settings(
      [](const char* name, const char* value, void* data) {
        if (std::getenv(name) != nullptr) return;
        static_cast<std::vector<Setting>*>(data)->push_back({name, value});
      },
      &settings);
  return settings;
}

void set_log(LogFunction log) {
  const std::scoped_lock lock(log_sink().mutex);
  log_sink().log = std::move(log);
}

void log_missing_settings() {
  static std::once_flag once;
  std::call_once(once, [] {
    std::string missing;
    for (const Setting& setting : recommended_settings()) {
      missing += (missing.empty() ? "" : " ") + setting.name + "=" + setting.value;
    }
    if (missing.empty()) return;
    const std::scoped_lock lock(log_sink().mutex);
    if (!log_sink().log) return;
    log_sink().log("runs slower than it could; start the process with " + missing);
  });
}

}  // namespace remomask
