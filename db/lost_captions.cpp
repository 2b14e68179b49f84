#include "db/lost_captions.h"

#include <algorithm>
#include <set>

#include "base/counted.h"

namespace remomask::db {

std::string lost_captions_warning(const Clip& clip, const Clip& same) {
  const std::set<std::string> known(same.captions.begin(), same.captions.end());
  const auto is_new = [&](const std::string& caption) { return !known.contains(caption); };
  const auto count = std::count_if(clip.captions.begin(), clip.captions.end(), is_new);
  if (count == 0) return "";
  return counted(count, "caption") + " that '" + same.name +
         "' does not have: not stored, as the motion is a duplicate";
}

}  // namespace remomask::db
