// Adds motion files to a database while it is searched.
#include <remomask/library.h>
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s MODEL DATABASE MOTION.bvh CAPTION\n", argv[0]);
    return 2;
  }
  try {
    const remomask::TextToMotion remomask(argv[1], argv[2]);
    const std::vector<std::string> files = {argv[3]};
    remomask::AddOptions options;
    options.captions = {argv[4]};
    options.tags = {"new"};
    const remomask::AddReport added = remomask::add_motion_files(argv[2], files, options);
    for (const std::string& clip : added.clips) std::printf("added %s\n", clip.c_str());
    for (const remomask::RejectedFile& file : added.rejected) {
      std::printf("left out %s: %s\n", file.file.c_str(), file.reason.c_str());
    }
    const remomask::IndexReport indexed = remomask::index_database(argv[2], argv[1]);
    std::printf("embedded: %lld\n", static_cast<long long>(indexed.embedded));

    remomask::SearchQuery query;
    query.text = argv[4];
    query.k = 1;
    query.filter.tags = {"new"};
    for (const remomask::MotionHit& hit : remomask.search(query).hits) {
      std::printf("found: %s  %.3f\n", hit.clip.name.c_str(), *hit.probability);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
