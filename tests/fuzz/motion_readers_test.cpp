// Readers of motion files.
#include <filesystem>

#include "formats/acclaim.h"
#include "formats/bvh.h"
#include "formats/npy.h"
#include "formats/sidecar.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tests/db/db_test_tools.h"
#include "tests/fuzz/fuzz_test_tools.h"

namespace remomask {
namespace {

class MotionReaderFuzz : public ReaderFuzz {
 protected:
  /// Whole files, as the program reads them.
  void fuzz_files(const std::string& extension, int weight, std::vector<std::string> seeds) {
    fuzz(std::move(seeds), weight,
         [&](const std::string& content) { load_motion(place("input" + extension, content)); });
  }

  std::vector<std::string> seeds_of(const std::string& name, const std::string& kind) {
    std::vector<std::string> seeds = corpus(kind);
    seeds.push_back(written(name));
    return seeds;
  }
};

// Those of the corpus are no bodies: they are for the syntax.
TEST_F(MotionReaderFuzz, Bvh) { fuzz_files(".bvh", 2, {written("a.bvh")}); }
TEST_F(MotionReaderFuzz, Npy) { fuzz_files(".npy", 10, seeds_of("a.npy", "npy")); }
TEST_F(MotionReaderFuzz, Npz) { fuzz_files(".npz", 2, seeds_of("a.npz", "npz")); }
TEST_F(MotionReaderFuzz, Gltf) { fuzz_files(".gltf", 1, corpus("gltf")); }
TEST_F(MotionReaderFuzz, Glb) { fuzz_files(".glb", 1, {written("a.glb")}); }
TEST_F(MotionReaderFuzz, Vrma) { fuzz_files(".vrma", 1, seeds_of("a.vrma", "vrma")); }
TEST_F(MotionReaderFuzz, Fbx) { fuzz_files(".fbx", 1, {written("a.fbx")}); }

TEST_F(MotionReaderFuzz, BvhSyntax) {
  fuzz(corpus("bvh"), 100,
       [](const std::string& content) { formats::parse_bvh(content, "a.bvh"); });
}

TEST_F(MotionReaderFuzz, NpySyntax) {
  fuzz(corpus("npy"), 200,
       [](const std::string& content) { formats::parse_npy(content, "a.npy"); });
}

TEST_F(MotionReaderFuzz, AcclaimMotion) {
  const std::string skeleton = corpus("asf").front();
  fuzz(corpus("amc"), 40, [&](const std::string& content) {
    formats::parse_acclaim(skeleton, "a.asf", content, "a.amc");
  });
}

TEST_F(MotionReaderFuzz, AcclaimSkeleton) {
  const std::string motion = corpus("amc").front();
  fuzz(corpus("asf"), 40, [&](const std::string& content) {
    formats::parse_acclaim(content, "a.asf", motion, "a.amc");
  });
}

TEST_F(MotionReaderFuzz, Sidecar) {
  const std::string motion = place("input.npy", written("a.npy"));
  const nlohmann::json made = {{"seed", "7"}, {"segments", {{{"sentence", "a person walks"}}}}};
  formats::write_sidecar(motion, made, written("a.npy"));
  std::vector<std::string> seeds = corpus("sidecar");
  seeds.push_back(read_file(motion + ".json"));
  fuzz(seeds, 10, [&](const std::string& content) {
    place("input.npy.json", content);
    formats::read_sidecar(motion);
  });
}

}  // namespace
}  // namespace remomask
