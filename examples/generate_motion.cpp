// From a sentence to a motion file: finds motions that resemble it, and makes a new
// one of them.
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/motion_generator.h"
#include "remomask/motion_file.h"
#include "search/motion_search.h"

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: %s MODEL DATABASE SENTENCE OUTPUT.bvh\n", argv[0]);
    return 2;
  }
  try {
    const std::string sentence = argv[3];
    const remomask::pipeline::Generator generator(remomask::nn::load_model(argv[1]));
    const remomask::search::MotionSearch search(argv[1], argv[2]);
    const remomask::db::Database database(argv[2], remomask::db::OpenMode::read_only);

    remomask::SearchQuery query;
    query.text = sentence;
    query.k = static_cast<int>(generator.max_hits());
    std::vector<remomask::pipeline::RetrievedMotion> retrieved;
    for (const remomask::MotionHit& hit : search.search(query).hits) {
      const auto vectors = database.embedding(generator.retriever().hash(), hit.clip.id);
      if (!vectors || vectors->text.empty()) continue;
      remomask::pipeline::RetrievedMotion motion;
      motion.clip_id = hit.clip.id;
      motion.motion = vectors->motion;
      motion.text = vectors->text;
      motion.similarity = hit.similarity;
      motion.frames = hit.clip.frames;
      if (static_cast<int64_t>(retrieved.size()) < generator.sequence_hits()) {
        motion.poses = database.motion(hit.clip.id);
      }
      retrieved.push_back(std::move(motion));
      std::printf("from: %s  %.3f\n", hit.clip.name.c_str(), hit.similarity);
    }

    remomask::GenerateOptions options;
    options.seconds = 2;
    options.seed = 1;
    const remomask::pipeline::Generated made = generator.generate(sentence, retrieved, options);
    remomask::save_motion(argv[4], made.motion, {{"prompt", sentence}});
    std::printf("%d frames in %s\n", made.motion.frames, argv[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
