#pragma once

namespace remomask::motion {

/// The joints of humanml_skeleton() by number.
enum BodyJoint {
  kBodyPelvis,
  kBodyLeftHip,
  kBodyRightHip,
  kBodySpine1,
  kBodyLeftKnee,
  kBodyRightKnee,
  kBodySpine2,
  kBodyLeftAnkle,
  kBodyRightAnkle,
  kBodySpine3,
  kBodyLeftToe,
  kBodyRightToe,
  kBodyNeck,
  kBodyLeftCollar,
  kBodyRightCollar,
  kBodyHead,
  kBodyLeftShoulder,
  kBodyRightShoulder,
  kBodyLeftElbow,
  kBodyRightElbow,
  kBodyLeftWrist,
  kBodyRightWrist
};

}  // namespace remomask::motion
