#include "tests/motion/support.h"
#include "motion/vector.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "kinematics/leg.h"
#include "motion/rotation.h"

namespace remomask::testing_support {

namespace fs = std::filesystem;

namespace {

/// Directions of the 22 bones of one walking pose at `phase`.
std::vector<Vec3> walking_pose(double phase) {
  const double swing = 0.4 * std::sin(phase);
  const auto hanging = [](double angle) { return Vec3(0, -std::cos(angle), std::sin(angle)); };
  std::vector<Vec3> d(22, Vec3::UnitY());
  d[1] = Vec3(0.6, -0.8, 0);
  d[2] = Vec3(-0.6, -0.8, 0);
  d[4] = hanging(swing);
  d[5] = hanging(-swing);
  d[7] = hanging(swing - 0.3 - 0.2 * std::cos(phase));
  d[8] = hanging(-swing - 0.3 + 0.2 * std::cos(phase));
  d[3] = Vec3(0, 1, 0.05);
  d[6] = Vec3(0.03 * std::sin(phase), 1, 0);
  d[10] = d[11] = Vec3(0, -0.3, 1);
  d[12] = Vec3(0.02, 1, 0.1);
  d[13] = Vec3(0.5, 0.8, 0);
  d[14] = Vec3(-0.5, 0.8, 0);
  d[15] = Vec3(0, 0.8, 0.5);
  d[16] = Vec3(1, -0.1, 0.1 * std::sin(phase));
  d[17] = Vec3(-1, -0.1, 0.1 * std::sin(phase));
  d[18] = Vec3(0.2, -1, -0.5 * std::sin(phase));
  d[19] = Vec3(-0.2, -1, 0.5 * std::sin(phase));
  d[20] = Vec3(0.1, -0.9, 0.4 - 0.5 * std::sin(phase));
  d[21] = Vec3(-0.1, -0.9, 0.4 + 0.5 * std::sin(phase));
  for (Vec3& direction : d) direction.normalize();
  return d;
}

Motion make_motion(int frames, double first_phase, double phase_step, double speed,
                   const std::function<double(int)>& heading) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  Vec3 root(0, 0.93, 0);
  for (int t = 0; t < frames; ++t) {
    const Quat turn = motion::yaw_rotation(heading(t));
    const std::vector<Vec3> directions = walking_pose(first_phase + phase_step * t);
    set_joint_position(motion, t, 0, root);
    for (int j = 1; j < skeleton.joints(); ++j) {
      set_joint_position(motion, t, j,
                         joint_position(motion, t, skeleton.parents[j]) +
                             turn * directions[j] * skeleton.bone_lengths[j]);
    }
    root += turn * Vec3(0, 0, speed);
  }
  return motion;
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    path_ =
        (fs::temp_directory_path() / ("remomask-motion-" + std::to_string(::getpid()))).string();
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

std::string shared_data(const std::string& name) {
  const char* chosen = std::getenv("REMOMASK_DATA");
  const fs::path folder =
      chosen ? fs::path(chosen) : fs::path(REMOMASK_SOURCE_DIR) / "../shared/data";
  const fs::path path = folder / name;
  return fs::exists(path) ? path.string() : std::string();
}

const std::string& temporary_folder() {
  static const TemporaryFolder folder;
  return folder.path();
}

Motion make_walker(int frames, const std::function<double(int)>& heading) {
  return make_motion(frames, 0.4, 0.25, 0.05, heading);
}

Motion make_statue(int frames, const std::function<double(int)>& heading) {
  return make_motion(frames, 0, 0, 0, heading);
}

Motion make_swaying_statue(int frames) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = make_statue(frames, [](int) { return 0.0; });
  for (int t = 0; t < frames; ++t) {
    const Vec3 sway(0, -0.05 - 0.04 * std::sin(0.6 * t), 0.03 * std::sin(0.25 * t));
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      const kinematics::Leg leg = kinematics::leg_of(*feet, skeleton, motion, t);
      kinematics::move_foot(motion, t, leg, -sway);
    }
    for (int j = 0; j < motion.joints; ++j) {
      set_joint_position(motion, t, j, joint_position(motion, t, j) + sway);
    }
  }
  return motion;
}

Motion moved(const Motion& motion, double angle, const Vec3& shift, double scale) {
  Motion result = motion;
  const Quat turn = motion::yaw_rotation(angle);
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      set_joint_position(result, t, j, scale * (turn * joint_position(motion, t, j) + shift));
    }
  }
  return result;
}

double largest_difference(const Motion& a, const Motion& b) {
  if (a.frames != b.frames || a.joints != b.joints) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (size_t i = 0; i < a.positions.size(); ++i) {
    largest = std::max<double>(largest, std::abs(a.positions[i] - b.positions[i]));
  }
  return largest;
}

}  // namespace remomask::testing_support
