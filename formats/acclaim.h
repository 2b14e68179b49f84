#pragma once

#include <string>
#include <vector>

#include "rig/source_motion.h"

namespace remomask::formats {

/// A motion in the format of Acclaim: an .asf file with the skeleton, an .amc file with its frames.
struct AcclaimMotion {
  rig::SourceMotion source;  ///< rate 0 where the .amc file states none
  std::vector<std::string> warnings;
};

/// Path of the skeleton of an .amc file: the .asf of the same name or of the part before the last
/// "_" (CMU's 01_10.amc belongs to 01.asf), else the only .asf in the folder. Throws FileError that
/// says where it was looked for.
std::string find_asf(const std::string& amc_path);

/// Reads an .amc file with the skeleton that find_asf() finds. Throws FileError with the line of
/// either file.
AcclaimMotion read_amc(const std::string& path);

/// The same from texts; the paths appear in messages.
AcclaimMotion parse_acclaim(const std::string& asf, const std::string& asf_path,
                            const std::string& amc, const std::string& amc_path);

}  // namespace remomask::formats
