#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "db/database.h"

namespace remomask::db {

/// Checksums of what the tables hold, bit for bit (the content hash of a clip rounds to
/// 0.1 mm, so that equal motions are found). They are stored since format 4.

/// Of a clip's row, its captions in order and its tags; not of its id and its motion.
std::string clip_checksum(const Clip& clip);

/// Of the positions as they are stored.
std::string motion_checksum(int64_t frames, int64_t joints, std::span<const std::byte> positions);

/// Of a text and its vector as it is stored.
std::string caption_vector_checksum(const std::string& text, std::span<const std::byte> vector);

/// Of the three vectors as they are stored.
std::string embedding_checksum(std::span<const std::byte> motion, std::span<const std::byte> parts,
                               std::span<const std::byte> text);

}  // namespace remomask::db
