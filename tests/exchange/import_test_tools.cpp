#include "tests/exchange/import_test_tools.h"

#include <algorithm>

#include "base/file.h"
#include "remomask/motion_file.h"

namespace remomask {

std::string caption_line(const std::string& clip, const std::string& split, nlohmann::json labels) {
  const nlohmann::json line = {{"clip", clip},
                               {"captions", {"the motion " + clip, "it is " + clip}},
                               {"labels", std::move(labels)},
                               {"split", split}};
  return line.dump() + "\n";
}

exchange::ImportOptions make_walks(const TestFolder& folder, int count,
                                   const std::string& extension) {
  std::filesystem::create_directories(folder / "walks/deeper");
  std::string lines;
  for (int i = 0; i < count; ++i) {
    const std::string name = "walk_" + std::to_string(1000 + i);
    save_motion(folder / ((i % 3 ? "walks/" : "walks/deeper/") + name + extension),
                walking_motion(24 + i % 5, i));
    lines += caption_line(name, i % 4 ? "train" : "test", {{"content", "walk"}, {"number", i}});
  }
  write_file_atomically(folder / "walks.jsonl", lines);
  exchange::ImportOptions options;
  options.folder = folder / "walks";
  options.licence = "CC0";
  options.threads = 2;
  return options;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(),
                     [&](const std::string& text) { return text.find(part) != text.npos; });
}

}  // namespace remomask
