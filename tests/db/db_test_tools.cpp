#include "tests/db/db_test_tools.h"

#include <sqlite3.h>
#include <stdlib.h>

#include <cmath>

#include "db/page_checksums.h"
#include "motion/canonical.h"
#include "motion/vector.h"

namespace remomask {

Motion walking_motion(int frames, int seed) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  const double step = 0.01 + 0.002 * (seed % 7), swing = 0.1 + 0.01 * (seed % 11);
  for (int frame = 0; frame < frames; ++frame) {
    const double phase = 0.3 * frame + 0.1 * seed;
    std::vector<Vec3> joints(static_cast<size_t>(skeleton.joints()), Vec3(0, 1, step * frame));
    for (int joint = 1; joint < skeleton.joints(); ++joint) {
      const auto j = static_cast<size_t>(joint);
      Vec3 direction = rest_direction(skeleton, j);
      direction.z() += swing * std::sin(phase + joint);
      joints[j] = joints[static_cast<size_t>(skeleton.parents[j])] +
                  skeleton.bone_lengths[j] * direction.normalized();
    }
    for (int joint = 0; joint < skeleton.joints(); ++joint) {
      set_joint_position(motion, frame, joint, joints[static_cast<size_t>(joint)]);
    }
  }
  return motion::canonicalize(motion, skeleton);
}

db::Clip named_clip(const std::string& name) {
  db::Clip clip;
  clip.name = name;
  clip.source = "test";
  clip.source_file = name;
  clip.split = "train";
  clip.licence = "CC0";
  clip.group = "test/" + name;
  clip.captions = {"a person walks.", "someone is walking left."};
  clip.labels = {{"content", "walk"}, {"actions", {"walk", "turn"}}};
  return clip;
}

void run_sql(const std::string& path, const char* sql) {
  sqlite3* handle = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  ASSERT_EQ(sqlite3_open_v2(path.c_str(), &handle, flags, db::page_checksum_vfs()), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(handle);
  sqlite3_close(handle);
}

nlohmann::json describe_database(const db::Database& database) {
  nlohmann::json all = nlohmann::json::array();
  for (const db::Clip& clip : database.clips()) {
    all.push_back({clip.name, clip.source, clip.source_file, clip.start_frame, clip.split,
                   clip.licence, clip.content_hash, clip.group, clip.mirrored, clip.skeleton,
                   clip.frames, clip.captions, clip.labels, clip.tags,
                   database.motion(clip.id).positions});
  }
  return all;
}

}  // namespace remomask
