#include "formats/npz_writer.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include "formats/foot_contacts.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"

namespace remomask::formats {

namespace {

/// A zip archive of .npy files, as numpy.savez writes it.
class NpzArchive {
 public:
  NpzArchive() : archive_(archive_write_new(), archive_write_free) {
    check(archive_write_set_format_zip(archive_.get()));
    check(archive_write_set_options(archive_.get(), "zip:compression=deflate"));
    // Unpadded, or zip readers would find zeros behind the directory.
    check(archive_write_set_bytes_per_block(archive_.get(), 0));
    check(archive_write_open(archive_.get(), &bytes_, nullptr, append, nullptr));
  }

  void add_floats(const char* name, const std::vector<size_t>& shape,
                  const std::vector<float>& values) {
    add(name, "<f4", shape, values.data(), values.size() * sizeof(float));
  }
  void add_numbers(const char* name, const std::vector<size_t>& shape,
                   const std::vector<double>& values) {
    add(name, "<f8", shape, values.data(), values.size() * sizeof(double));
  }
  void add_integers(const char* name, const std::vector<int>& values) {
    add(name, "<i4", {values.size()}, values.data(), values.size() * sizeof(int));
  }
  void add_flags(const char* name, const std::vector<size_t>& shape,
                 const std::vector<unsigned char>& values) {
    add(name, "|b1", shape, values.data(), values.size());
  }
  /// ASCII texts; one text without dimensions where `single`.
  void add_texts(const char* name, const std::vector<std::string>& texts, bool single = false) {
    size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::vector<uint32_t> letters(texts.size() * longest, 0);  // NumPy's texts are UTF-32
    for (size_t i = 0; i < texts.size(); ++i) {
      std::copy(texts[i].begin(), texts[i].end(), letters.begin() + static_cast<long>(i * longest));
    }
    const std::vector<size_t> shape = single ? std::vector<size_t>{} : std::vector{texts.size()};
    add(name, fmt::format("<U{}", longest), shape, letters.data(),
        letters.size() * sizeof(uint32_t));
  }

  std::string finish() {
    check(archive_write_close(archive_.get()));
    return std::move(bytes_);
  }

 private:
  static la_ssize_t append(archive*, void* bytes, const void* data, size_t size) {
    static_cast<std::string*>(bytes)->append(static_cast<const char*>(data), size);
    return static_cast<la_ssize_t>(size);
  }

  void check(int result) {
    if (result == ARCHIVE_OK) return;
    const char* why = archive_error_string(archive_.get());
    throw Error(fmt::format("the zip archive cannot be made: {}", why ? why : "unknown reason"));
  }

  void add(const char* name, const std::string& type, const std::vector<size_t>& shape,
           const void* data, size_t size) {
    std::string content = header(type, shape);
    content.append(static_cast<const char*>(data), size);
    const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(),
                                                                         archive_entry_free);
    archive_entry_set_pathname(entry.get(), (std::string(name) + ".npy").c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    constexpr time_t kFirstOf1980 = 315532800;  // what zip can hold; the same bytes every time
    archive_entry_set_mtime(entry.get(), kFirstOf1980, 0);
    check(archive_write_header(archive_.get(), entry.get()));
    const la_ssize_t written = archive_write_data(archive_.get(), content.data(), content.size());
    check(written == static_cast<la_ssize_t>(content.size()) ? ARCHIVE_OK : ARCHIVE_FATAL);
  }

  static std::string header(const std::string& type, const std::vector<size_t>& shape) {
    std::string dimensions;
    for (const size_t size : shape) dimensions += fmt::format("{}, ", size);
    std::string text =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, dimensions);
    constexpr size_t kPreamble = 10, kAlignment = 64;
    text.append((kAlignment - (kPreamble + text.size() + 1) % kAlignment) % kAlignment, ' ');
    text += '\n';
    std::string result("\x93NUMPY\x01\x00", 8);
    result += static_cast<char>(text.size() & 0xFF);
    result += static_cast<char>(text.size() >> 8);
    return result + text;
  }

