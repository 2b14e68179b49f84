#include "search/embed_captions.h"

#include <algorithm>
#include <string>
#include <vector>

#include "remomask/error.h"

namespace remomask::search {

namespace {
constexpr size_t kCaptionsAtOnce = 256;
}

int64_t embed_captions(db::Database& database, const encoders::SentenceEncoder& encoder,
                       const Monitor& monitor) {
  database.drop_unused_caption_vectors(encoder.hash());
  const std::vector<std::string> texts = database.captions_without_vector(encoder.hash());
  for (size_t first = 0; first < texts.size(); first += kCaptionsAtOnce) {
    if (monitor.stop_requested()) {
      throw Interrupted("embedding the captions was stopped after " + std::to_string(first) +
                        " of " + std::to_string(texts.size()) +
                        ", which are stored; the same command goes on");
    }
    const size_t last = std::min(texts.size(), first + kCaptionsAtOnce);
    const std::vector<std::string> batch(texts.begin() + static_cast<std::ptrdiff_t>(first),
                                         texts.begin() + static_cast<std::ptrdiff_t>(last));
    auto vectors = encoder.embed(batch);
    std::vector<db::CaptionVector> rows;
    for (size_t i = 0; i < batch.size(); ++i) rows.push_back({batch[i], std::move(vectors[i])});
    database.add_caption_vectors(encoder.hash(), rows);
    monitor.report({"captions of " + database.path(), static_cast<double>(last),
                    static_cast<double>(texts.size()), ""});
  }
  return static_cast<int64_t>(texts.size());
}

}  // namespace remomask::search
