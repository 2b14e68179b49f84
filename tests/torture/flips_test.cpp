// Flips single bits of every kind of file that is written: `remomask check` notices each one, and
// who reads the file refuses it or gives the same answer as before.
//   REMOMASK_FLIPS=N   flips of a kind. Default 24.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <random>

#include "base/file.h"
#include "remomask/error.h"
#include "tests/torture/folder_state.h"
#include "tests/torture/shared_folder.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

constexpr size_t kFilesAtOnce = 50;
constexpr size_t kFlipsOfAnAnswer = 8;  ///< of so many flips one is put to a command that reads

size_t chosen_flips() {
  const char* text = std::getenv("REMOMASK_FLIPS");
  return text != nullptr ? std::stoul(text) : 24;
}

struct Flip {
  size_t byte;
  int bit;
  std::string apply(std::string content) const {
    content[byte] = static_cast<char>(content[byte] ^ 1 << bit);
    return content;
  }
};

/// Half of them anywhere, half in the first kilobytes and the last, where headers and ids lie.
std::vector<Flip> random_flips(size_t bytes, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Flip> flips;
  for (size_t i = 0; i < count; ++i) {
    const size_t near = std::min<size_t>(bytes, 4096);
    size_t at = random() % (i % 2 == 0 ? bytes : near);
    if (i % 4 == 3) at = bytes - 1 - at;
    flips.push_back({at, static_cast<int>(random() % 8)});
  }
  return flips;
}

class Flips : public testing::Test {
 protected:
  void SetUp() override { SharedFolder::instance().need_model(); }

  static std::string shared(const std::string& name) {
    return SharedFolder::instance().path() + "/" + name;
  }

  /// Flips bits of `flipped`, which `check` is told of as `checked` (the same file, or one that
  /// belongs to it); `beside` are further files that lie beside it.
  void try_flips(const std::string& flipped, const std::string& checked,
                 const std::vector<std::string>& beside, const Words& answer) {
    const std::string sound = read_file(shared(flipped));
    const auto flips = random_flips(sound.size(), chosen_flips(), 1);
    const std::string right = answer.empty() ? "" : answer_of(answer, shared(""));
    for (size_t begin = 0; begin < flips.size(); begin += kFilesAtOnce) {
      const TestFolder scratch;
      Words command = {"--json", "check"};
      const size_t end = std::min(flips.size(), begin + kFilesAtOnce);
      for (size_t i = begin; i < end; ++i) {
        const std::string folder = (scratch / std::to_string(i)) + "/";
        fs::create_directories(folder);
        for (const std::string& name : beside) fs::copy_file(shared(name), folder + name);
        write_file_atomically(folder + flipped, flips[i].apply(sound), Durability::kills);
        command.push_back(folder + checked);
      }
      const nlohmann::json report = nlohmann::json::parse(run_program(command).output);
      for (size_t i = begin; i < end; ++i) {
        const std::string place = flipped + ", byte " + std::to_string(flips[i].byte) + " of " +
                                  std::to_string(sound.size()) + ", bit " +
                                  std::to_string(flips[i].bit);
        EXPECT_FALSE(report.at("files").at(i - begin).at("defects").empty()) << place;
        if (answer.empty() || i % kFlipsOfAnAnswer != 0) continue;
        const std::string given = answer_of(answer, (scratch / std::to_string(i)) + "/");
        EXPECT_TRUE(given.empty() || given == right) << place << given;
      }
    }
    std::cout << "flips: " << flips.size() << " of " << flipped << "\n";
  }

  /// What a command that reads the files of a folder prints, or nothing if it refuses them.
  static std::string answer_of(const Words& words, const std::string& folder) {
    const ProgramResult run =
        run_program(in_folders(words, folder, SharedFolder::instance().path()));
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 1) << run.exit_code << run.errors;
    return run.exit_code == 0 ? run.output : "";
  }
};

TEST_F(Flips, OfADatabase) {
  try_flips("m.sqlite", "m.sqlite", {}, {"db", "list", "@m.sqlite", "--words", "walks", "--json"});
}

TEST_F(Flips, OfAnIndex) {
  try_flips("m.sqlite.index", "m.sqlite.index", {},
            {"search", "a person walks", "--db", "%/m.sqlite", "--index", "@m.sqlite.index",
             "--model", "%/model.safetensors", "--quiet"});
}

TEST_F(Flips, OfWhatAnIndexGotSince) {
  if (!fs::exists(shared("e.sqlite.index.delta"))) {
    for (const char* name : {"m.sqlite", "m.sqlite.index"}) {
      std::string copy = name;
      copy[0] = 'e';
      write_file_atomically(shared(copy), read_file(shared(name)));
    }
    SharedFolder::instance().run({"db", "remove", "%/e.sqlite", "#3", "--yes"});
    SharedFolder::instance().run({"index", "%/e.sqlite", "--model", "%/model.safetensors"});
  }
  try_flips("e.sqlite.index.delta", "e.sqlite.index.delta", {"e.sqlite.index"}, {});
}

TEST_F(Flips, OfAModel) {
  try_flips("model.safetensors", "model.safetensors", {},
            {"search", "a person walks", "--db", "%/m.sqlite", "--model", "@model.safetensors",
             "--quiet"});
}

TEST_F(Flips, OfATextFile) {
  SharedFolder::instance().run({"import-text", REMOMASK_SOURCE_DIR "/tests/fuzz/corpus/encoder",
                                "-o", "%/imported.safetensors"});
  try_flips("imported.safetensors", "imported.safetensors", {}, {});
}

TEST_F(Flips, OfACheckpoint) {
  const Words train = in_folders({"train", "tokenizer", "--db", "%/m.sqlite", "--preset", "tiny",
                                  "--steps", "5", "-o", "%/stopped", "--quiet"},
                                 "", SharedFolder::instance().path());
  // Killed as it begins to write the second checkpoint, or later.
  const std::string checkpoint = "tokenizer.safetensors.checkpoint";
  for (int call = 12; !fs::exists(shared("stopped/" + checkpoint)) && call < 60; call += 4) {
    run_program(train, {{"LD_PRELOAD", REMOMASK_INTERPOSE},
                        {"REMOMASK_CLOCK_STEP", "61"},
                        {"REMOMASK_FAULT", "kill"},
                        {"REMOMASK_CALL", std::to_string(call)}});
  }
  fs::rename(shared("stopped/" + checkpoint), shared(checkpoint));
  try_flips(checkpoint, checkpoint, {}, {});
}

TEST_F(Flips, OfAMotionOrItsSidecar) {
  SharedFolder::instance().run({"generate", "a person walks", "--seconds", "2", "--steps", "2",
                                "--db", "%/m.sqlite", "--model", "%/model.safetensors", "-o",
                                "%/made.npy", "--force"});
  try_flips("made.npy", "made.npy", {"made.npy.json"}, {});
  try_flips("made.npy.json", "made.npy", {"made.npy"}, {});
}

}  // namespace
}  // namespace remomask