  std::string bytes_;
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

Vec3 axis_angle(Quat rotation) {
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace

std::string write_amass_npz(const JointRotations& motion) {
  constexpr size_t kBody = 63, kHands = 90, kAll = 3 + kBody + kHands, kBetas = 16;
  const Quat upright(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));  // Y up to Z up
  const auto frames = static_cast<size_t>(motion.frames);
  std::vector<double> trans, root, body, poses;
  for (int t = 0; t < motion.frames; ++t) {
    const rig::WorldPose world = rig::world_pose(motion, t);
    constexpr size_t kPelvis = 1;  // the root joint comes first
    const Vec3 place = upright * world.positions[kPelvis];
    trans.insert(trans.end(), place.data(), place.data() + 3);
    for (size_t j = kPelvis; j < motion.parents.size(); ++j) {
      const Vec3 turn =
          axis_angle(j == kPelvis ? upright * world.rotations[j]
                                  : rig::to_quat(motion.rotation(t, static_cast<int>(j))));
      std::vector<double>& part = j == kPelvis ? root : body;
      part.insert(part.end(), turn.data(), turn.data() + 3);
      poses.insert(poses.end(), turn.data(), turn.data() + 3);
    }
    poses.resize(poses.size() + kHands, 0);
  }
  NpzArchive archive;
  archive.add_numbers("trans", {frames, 3}, trans);
  archive.add_numbers("poses", {frames, kAll}, poses);
  archive.add_numbers("root_orient", {frames, 3}, root);
  archive.add_numbers("pose_body", {frames, kBody}, body);
  archive.add_numbers("pose_hand", {frames, kHands}, std::vector<double>(frames * kHands, 0));
  archive.add_numbers("betas", {kBetas}, std::vector<double>(kBetas, 0));
  archive.add_texts("gender", {"neutral"}, true);
  // Both spellings are in use, and most loaders know only one of them.
  archive.add_numbers("mocap_framerate", {}, {motion.fps});
  archive.add_numbers("mocap_frame_rate", {}, {motion.fps});
  archive.add_texts("surface_model_type", {"smplh"}, true);
  archive.add_texts("approximated",
                    {"rotations over the T-pose of remomask's skeleton of 22 joints, not fitted to "
                     "SMPL-H; trans is the pelvis; shape and hands are zero"},
                    true);
  return archive.finish();
}

std::string write_motion_npz(const JointRotations& motion) {
  const Motion places = rig::joint_positions(motion);
  const auto frames = static_cast<size_t>(motion.frames);
  const auto joints = static_cast<size_t>(places.joints), all = motion.parents.size();
  NpzArchive archive;
  std::vector<float> turns, root, rest;
  for (const Quaternion& q : motion.rotations) turns.insert(turns.end(), q.begin(), q.end());
  for (const Vector3& v : motion.root) root.insert(root.end(), v.begin(), v.end());
  for (const Vector3& v : motion.rest_offsets) rest.insert(rest.end(), v.begin(), v.end());
  std::vector<unsigned char> contacts;
  for (const std::array<bool, 2>& stands : foot_contacts(places)) {
    contacts.insert(contacts.end(), stands.begin(), stands.end());
  }
  archive.add_floats("positions", {frames, joints, 3}, places.positions);
  archive.add_floats("rotations", {frames, all, 4}, turns);
  archive.add_floats("root", {frames, 3}, root);
  archive.add_floats("rest_offsets", {all, 3}, rest);
  archive.add_flags("contacts", {frames, 2}, contacts);
  archive.add_texts("joint_names", motion.joint_names);
  archive.add_integers("parents", motion.parents);
  archive.add_numbers("fps", {}, {motion.fps});
  return archive.finish();
}

}  // namespace remomask::formats
