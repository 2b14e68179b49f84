#include "db/checksum.h"

#include <bit>

#include "base/hash.h"

namespace remomask::db {

namespace {

/// Joins fields so that no two sequences of fields give the same bytes.
class Fields {
 public:
  Fields& add(std::string_view field) {
    bytes_ += std::to_string(field.size()) + ":";
    bytes_ += field;
    return *this;
  }
  Fields& add(std::span<const std::byte> field) {
    return add({reinterpret_cast<const char*>(field.data()), field.size()});
  }
  Fields& add(int64_t field) { return add(std::to_string(field)); }
  std::string checksum() const { return content_hash(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

std::string clip_checksum(const Clip& clip) {
  Fields fields;
  fields.add(clip.name).add(clip.source).add(clip.source_file).add(clip.start_frame);
  fields.add(clip.split).add(clip.licence).add(clip.content_hash).add(clip.group);
  fields.add(static_cast<int64_t>(clip.mirrored)).add(clip.skeleton).add(clip.frames);
  fields.add(std::bit_cast<int64_t>(clip.speed)).add(clip.labels.dump());
  fields.add(static_cast<int64_t>(clip.captions.size()));
  for (const std::string& caption : clip.captions) fields.add(caption);
  for (const std::string& tag : clip.tags) fields.add(tag);
  return fields.checksum();
}

std::string motion_checksum(int64_t frames, int64_t joints, std::span<const std::byte> positions) {
  return Fields().add(frames).add(joints).add(positions).checksum();
}

std::string caption_vector_checksum(const std::string& text, std::span<const std::byte> vector) {
  return Fields().add(text).add(vector).checksum();
}

std::string embedding_checksum(std::span<const std::byte> motion, std::span<const std::byte> parts,
                               std::span<const std::byte> text) {
  return Fields().add(motion).add(parts).add(text).checksum();
}

}  // namespace remomask::db
