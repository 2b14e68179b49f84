#pragma once

#include <string>
#include <vector>

namespace remomask::exchange {

/// Captions of one part of a motion, or of all of it.
struct TimedCaptions {
  double from = 0, to = 0;  ///< seconds; both 0: the whole motion
  std::vector<std::string> captions;
};

/// Reads texts/ID.txt of HumanML3D or KIT-ML: lines of caption#tokens#from#to.
/// Fields are counted from the right, as a caption may hold a "#". Parts come in the order of their
/// first line. A line of another form is left out, with a warning that names it. Throws FileError
/// if no line can be used.
std::vector<TimedCaptions> read_humanml_texts(const std::string& path,
                                              std::vector<std::string>& warnings);

}  // namespace remomask::exchange
