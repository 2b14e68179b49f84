#include "db/training_set.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <unordered_map>

#include "base/hash.h"
#include "base/machine.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "text/caption_mirror.h"

namespace remomask::db {

namespace {

std::string label_text(const nlohmann::json& labels, const char* key) {
  const auto label = labels.find(key);
  return label != labels.end() && label->is_string() ? label->get<std::string>() : std::string();
}

std::string mirror_name(const Clip& clip) {
  return clip.mirrored && clip.name.starts_with('M') ? clip.name.substr(1) : "M" + clip.name;
}

/// A clip on its way to features.
struct LoadedClip {
  Motion motion;
  size_t first = 0;  ///< place of the clip in the result; a twin comes next
  bool with_twin = false;
};

void fill_features(const LoadedClip& loaded, const Skeleton& skeleton, motion::FeatureMode mode,
                   std::vector<TrainingClip>& result) {
  TrainingClip& clip = result[loaded.first];
  try {
    clip.features = motion::extract_features_all_frames(loaded.motion, skeleton, mode);
    if (loaded.with_twin) {
      result[loaded.first + 1].features = motion::extract_features_all_frames(
          motion::mirror_motion(loaded.motion, skeleton), skeleton, mode);
    }
  } catch (const Error& error) {
    throw Error("clip '" + clip.name + "': " + error.what());
  }
}

TrainingClip mirror_twin(const TrainingClip& original, const std::string& name) {
  TrainingClip twin = original;
  twin.name = name;
  twin.mirrored = !original.mirrored;
  for (std::string& caption : twin.captions) caption = text::mirror_caption(caption);
  // "walk-turn-left" becomes "walk-turn-right".
  twin.content = text::mirror_caption(original.content);
  twin.meaning = text::mirror_caption(original.meaning);
  return twin;
}

}  // namespace

std::string clip_content(const Clip& clip) {
  const std::string content = label_text(clip.labels, "content");
  if (!content.empty()) return content;
  const auto actions = clip.labels.find("actions");
  if (actions == clip.labels.end() || !actions->is_array() || actions->empty()) return "";
  return actions->front().is_string() ? actions->front().get<std::string>() : "";
}

std::vector<TrainingClip> load_training_set(const Database& database,
                                            const TrainingSetOptions& options) {
  if (options.min_frames < 2 || options.max_frames < options.min_frames) {
    throw Error("min_frames must be at least 2, and max_frames not below it");
  }
  const std::vector<Clip> clips = database.clips();
  std::set<std::string> names;
  for (const Clip& clip : clips) names.insert(clip.name);

  std::vector<TrainingClip> result;
  std::vector<LoadedClip> loaded;
  const Skeleton* skeleton = nullptr;
  std::string skeleton_clip;
  const auto listed = [](const std::vector<std::string>& wanted_names, const std::string& name) {
    return std::find(wanted_names.begin(), wanted_names.end(), name) != wanted_names.end();
  };
  // Numbered over all clips, so that sets of different splits agree.
  std::unordered_map<std::string, int> groups;
  for (const Clip& clip : clips) {
    const int group = groups.emplace(clip.group, static_cast<int>(groups.size())).first->second;
    const bool wanted = listed(options.splits, clip.split) &&
                        (options.sources.empty() || listed(options.sources, clip.source));
    if (!wanted || clip.frames < options.min_frames) continue;
    const Skeleton& own = skeleton_named(clip.skeleton);
    if (skeleton && skeleton != &own) {
      throw Error(database.path() + ": clips '" + skeleton_clip + "' and '" + clip.name +
                  "' have different skeletons; keep each skeleton in a database of its own");
    }
    skeleton = &own;
    skeleton_clip = clip.name;

    LoadedClip item;
    item.motion = database.motion(clip.id);
    if (item.motion.frames > options.max_frames) {
      item.motion = slice(item.motion, 0, options.max_frames);
    }
    item.first = result.size();
    TrainingClip training;
    training.clip_id = clip.id;
    training.name = clip.name;
    training.mirrored = clip.mirrored;
    training.split = clip.split;
    training.group = group;
    training.captions = clip.captions;
    training.content = clip_content(clip);
    if (!label_text(clip.labels, "content").empty()) {
      training.meaning = training.content + '/' + label_text(clip.labels, "style");
    }
    training.unseen = label_text(clip.labels, "unseen");
    const std::string twin_name = mirror_name(clip);
    item.with_twin = options.add_mirrored && !names.contains(twin_name);
    result.push_back(training);
    if (item.with_twin) result.push_back(mirror_twin(training, twin_name));
    loaded.push_back(std::move(item));
  }

  std::atomic<size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (size_t i = next++; i < loaded.size(); i = next++) {
      try {
        fill_features(loaded[i], *skeleton, options.mode, result);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (!failure) failure = std::current_exception();
        next = loaded.size();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < available_cpus(); ++i) threads.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return result;
}

std::string training_set_identity(const std::vector<TrainingClip>& clips) {
  std::string text;
  for (const TrainingClip& clip : clips) {
    text += clip.name + '\t' + std::to_string(clip.features.frames) + '\t';
    for (const std::string& caption : clip.captions) text += caption + '\t';
    text += clip.meaning + '\n';
  }
  return content_hash(text);
}

}  // namespace remomask::db
