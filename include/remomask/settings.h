#pragma once

#include <functional>
#include <string>
#include <vector>

#include "remomask/export.h"

namespace remomask {

/// An environment variable and the value that suits this machine.
struct Setting {
  std::string name, value;
};

/// What should be in the environment before the library is loaded: the BLAS kernels of this
/// processor (Debian's OpenBLAS does not know recent Intel processors and falls back to kernels
/// that are five times slower), passive waiting (OpenMP threads that spin fight with OpenBLAS's),
/// and the number of CPUs that the process may use. Variables that are set already are not in the
/// list. The library never sets them itself: a program that links it sets them in its launcher, or
/// executes itself again with them.
REMOMASK_API std::vector<Setting> recommended_settings();

/// Where the library's notes go, for example that it runs slower than it could. Default: standard
/// error. An empty function silences it.
using LogFunction = std::function<void(const std::string& line)>;
REMOMASK_API void set_log(LogFunction log);

}  // namespace remomask
