#pragma once

#include <cstdint>

#include "db/database.h"
#include "encoders/sentence_encoder.h"
#include "remomask/progress.h"

namespace remomask::search {

/// Stores the vector of every caption that has none of this encoder yet, and removes those that
/// nobody needs any more; returns how many were made. Throws Interrupted if asked to stop: what is
/// stored stays, and the next call goes on.
int64_t embed_captions(db::Database& database, const encoders::SentenceEncoder& encoder,
                       const Monitor& monitor = {});

}  // namespace remomask::search
