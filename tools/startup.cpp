// Runs before the constructors of any shared library, so that OpenBLAS, libgomp
// and libtorch see these settings: setenv() would be lost (libc resets environ)
// and an initialiser inside a library comes too late, hence one execve.
//  - Debian's OpenBLAS 0.3.21 does not know recent Intel processors and falls
//    back to SSE3 kernels, five times slower. AMD's are recognised.
//  - OpenMP threads that spin while they wait fight with OpenBLAS's own pool.
// Every setting that the user made stays as it is.
#include <sched.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>

extern "C" {

static const char* find_setting(char** environment, const char* name) {
  const size_t length = strlen(name);
  for (; *environment; ++environment) {
    if (strncmp(*environment, name, length) == 0 && (*environment)[length] == '=') {
      return *environment + length + 1;
    }
  }
  return nullptr;
}

static void choose_settings(int, char** arguments, char** environment) {
  if (find_setting(environment, "REMOMASK_STARTED")) return;
  constexpr int kMost = 4096;
  static char* changed[kMost];
  static char omp_threads[64], blas_threads[64];
  int count = 0;
  while (environment[count] && count < kMost - 8) {
    changed[count] = environment[count];
    ++count;
  }
  if (environment[count]) return;
  const int before = count;
  const auto add = [&](const char* setting) { changed[count++] = const_cast<char*>(setting); };

  __builtin_cpu_init();
  if (!find_setting(environment, "OPENBLAS_CORETYPE") && __builtin_cpu_is("intel")) {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
      add(__builtin_cpu_supports("avx512bf16") ? "OPENBLAS_CORETYPE=Cooperlake"
                                               : "OPENBLAS_CORETYPE=SkylakeX");
    } else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
      add("OPENBLAS_CORETYPE=Haswell");
    }
  }
  if (!find_setting(environment, "OMP_WAIT_POLICY")) add("OMP_WAIT_POLICY=passive");
  // Activations of several MB would be mapped and faulted in on every call.
  if (!find_setting(environment, "MALLOC_MMAP_MAX_")) add("MALLOC_MMAP_MAX_=0");
  if (!find_setting(environment, "MALLOC_TRIM_THRESHOLD_")) {
    add("MALLOC_TRIM_THRESHOLD_=2147483647");
  }
  cpu_set_t set;
  CPU_ZERO(&set);
  const int cpus = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
  if (cpus > 0 && !find_setting(environment, "OMP_NUM_THREADS")) {
    snprintf(omp_threads, sizeof omp_threads, "OMP_NUM_THREADS=%d", cpus);
    add(omp_threads);
  }
  if (cpus > 0 && !find_setting(environment, "OPENBLAS_NUM_THREADS")) {
    snprintf(blas_threads, sizeof blas_threads, "OPENBLAS_NUM_THREADS=%d", cpus);
    add(blas_threads);
  }
  if (count == before) return;
  add("REMOMASK_STARTED=1");
  changed[count] = nullptr;
  // Comes back only on failure: then the program runs on, slower.
  execve("/proc/self/exe", arguments, changed);
}

__attribute__((section(".preinit_array"), used)) static void (*run_first)(int, char**,
                                                                          char**) = choose_settings;
}
