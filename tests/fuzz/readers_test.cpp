// Every reader of files that may come from strangers gets mutated inputs: it reads them or throws
// an Error, and never anything else. The sanitizer build runs this, too.
//   REMOMASK_FUZZ_INPUTS=N   inputs a reader. Default 200.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <random>

#include "base/file.h"
#include "db/check.h"
#include "exchange/archive.h"
#include "exchange/captions_file.h"
#include "exchange/humanml_texts.h"
#include "exchange/import.h"
#include "formats/sidecar.h"
#include "remomask/motion_file.h"
#include "rig/skeleton_map.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

/// Text of an Acclaim skeleton with two bones, and of a motion of it.
constexpr const char* kSkeleton =
    ":version 1.10\n:name two\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n:root\n"
    "  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n:bonedata\n"
    "  begin\n  id 1\n  name lhipjoint\n  direction 0.6 -0.7 0.3\n  length 2.4\n  axis 0 0 0 XYZ\n"
    "  end\n  begin\n  id 2\n  name lfemur\n  direction 0.3 -0.9 0\n  length 7\n"
    "  axis 0 0 20 XYZ\n  dof rx ry rz\n  limits (-160.0 20.0)\n (-70.0 70.0)\n (-60.0 70.0)\n"
    "  end\n:hierarchy\n  begin\n  root lhipjoint\n  lhipjoint lfemur\n  end\n";
constexpr const char* kAcclaim =
    "#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 9 17 -3 -1 2 3\nlfemur 1 2 3\n2\n"
    "root 9 17 -3 -1 2 3\nlfemur 4 5 6\n";

struct Reader {
  std::string extension;
  std::string seed;  ///< a file that is read
  std::function<void(const std::string& path)> read;
};

class Mutator {
 public:
  explicit Mutator(uint32_t seed) : random_(seed) {}

  std::string operator()(std::string content) {
    for (size_t i = 0, count = 1 + below(4); i < count && !content.empty(); ++i) mutate(content);
    return content;
  }

 private:
  size_t below(size_t limit) { return random_() % limit; }

  void mutate(std::string& content) {
    const size_t at = below(content.size());
    const size_t length = 1 + below(std::min<size_t>(64, content.size() - at));
    static const char* const kWords[] = {"-1", "0", "1e309",   "nan",      "99999999999999999999",
                                         "{",  "[", "\"",      "\n",       "\r",
                                         "#",  "",  "\\u0000", "\xff\xfe", "ROOT x"};
    switch (below(7)) {
      case 0:
        content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
        break;
      case 1:
        content.resize(at);
        break;
      case 2:
        content.erase(at, length);
        break;
      case 3:
        content.insert(at, content.substr(below(content.size()), length));
        break;
      case 4:
        content.replace(at, length, kWords[below(std::size(kWords))]);
        break;
      case 5:
        for (size_t i = at; i < at + std::min<size_t>(length, 8); ++i) content[i] = '\xff';
        break;
      default:
        for (size_t i = at; i < at + std::min<size_t>(length, 8); ++i) content[i] = '\0';
    }
  }

  std::mt19937 random_;
};

class ReadersFuzz : public testing::Test {
 protected:
  /// The file that a writer of ours makes.
  std::string written(const std::string& name) {
    save_motion(folder_ / name, walking_motion(6, 1));
    return read_file(folder_ / name);
  }

  void fuzz(const Reader& reader) {
    const char* text = std::getenv("REMOMASK_FUZZ_INPUTS");
    const long inputs = text != nullptr ? std::atol(text) : 200;
    const std::string path = folder_ / ("input" + reader.extension);
    Mutator mutate(1);
    for (long i = 0; i < inputs; ++i) {
      const std::string content = i == 0 ? reader.seed : mutate(reader.seed);
      write_file_atomically(path, content, Durability::kills);
      try {
        reader.read(path);
      } catch (const Error& error) {
        EXPECT_NE(i, 0) << error.what();
        EXPECT_FALSE(std::string(error.what()).empty());
      } catch (const std::exception& error) {
        const std::string kept = testing::TempDir() + "remomask_fuzz" + reader.extension;
        write_file_atomically(kept, content);
        ADD_FAILURE() << "input " << i << " (kept in " << kept << "): " << error.what();
        return;
      }
    }
  }

