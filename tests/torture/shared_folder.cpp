#include "tests/torture/shared_folder.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace remomask {

namespace fs = std::filesystem;

SharedFolder& SharedFolder::instance() {
  static SharedFolder folder;
  return folder;
}

SharedFolder::SharedFolder() {
  fs::create_directories(path());
  run({"procedural", "--db", "%/d.sqlite", "--count", "6"});
  run({"db", "export", "%/d.sqlite", "%/files"});
  std::vector<std::string> motions;
  for (const auto& entry : fs::directory_iterator(path() + "/files")) {
    if (entry.path().extension() == ".npy") motions.push_back(entry.path().string());
  }
  fs::copy_file(*std::min_element(motions.begin(), motions.end()), path() + "/first.npy");
}

void SharedFolder::need_model() {
  if (fs::exists(path() + "/model.safetensors")) return;
  run({"procedural", "--db", "%/m.sqlite", "--count", "40"});
  run({"train", "all", "--db", "%/m.sqlite", "--preset", "tiny", "--steps", "4", "-o", "%/run"});
  run({"index", "%/m.sqlite", "--model", "%/run/model.safetensors"});
  fs::rename(path() + "/run/model.safetensors", path() + "/model.safetensors");
}

void SharedFolder::run(const Words& words) {
  Words command = in_folders(words, "", path());
  command.push_back("--quiet");
  const ProgramResult result = run_program(command);
  if (result.exit_code != 0) throw std::runtime_error(result.errors);
}

}  // namespace remomask
