// Finds motions by a sentence, then motions whose arms move like those of the
// best hit, and the captions that describe it.
#include <cstdio>
#include <exception>

#include "search/motion_search.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s MODEL DATABASE SENTENCE\n", argv[0]);
    return 2;
  }
  try {
    const remomask::search::MotionSearch search(argv[1], argv[2]);
    remomask::SearchQuery query;
    query.text = argv[3];
    query.k = 3;
    query.filter.min_seconds = 2;
    const remomask::SearchAnswer answer = search.search(query);
    for (const remomask::MotionHit& hit : answer.hits) {
      std::printf("%d. %s  %.3f\n", hit.rank, hit.clip.name.c_str(), hit.similarity);
    }
    if (answer.hits.empty()) return 0;

    remomask::SearchQuery like;
    like.like_clip = answer.hits[0].clip.name;
    like.k = 3;
    for (const remomask::CaptionHit& hit : search.captions_for(like)) {
      std::printf("described by: %s  %.3f\n", hit.caption.c_str(), hit.similarity);
    }
    like.parts = {"arms"};
    for (const remomask::MotionHit& hit : search.search(like).hits) {
      std::printf("arms like it: %s  %.3f\n", hit.clip.name.c_str(), hit.similarity);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
