#include "base/leftovers.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

#include "base/hash.h"

namespace remomask {

namespace {

namespace fs = std::filesystem;

/// A folder can be shared by machines, which cannot see each other's processes.
const std::string& machine_tag() {
  static const std::string tag = [] {
    char name[256] = {};
    ::gethostname(name, sizeof name - 1);
    return content_hash(name).substr(0, 8) + "-";
  }();
  return tag;
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Whether a name holds the marker and the tag of a process of this machine that is gone.
bool is_leftover(const std::string& name, std::string_view marker) {
  const size_t at = name.find(marker);
  if (at == std::string::npos) return false;
  const std::string_view rest = std::string_view(name).substr(at + marker.size());
  if (!rest.starts_with(machine_tag())) return false;
  const std::string_view digits = rest.substr(machine_tag().size());
  pid_t process = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), process);
  if (read.ec != std::errc() || process <= 0) return false;
  const bool ends = read.ptr == digits.data() + digits.size() || *read.ptr == '-';
  return ends && !is_running(process);
}

bool is_first_look(const std::string& folder, std::string_view marker) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  const std::scoped_lock lock(mutex);
  return seen.insert(folder + "\n" + std::string(marker)).second;
}

}  // namespace

std::string process_tag() { return machine_tag() + std::to_string(::getpid()); }

void remove_leftovers(const std::string& folder, std::string_view marker) {
  if (!is_first_look(folder, marker)) return;
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    if (ignored) break;
    if (is_leftover(entry->path().filename().string(), marker)) leftovers.push_back(entry->path());
  }
  for (const fs::path& path : leftovers) fs::remove_all(path, ignored);
}

}  // namespace remomask
