#pragma once

#include "db/database.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"

namespace remomask::retriever {

/// Stores the vectors (motion, parts, mean of the captions) of every clip that
/// has none of this retriever yet; returns how many. Clips without captions have
/// no text vector; clips of fewer than 4 frames are left out. A few clips are
/// stored at a time: a stopped run (Interrupted) keeps what is done.
int64_t embed_database(db::Database& database, const Retriever& retriever,
                       const Monitor& monitor = {});

}  // namespace remomask::retriever
