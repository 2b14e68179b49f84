// Several sentences as one motion, with progress and a stop on Ctrl-C.
#include <remomask/error.h>
#include <remomask/library.h>
#include <remomask/motion_file.h>
#include <remomask/text_to_motion.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stop_token>

namespace {
std::atomic<bool> interrupted = false;
void on_interrupt(int) { interrupted = true; }
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s OUTPUT.bvh\n", argv[0]);
    return 2;
  }
  try {
    const std::vector<remomask::ScriptLine> lines = {{"a person walks forward", 3.0},
                                                     {"someone waves with the right hand", 2.0},
                                                     {"a person walks backward", 3.0}};
    std::signal(SIGINT, on_interrupt);
    std::stop_source stop;
    remomask::Monitor monitor;
    monitor.stop = stop.get_token();
    monitor.progress = [&](const remomask::Progress& progress) {
      std::printf("%g of %g: %s\n", progress.done, progress.total, progress.detail.c_str());
      if (interrupted) stop.request_stop();
    };
    const remomask::TextToMotion remomask(remomask::shipped_model(), remomask::shipped_database());
    const remomask::ScriptedMotion made = remomask.script(lines, {}, monitor);
    for (const remomask::ScriptedSegment& segment : made.segments) {
      std::printf("%5.2f s  %s\n", segment.first / made.motion.fps, segment.sentence.c_str());
    }
    remomask::save_motion(argv[1], made);
  } catch (const remomask::Interrupted& stop) {
    std::fprintf(stderr, "%s\n", stop.what());
    return 130;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
