#pragma once

#include <set>
#include <unordered_map>

#include "exchange/motion_source.h"

namespace remomask::exchange {

/// HumanML3D or KIT-ML as its authors lay it out: new_joints/ID.npy (frames x 22
/// or 21 x 3; used where present), new_joint_vecs/ID.npy (frames x 263 or 251),
/// texts/ID.txt, and train.txt, val.txt, test.txt with a line an ID. "M" + ID is
/// the mirror copy of ID. Time tags are seconds; a tagged part becomes a clip of
/// its own, ID@from-to, at the skeleton's frame rate (the authors take 20 per
/// second for KIT-ML too, whose texts have no tags; its rate is 12.5).
class HumanmlFolder : public MotionSource {
 public:
  static bool is_layout_of(const std::string& folder);
  explicit HumanmlFolder(const ImportOptions& options);

  std::string fingerprint(size_t i) const override;
  std::vector<PreparedClip> prepare(size_t i, std::vector<std::string>& warnings) const override;

 private:
  void find_motions();
  void read_splits();
  void find_texts();
  std::string text_path(const std::string& id) const;

  std::set<std::string> known_;  ///< IDs with a motion
  std::set<std::string> with_text_;
  std::unordered_map<std::string, std::string> splits_;
};

}  // namespace remomask::exchange
