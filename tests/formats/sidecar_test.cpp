#include "formats/sidecar.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/file.h"
#include "formats/motion_writing.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"

namespace remomask {
namespace {

class SidecarTest : public testing::Test {
 protected:
  ~SidecarTest() override {
    std::filesystem::remove(path_);
    std::filesystem::remove(formats::sidecar_path(path_));
  }

  const std::string path_ = testing::TempDir() + "sidecar" + std::to_string(::getpid()) + ".npy";
  const nlohmann::json made_ = {{"seed", "7"}};
};

TEST_F(SidecarTest, BelongsToItsMotionAlone) {
  formats::write_motion(path_, Motion(4, 22), &made_);
  EXPECT_EQ(formats::read_sidecar(path_)->at("seed"), "7");
  const std::string sidecar = read_file(formats::sidecar_path(path_));
  // As a kill between the two files would leave it, if the old one were not removed first.
  save_motion(path_, Motion(5, 22));
  EXPECT_FALSE(formats::read_sidecar(path_));
  write_file_atomically(formats::sidecar_path(path_), sidecar);
  EXPECT_THROW(formats::read_sidecar(path_), FileError);
}

TEST_F(SidecarTest, OfOldVersionsIsTakenAsItIs) {
  save_motion(path_, Motion(4, 22));
  write_file_atomically(formats::sidecar_path(path_), "{\"seed\": \"3\"}");
  EXPECT_EQ(formats::read_sidecar(path_)->at("seed"), "3");
  write_file_atomically(formats::sidecar_path(path_), "{\"seed\": ");
  EXPECT_THROW(formats::read_sidecar(path_), FileError);
}

}  // namespace
}  // namespace remomask
