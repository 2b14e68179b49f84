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
/// Parts in the order of their first line. Throws FileError with the line.
std::vector<TimedCaptions> read_humanml_texts(const std::string& path);

}  // namespace remomask::exchange
