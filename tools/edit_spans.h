#pragma once

#include <string>
#include <vector>

#include "remomask/generation.h"

namespace remomask::tools {

/// Spans as they are written on the command line, for a motion of `frames`
/// frames at 20 fps. `spans`: "A-B[,C-D ...]" in seconds, either end may be "start" or
/// "end"; "": all of the motion, if parts are named. `parts`: see parse_body_parts(); none:
/// the whole body. `cells`: "A-B:part,part ..." each, with spans of their own. Frames are
/// those nearest to the times. Throws Error that quotes what cannot be read, and for spans that
/// are empty or outside of the motion.
std::vector<EditSpan> parse_edit_spans(const std::string& spans,
                                       const std::vector<std::string>& parts,
                                       const std::vector<std::string>& cells, int frames);

}  // namespace remomask::tools
