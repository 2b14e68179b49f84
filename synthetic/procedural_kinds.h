#pragma once

#include <functional>
#include <string>
#include <vector>

#include "synthetic/procedural_actions.h"

namespace remomask::synthetic {

/// One kind of made motion: how it is built, what may be chosen, how it is said.
struct ProceduralKind {
  std::string name;
  std::string side = {};  ///< "left", "right" or empty
  std::function<Poses(const ProceduralParameters&)> build;
  std::vector<std::string> phrases;  ///< for write_captions
  std::vector<std::string>
      actions;  ///< the words that captured data sets use, with what they imply
  double low_speed = 0, high_speed = 0;  ///< m/s; 0: no path speed
  double shortest = 0, longest = 0;      ///< seconds; 0: the duration follows from the count
  int most = 1;                          ///< repetitions
  bool styles = false;                   ///< energetic, tired, old make sense
};

using ProceduralKinds = std::vector<ProceduralKind>;

/// All kinds.
const ProceduralKinds& procedural_kind_table();

/// Arms; trunk and legs on the spot.
void add_arm_kinds(ProceduralKinds& kinds);
void add_body_kinds(ProceduralKinds& kinds);

/// Adds the kind for every side in turn, with the side at the end of its name.
template <class MakeKind>
void add_sides(ProceduralKinds& kinds, MakeKind&& make) {
  for (ActionSide side : {ActionSide::left, ActionSide::right}) {
    ProceduralKind kind = make(side);
    kind.side = side == ActionSide::left ? "left" : "right";
    kind.name += "-" + kind.side;
    kinds.push_back(std::move(kind));
  }
}

}  // namespace remomask::synthetic
