#include "tools/markdown_section.h"

#include "base/file.h"
#include "remomask/error.h"

namespace remomask::tools {

void replace_section(const std::string& path, const std::string& name, const std::string& content) {
  const std::string text = read_file(path);
  const std::string begin = "<!-- " + name + ":begin -->\n", end = "<!-- " + name + ":end -->";
  const size_t first = text.find(begin), last = text.find(end);
  if (first == std::string::npos || last == std::string::npos || last < first) {
    throw FileError(path, 0,
                    "has no place for the section: it needs the lines <!-- " + name +
                        ":begin --> and, behind it, <!-- " + name + ":end -->");
  }
  write_file_atomically(path, text.substr(0, first + begin.size()) + content + text.substr(last));
}

}  // namespace remomask::tools
