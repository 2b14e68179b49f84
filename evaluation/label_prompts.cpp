#include "evaluation/label_prompts.h"

#include <map>

#include "base/random.h"
#include "db/training_set.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

/// Clips of one content in the order in which they are taken.
struct ContentClips {
  std::vector<const db::Clip*> clips;
  size_t taken = 0;
};

}  // namespace

PromptDraw parse_prompt_draw(const std::string& name) {
  if (name == "even") return PromptDraw::even;
  if (name == "uniform") return PromptDraw::uniform;
  throw Error("unknown draw of prompts \"" + name + "\"; use even or uniform");
}

std::vector<LabelPrompt> choose_label_prompts(const std::vector<db::Clip>& clips,
                                              const std::string& split, int count, uint64_t seed,
                                              PromptDraw draw) {
  std::map<std::string, std::vector<const db::Clip*>> by_content;
  for (const db::Clip& clip : clips) {
    if (clip.split != split || clip.mirrored || clip.captions.empty()) continue;
    if (const std::string content = db::clip_content(clip); !content.empty()) {
      // A uniform draw has all clips in one class, whatever their content.
      by_content[draw == PromptDraw::even ? content : ""].push_back(&clip);
    }
  }
  if (by_content.empty()) {
    throw Error("no clip of the split '" + split +
                "' has both a caption and a content label; choose another split");
  }
  std::vector<std::pair<std::string, ContentClips>> turns;
  for (const auto& [content, members] : by_content) {
    ContentClips ordered;
    CounterRandom random(seed, turns.size());
    for (const size_t i : random.permutation(members.size())) ordered.clips.push_back(members[i]);
    turns.emplace_back(content, std::move(ordered));
  }
  size_t usable = 0;
  for (const auto& [content, source] : turns) usable += source.clips.size();
  const size_t wanted = count > 0 ? static_cast<size_t>(count) : usable;
  std::vector<LabelPrompt> prompts;
  for (size_t turn = 0; prompts.size() < wanted; ++turn) {
    ContentClips& source = turns[turn % turns.size()].second;
    if (count == 0 && source.taken == source.clips.size()) continue;
    const db::Clip& clip = *source.clips[source.taken % source.clips.size()];
    const size_t round = source.taken / source.clips.size();
    ++source.taken;
    const std::string unseen = clip.labels.value("unseen", "");
    const size_t first = CounterRandom(mix_seed(seed, static_cast<uint64_t>(clip.id), 1))
                             .below(clip.captions.size());
    prompts.push_back(
        {clip.id, clip.name, clip.group, clip.captions[(first + round) % clip.captions.size()],
         db::clip_content(clip), unseen, clip.frames, mix_seed(seed, prompts.size(), 2)});
  }
  return prompts;
}

}  // namespace remomask::evaluation
