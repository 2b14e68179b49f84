// Finds motions whose arms move like those of a motion file, and the captions that describe it.
#include <remomask/motion_file.h>
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s MODEL DATABASE MOTION.bvh\n", argv[0]);
    return 2;
  }
  try {
    const remomask::TextToMotion remomask(argv[1], argv[2]);
    remomask::SearchQuery query;
    query.motion = remomask::load_motion(argv[3]).motion;
    query.k = 3;
    for (const remomask::CaptionHit& hit : remomask.captions_for(query)) {
      std::printf("described by: %s  %.3f\n", hit.caption.c_str(), hit.similarity);
    }
    query.parts = {"arms"};
    for (const remomask::MotionHit& hit : remomask.search(query).hits) {
      std::printf("arms like it: %s  %.3f\n", hit.clip.name.c_str(), hit.similarity);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
