#pragma once

namespace remomask {

/// CPUs that this process may use (affinity respected), at least 1.
int available_cpus();

}  // namespace remomask
