#include "exchange/motion_source.h"

#include "db/clip_hash.h"
#include "motion/canonical.h"
#include "remomask/error.h"

namespace remomask::exchange {

namespace {

/// Raise it when other positions come out of the same files: the next import
/// then replaces the clips of older ones.
constexpr int kReadingVersion = 1;

}  // namespace

std::string MotionSource::options_fingerprint() const {
  nlohmann::json decisive = {kReadingVersion,     options_.licence,    options_.skeleton_map,
                             options_.min_frames, options_.max_frames, options_.window_overlap};
  // Only where they are used: the fingerprints of other imports stay.
  if (options_.fps) decisive.push_back(*options_.fps);
  if (!options_.root.empty()) decisive.push_back(options_.root);
  return decisive.dump();
}

std::vector<PreparedClip> cut_into_clips(const db::Clip& clip, const Motion& motion,
                                         const Skeleton& skeleton, const WindowOptions& options) {
  if (motion.frames < options.min_frames) {
    throw Error("has " + std::to_string(motion.frames) + " frames at " +
                std::to_string(static_cast<int>(skeleton.fps)) + " per second, at least " +
                std::to_string(options.min_frames) + " are needed");
  }
  const std::vector<ClipWindow> windows = clip_windows(motion.frames, options);
  std::vector<PreparedClip> prepared;
  for (size_t i = 0; i < windows.size(); ++i) {
    PreparedClip item{clip, motion};
    if (windows.size() > 1) {
      item.clip.name += "#" + std::to_string(i);
      item.clip.start_frame += windows[i].first;
      // HumanML3D cuts first too, and puts every clip on the floor.
      item.motion = motion::canonicalize(slice(motion, windows[i].first, windows[i].last), skeleton,
                                         {.uniform_skeleton = false});
    }
    item.clip.frames = item.motion.frames;
    item.clip.skeleton = skeleton.name;
    item.clip.content_hash = db::clip_content_hash(item.motion);
    prepared.push_back(std::move(item));
  }
  return prepared;
}

}  // namespace remomask::exchange
