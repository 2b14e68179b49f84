#pragma once

#include <string>
#include <vector>

#include "remomask/motion.h"

namespace remomask::drawing {

/// One motion of a sheet with its text.
struct SheetRow {
  std::string title;     ///< the prompt
  std::string subtitle;  ///< for example the retrieved evidence; may be empty
  Motion motion;         ///< 22 joints, Y up, metres
};

struct SheetOptions {
  std::string heading;          ///< above all rows; may be empty
  int poses = 9;                ///< side by side in a row, 2 .. 24
  int onion_poses = 7;          ///< in the strip where the body moves through space; 0: no strip
  int width = 1800;             ///< pixels
  double camera_azimuth = -46;  ///< degrees around +Y from the front; +Z goes to the right
  double camera_elevation = 14;
  double fps = 20;
};

/// Draws every row as poses over time beside the path through space and writes a PNG atomically.
/// The font is DejaVu Sans (Debian: fonts-dejavu-core) or, without it, the system's substitute.
/// Throws Error if there are no rows, for motions of another skeleton or without frames, and for
/// options out of range.
void write_contact_sheet(const std::string& png_path, const std::vector<SheetRow>& rows,
                         const SheetOptions& options = {});

}  // namespace remomask::drawing
