#include <fmt/format.h>

#include "formats/bvh.h"

namespace remomask::formats {

namespace {

class BvhFormatter {
 public:
  explicit BvhFormatter(const Bvh& bvh) : bvh_(bvh) {}

  std::string format() {
    text_ = "HIERARCHY\n";
    write_joint(0, 0);
    write("MOTION\nFrames: {}\nFrame Time: {:.6f}\n", bvh_.frames, bvh_.frame_time);
    const float* value = bvh_.values.data();
    for (int t = 0; t < bvh_.frames; ++t) {
      for (int i = 0; i < bvh_.channels; ++i)
        write("{:.6f}{}", *value++, i + 1 < bvh_.channels ? ' ' : '\n');
    }
    return std::move(text_);
  }

 private:
  template <typename... Values>
  void write(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Values>(values)...);
  }

  void write_offset(const std::string& indent, const Vec3& offset) {
    write("{}OFFSET {:.6f} {:.6f} {:.6f}\n", indent, offset.x(), offset.y(), offset.z());
  }

  void write_joint(size_t index, int depth) {
    static constexpr const char* kChannels[] = {"Xposition", "Yposition", "Zposition",
                                                "Xrotation", "Yrotation", "Zrotation"};
    const BvhJoint& joint = bvh_.joints[index];
    const std::string outer(static_cast<size_t>(depth) * 2, ' '), inner = outer + "  ";
    write("{}{} {}\n{}{{\n", outer, depth == 0 ? "ROOT" : "JOINT", joint.name, outer);
    write_offset(inner, joint.offset);
    write("{}CHANNELS {}", inner, joint.channels.size());
    for (const BvhChannel channel : joint.channels) write(" {}", kChannels[channel]);
    text_ += '\n';
    for (size_t child = index + 1; child < bvh_.joints.size(); ++child) {
      if (bvh_.joints[child].parent == static_cast<int>(index)) write_joint(child, depth + 1);
    }
    if (joint.end_site) {
      write("{}End Site\n{}{{\n", inner, inner);
      write_offset(inner + "  ", *joint.end_site);
      write("{}}}\n", inner);
    }
    write("{}}}\n", outer);
  }

  const Bvh& bvh_;
  std::string text_;
};

}  // namespace

std::string format_bvh(const Bvh& bvh) { return BvhFormatter(bvh).format(); }

}  // namespace remomask::formats
