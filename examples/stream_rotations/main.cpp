// Plays a generated motion frame by frame, as a game would drive a skeleton.
#include <remomask/library.h>
#include <remomask/rotations.h>
#include <remomask/text_to_motion.h>

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s SENTENCE\n", argv[0]);
    return 2;
  }
  try {
    const remomask::TextToMotion remomask(remomask::shipped_model(), remomask::shipped_database());
    remomask::GenerateOptions options;
    options.seconds = 2;
    const remomask::GeneratedMotion made = remomask.generate(argv[1], options);
    const remomask::JointRotations pose = remomask::solve_rotations(made.motion);
    int elbow = 0;
    while (pose.joint_names[static_cast<size_t>(elbow)] != "right_elbow") ++elbow;
    for (int frame = 0; frame < pose.frames; ++frame) {
      const remomask::Vector3& root = pose.root[static_cast<size_t>(frame)];
      const remomask::Quaternion& q = pose.rotation(frame, elbow);
      std::printf("%.2f s  root %.3f %.3f %.3f  right_elbow %.3f %.3f %.3f %.3f\n",
                  frame / pose.fps, root[0], root[1], root[2], q[0], q[1], q[2], q[3]);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
