// From a sentence to a motion file, with the clips that the motion was made from.
#include <remomask/library.h>
#include <remomask/motion_file.h>
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s SENTENCE OUTPUT.bvh\n", argv[0]);
    return 2;
  }
  try {
    const remomask::TextToMotion remomask(remomask::shipped_model(), remomask::shipped_database());
    remomask::GenerateOptions options;
    options.seed = 7;
    options.influence = true;
    const remomask::GeneratedMotion made = remomask.generate(argv[1], options);
    for (const remomask::Evidence& found : made.evidence) {
      std::printf("%-16s %.3f  %s (%s)", remomask::evidence_use_name(found.use),
                  *found.hit.probability, found.hit.clip.name.c_str(),
                  found.hit.clip.licence.c_str());
      if (found.influence) std::printf("  decides %.0f %%", 100 * *found.influence);
      if (found.followed_share > 0) std::printf("  followed %.0f %%", 100 * found.followed_share);
      std::printf("\n");
    }
    remomask::save_motion(argv[2], made);
    std::printf("%d frames in %s\n", made.motion.frames, argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
