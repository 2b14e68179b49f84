// Trains a model on your own database; stop it with Ctrl-C and start it again at will.
#include <remomask/error.h>
#include <remomask/training.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fprintf(stderr, "usage: %s DATABASE FOLDER [PRESET [STEPS]]\n", argv[0]);
    return 2;
  }
  try {
    remomask::TrainOptions options;
    options.database = argv[1];
    options.folder = argv[2];
    if (argc > 3) options.preset = argv[3];
    if (argc > 4) options.steps = std::atoi(argv[4]);
    remomask::Monitor monitor;
    monitor.progress = [](const remomask::Progress& progress) {
      std::printf("%s %g/%g  %s\n", progress.stage.c_str(), progress.done, progress.total,
                  progress.detail.c_str());
    };
    const remomask::TrainReport report = remomask::train_model(options, monitor);
    std::printf("%s\n", report.model.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