  static void load(const std::string& path) { load_motion(path); }

  TestFolder folder_;
};

TEST_F(ReadersFuzz, Bvh) { fuzz({".bvh", written("a.bvh"), load}); }
TEST_F(ReadersFuzz, Npy) { fuzz({".npy", written("a.npy"), load}); }
TEST_F(ReadersFuzz, Npz) { fuzz({".npz", written("a.npz"), load}); }
TEST_F(ReadersFuzz, Glb) { fuzz({".glb", written("a.glb"), load}); }
TEST_F(ReadersFuzz, Vrma) { fuzz({".vrma", written("a.vrma"), load}); }

TEST_F(ReadersFuzz, AcclaimMotion) {
  write_file_atomically(folder_ / "input.asf", kSkeleton);
  fuzz({".amc", kAcclaim, [](const std::string& path) {
          try {
            load_motion(path);
          } catch (const FileError& error) {
            // Two bones are no human body: all that is wrong with the seed.
            if (std::string(error.what()).find("misses") == std::string::npos) return;
          }
        }});
}

TEST_F(ReadersFuzz, AcclaimSkeleton) {
  write_file_atomically(folder_ / "motion.amc", kAcclaim);
  fuzz({".asf", kSkeleton, [&](const std::string& path) {
          std::filesystem::copy_file(path, folder_ / "motion.asf",
                                     std::filesystem::copy_options::overwrite_existing);
          try {
            load_motion(folder_ / "motion.amc");
          } catch (const FileError&) {
            // Not a human body in any case.
          }
        }});
}

TEST_F(ReadersFuzz, Captions) {
  fuzz(
      {".jsonl",
       "{\"clip\": \"a\", \"captions\": [\"a person walks\", \"x\"], \"labels\": {\"k\": [1, {}]}, "
       "\"split\": \"train\"}\n{\"clip\": \"b\", \"captions\": [], \"tags\": [\"t\"]}\n",
       [](const std::string& path) { exchange::CaptionsFile file(path); }});
}

TEST_F(ReadersFuzz, HumanmlTexts) {
  fuzz({".txt", "a person # walks#a/DET person/NOUN#0.0#0.0\nsomeone waves#a/DET#1.5#3.0\n",
        [](const std::string& path) {
          std::vector<std::string> warnings;
          exchange::read_humanml_texts(path, warnings);
        }});
}

TEST_F(ReadersFuzz, SkeletonMaps) {
  fuzz({".json", rig::format_skeleton_maps({rig::shipped_skeleton_maps()[0]}),
        [](const std::string& path) { rig::parse_skeleton_maps(read_file(path), path); }});
}

TEST_F(ReadersFuzz, Sidecar) {
  const nlohmann::json made = {{"seed", "7"}, {"segments", {{{"sentence", "a person walks"}}}}};
  save_motion(folder_ / "input.npy", walking_motion(6, 1));
  formats::write_sidecar(folder_ / "input.npy", made, read_file(folder_ / "input.npy"));
  fuzz({".npy.json", read_file(folder_ / "input.npy.json"),
        [&](const std::string&) { formats::read_sidecar(folder_ / "input.npy"); }});
}

TEST_F(ReadersFuzz, Database) {
  {
    db::Database database(folder_ / "d", db::OpenMode::create);
    db::Clip clip = named_clip("a");
    clip.captions = {"a person walks."};
    clip.tags = {"best"};
    database.add_clip(clip, walking_motion(8, 1));
    database.store_embeddings("r", {{1, {0.6f, 0.8f}, {0.5f}, {1.f, 0.f}}});
  }
  fuzz({".sqlite", read_file(folder_ / "d"), [](const std::string& path) {
          for (const char* ending : {"-wal", "-shm", "-journal"}) {
            std::filesystem::remove(path + ending);
          }
          db::check_database(path);
          const db::Database database(path, db::OpenMode::read_only);
          for (const db::Clip& clip : database.clips()) database.motion(clip.id);
          database.match_captions("person");
          for (const std::string& retriever : database.retrievers()) database.embeddings(retriever);
        }});
}

}  // namespace
}  // namespace remomask
