#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"

namespace remomask::evaluation {

/// A content is rare below so many training clips (mirror twins not counted).
inline constexpr int kRareClips = 20;

/// One text to generate from, with the clip that it was written for.
struct LabelPrompt {
  int64_t clip_id = 0;
  std::string clip;     ///< its name
  std::string group;    ///< Clip::group of that clip
  std::string text;     ///< one of its captions
  std::string content;  ///< clip_content of that clip
  std::string unseen;   ///< label "unseen" of that clip: "take", "pair" or ""
  int frames = 0;       ///< of that clip, for generators that want the true length
  uint64_t seed = 0;    ///< for the generation
};

/// even: spread over the contents, so that rare ones weigh as much as common ones;
/// uniform: every clip is equally likely.
enum class PromptDraw { even, uniform };
PromptDraw parse_prompt_draw(const std::string& name);

/// `count` prompts from the clips of `split`. Uniform: in random order. Even: in turn
/// through the contents (alphabetical), each giving its clips in random order;
/// clips come again, with another caption where they have one, when all were
/// taken; `count` 0: every clip once. Mirror copies and clips without content or
/// caption are left out. A function of the arguments alone. Throws Error when no clip is left.
std::vector<LabelPrompt> choose_label_prompts(const std::vector<db::Clip>& clips,
                                              const std::string& split, int count, uint64_t seed,
                                              PromptDraw draw = PromptDraw::even);

}  // namespace remomask::evaluation
