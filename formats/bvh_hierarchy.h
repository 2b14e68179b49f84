#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/bvh.h"
#include "formats/bvh_scanner.h"

namespace remomask::formats {

/// Reads the HIERARCHY section of a BVH file: all skeletons that it holds, of which one is kept.
class BvhHierarchy {
 public:
  /// `root`: the skeleton to keep, by the name of its root; empty: the only one.
  BvhHierarchy(BvhScanner& scanner, const std::string& root) : scanner_(scanner), root_(root) {}

  /// From the first word of the file to behind the word MOTION.
  void parse();

  /// Joints of the kept skeleton.
  std::vector<BvhJoint> take_joints() { return std::move(joints_); }
  /// Numbers in a row of the file, of which those of other skeletons and scales are not used.
  size_t columns() const { return used_.size(); }
  bool column_used(size_t column) const { return used_[column]; }
  bool all_columns_used() const;

 private:
  struct Skeleton {
    size_t first, last;  ///< of its joints
    std::string label;   ///< its root's name, made different from that of the other roots
    long line;
  };

  void read_skeleton();
  void open_joint(int parent);
  void require_offset(int joint);
  void read_channels(int joint);
  void read_end_site(int joint);
  void keep_skeleton(const Skeleton& kept);
  const Skeleton& chosen_skeleton() const;
  std::string root_list() const;
  void rename_duplicates();
  void warn_of_scales();

  BvhScanner& scanner_;
  const std::string& root_;
  std::vector<BvhJoint> joints_;
  std::vector<long> lines_;  ///< of the joints
  std::vector<bool> has_offset_, has_channels_;
  std::vector<int> column_joints_;  ///< the joint of each column
  std::vector<bool> used_;          ///< of each column
  std::vector<Skeleton> skeletons_;
  long first_scale_line_ = 0;
};

}  // namespace remomask::formats
