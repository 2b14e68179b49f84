#pragma once

#include "base/progress.h"
#include "db/database.h"
#include "retriever/retriever.h"

namespace remomask {

/// Stores the vectors of every clip (motion, parts, mean of its captions) under
/// the retriever's hash. Returns how many clips were embedded: 0 when they were
/// there already. Clips without captions have no text vector; clips of fewer
/// than 4 frames are left out. Nothing is stored when stopped.
int64_t embed_database(Database& database, const Retriever& retriever, const Monitor& monitor = {});

}  // namespace remomask
