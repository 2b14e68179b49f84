// Finds motions by a sentence.
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s MODEL DATABASE SENTENCE\n", argv[0]);
    return 2;
  }
  try {
    const remomask::TextToMotion remomask(argv[1], argv[2]);
    remomask::SearchQuery query;
    query.text = argv[3];
    query.k = 3;
    query.filter.min_seconds = 2;
    const remomask::SearchAnswer answer = remomask.search(query);
    for (const remomask::MotionHit& hit : answer.hits) {
      std::printf("%d. %s  %.3f  %s\n", hit.rank, hit.clip.name.c_str(), *hit.probability,
                  hit.clip.captions.empty() ? "" : hit.clip.captions.front().c_str());
    }
    std::printf("%lld clips pass the filter\n", static_cast<long long>(answer.candidates));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
