#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/progress.h"

namespace remomask::exchange {

enum class ExportFormat { bvh, npy };

/// Writes these clips as motion files with a captions.jsonl that import_folder()
/// reads back: name, captions, labels, split, licence, group and tags return; the
/// very positions do from npy, those of bvh within the precision of its
/// rotations. `folder` is made, or must be empty. Throws Error otherwise, for a
/// clip that is not there, and Interrupted when stopped; captions.jsonl comes
/// last, a folder without it is not complete.
void export_clips(const db::Database& database, const std::vector<int64_t>& ids,
                  const std::string& folder, ExportFormat format, const Monitor& monitor = {});

}  // namespace remomask::exchange
