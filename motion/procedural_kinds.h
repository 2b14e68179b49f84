#pragma once

#include <functional>
#include <string>
#include <vector>

#include "motion/procedural_actions.h"

namespace remomask {

/// One kind of made motion: how it is built, what may be chosen, how it is said.
struct ProceduralKind {
  std::string name;
  std::string side;  ///< "left", "right" or empty
  std::function<Poses(const ProceduralParameters&)> build;
  std::vector<std::string> phrases;      ///< for write_captions
  std::vector<std::string> actions;      ///< labels
  double low_speed = 0, high_speed = 0;  ///< m/s; 0: no path speed
  double shortest = 0, longest = 0;      ///< seconds; 0: the duration follows from the count
  int most = 1;                          ///< repetitions
  bool styles = false;                   ///< energetic, tired, old make sense
};

const std::vector<ProceduralKind>& procedural_kind_table();

}  // namespace remomask
