#pragma once

#include <cstdlib>
#include <string>

namespace remomask {

/// The file that the environment variable names, otherwise the shipped one of models/.
inline std::string file_named(const char* variable, const char* shipped) {
  const char* chosen = std::getenv(variable);
  return chosen ? chosen : std::string(REMOMASK_SOURCE_DIR) + "/models/" + shipped;
}

}  // namespace remomask
