// Generates the arms of a motion again between two times; everything else stays as it is.
#include <remomask/library.h>
#include <remomask/motion_file.h>
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fprintf(stderr, "usage: %s INPUT.bvh FROM TO SENTENCE OUTPUT.bvh\n", argv[0]);
    return 2;
  }
  try {
    remomask::MotionFileOptions as_it_is;
    as_it_is.canonical = false;
    const remomask::Motion original = remomask::load_motion(argv[1], as_it_is).motion;
    const remomask::EditSpan arms{static_cast<int>(std::atof(argv[2]) * original.fps),
                                  static_cast<int>(std::atof(argv[3]) * original.fps),
                                  {"arms"}};
    const remomask::TextToMotion remomask(remomask::shipped_model(), remomask::shipped_database());
    const remomask::EditedMotion made = remomask.edit(original, {&arms, 1}, argv[4]);
    for (const remomask::EditedCells& cells : made.cells) {
      std::printf("%s: frames %d to %d\n", cells.part.c_str(), cells.first, cells.last);
    }
    remomask::save_motion(argv[5], made);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
