#include "formats/joint_array.h"

#include <gtest/gtest.h>

#include <cmath>

#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;

namespace {

using Shape = std::vector<size_t>;

/// The motion in C order of (T, joints, 3); joints beyond ours are at the wrist.
formats::NpyArray joints_array(const Motion& motion, size_t joints) {
  formats::NpyArray array{{static_cast<size_t>(motion.frames), joints, 3}, {}};
  for (int t = 0; t < motion.frames; ++t) {
    for (size_t j = 0; j < joints; ++j) {
      const float* p = motion.at(t, static_cast<int>(std::min<size_t>(j, 21)));
      array.values.insert(array.values.end(), p, p + 3);
    }
  }
  return array;
}

/// The same as (joints, 3, T), frames last, as MDM stores them.
formats::NpyArray frames_last(const formats::NpyArray& array) {
  const size_t frames = array.shape[0], row = array.shape[1] * 3;
  formats::NpyArray result{{array.shape[1], 3, frames}, std::vector<float>(array.values.size())};
  for (size_t t = 0; t < frames; ++t) {
    for (size_t i = 0; i < row; ++i) result.values[i * frames + t] = array.values[t * row + i];
  }
  return result;
}

/// The same with joints first: (joints, T, 3).
formats::NpyArray joints_first(const formats::NpyArray& array) {
  formats::NpyArray result{{array.shape[1], array.shape[0], 3}, {}};
  for (size_t j = 0; j < array.shape[1]; ++j) {
    for (size_t t = 0; t < array.shape[0]; ++t) {
      const float* p = array.values.data() + (t * array.shape[1] + j) * 3;
      result.values.insert(result.values.end(), p, p + 3);
    }
  }
  return result;
}

/// The same with axes before joints: (T, 3, joints).
formats::NpyArray axes_first(const formats::NpyArray& array) {
  const size_t joints = array.shape[1];
  formats::NpyArray result{{array.shape[0], 3, joints}, {}};
  for (size_t t = 0; t < array.shape[0]; ++t) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t j = 0; j < joints; ++j) {
        result.values.push_back(array.values[(t * joints + j) * 3 + axis]);
      }
    }
  }
  return result;
}

formats::NpyArray reshaped(formats::NpyArray array, const Shape& shape) {
  array.shape = shape;
  return array;
}

std::string refusal_of(const formats::NpyArray& array) {
  std::vector<std::string> warnings;
  try {
    formats::motion_of_array(array, "x.npy", warnings);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(JointArray, ReadsTheShapesOfOtherPrograms) {
  const Motion motion = make_walker(7);
  const formats::NpyArray ours = joints_array(motion, 22);
  const size_t t = 7;
  const std::pair<const char*, formats::NpyArray> cases[] = {
      {"(T, 22, 3)", ours},
      {"(T, 66)", reshaped(ours, {t, 66})},
      {"(1, T, 22, 3)", reshaped(ours, {1, t, 22, 3})},
      {"(1, 1, T, 22, 3)", reshaped(ours, {1, 1, t, 22, 3})},
      {"(1, T, 66)", reshaped(ours, {1, t, 66})},
      {"(22, 3, T)", frames_last(ours)},
      {"(1, 22, 3, T)", reshaped(frames_last(ours), {1, 22, 3, t})},
      {"(T, 1, 22, 3)", reshaped(ours, {t, 1, 22, 3})},
      {"(T, 22, 3, 1)", reshaped(ours, {t, 22, 3, 1})},
      {"(22, T, 3)", joints_first(ours)},
      {"(T, 3, 22)", axes_first(ours)},
      {"(T, 45, 3)", joints_array(motion, 45)},
      {"(T, 73, 3)", joints_array(motion, 73)},
      {"(T, 127, 3)", joints_array(motion, 127)},
      {"(T, 144, 3)", joints_array(motion, 144)},
      {"(T, 24, 3)", joints_array(motion, 24)},
      {"(T, 52, 3)", joints_array(motion, 52)},
      {"(T, 55, 3)", joints_array(motion, 55)},
      {"(T, 72)", reshaped(joints_array(motion, 24), {t, 72})},
      {"(T, 156)", reshaped(joints_array(motion, 52), {t, 156})},
      {"(1, 24, 3, T)", reshaped(frames_last(joints_array(motion, 24)), {1, 24, 3, t})},
  };
  for (const auto& [what, array] : cases) {
    std::vector<std::string> warnings;
    const Motion read = formats::motion_of_array(array, "x.npy", warnings);
    EXPECT_EQ(largest_difference(read, motion), 0) << what;
    const bool all = array.values.size() == ours.values.size();
    EXPECT_EQ(warnings.size(), all ? 0u : 1u) << what;
  }
}

TEST(JointArray, FeaturesMayHaveFramesLast) {
  const size_t frames = 9, width = 263;
  formats::NpyArray rows{{frames, width}, std::vector<float>(frames * width)};
  for (size_t i = 0; i < rows.values.size(); ++i) {
    rows.values[i] = 0.1f * static_cast<float>(std::sin(0.37 * static_cast<double>(i)));
  }
  formats::NpyArray last{{1, width, 1, frames}, {}};
  for (size_t column = 0; column < width; ++column) {
    for (size_t t = 0; t < frames; ++t) last.values.push_back(rows.values[t * width + column]);
  }
  std::vector<std::string> warnings;
  EXPECT_EQ(largest_difference(formats::motion_of_array(last, "x", warnings),
                               formats::motion_of_array(rows, "x", warnings)),
            0);
}

TEST(JointArray, ShortMotionsAreNotMistakenForOtherShapes) {
  for (const int frames : {1, 3, 22, 24}) {
    const Motion motion = make_walker(frames);
    const formats::NpyArray ours = joints_array(motion, 22);
    const auto t = static_cast<size_t>(frames);
    std::vector<std::string> warnings;
    for (const formats::NpyArray& array :
         {ours, reshaped(ours, {1, t, 22, 3}), reshaped(ours, {t, 66}), frames_last(ours),
          reshaped(frames_last(ours), {1, 22, 3, t})}) {
      EXPECT_EQ(largest_difference(formats::motion_of_array(array, "x", warnings), motion), 0)
          << frames << " frames, " << array.shape.size() << " axes";
    }
  }
  const Motion pose = make_walker(1);
  std::vector<std::string> warnings;
  const formats::NpyArray flat = reshaped(joints_array(pose, 22), {22, 3});
  EXPECT_EQ(largest_difference(formats::motion_of_array(flat, "x", warnings), pose), 0);
}

TEST(JointArray, RefusesOtherShapesAndNamesThoseItReads) {
  const auto of_shape = [](const Shape& shape) {
    size_t count = 1;
    for (const size_t extent : shape) count *= extent;
    return refusal_of({shape, std::vector<float>(count, 0.5f)});
  };
  EXPECT_NE(of_shape({5, 17, 3}).find("(T, 22, 3), (T, 66), (1, T, 22, 3)"), std::string::npos);
  EXPECT_NE(of_shape({}).find("accepted are"), std::string::npos);
  EXPECT_NE(of_shape({7}).find("shape (7)"), std::string::npos);
  EXPECT_NE(of_shape({2, 22, 3, 9}).find("these are 2 motions"), std::string::npos);
  EXPECT_NE(of_shape({3, 9, 22, 3}).find("array[0]"), std::string::npos);
  EXPECT_NE(of_shape({9, 21, 3}).find("KIT-ML"), std::string::npos);
  EXPECT_NE(of_shape({9, 251}).find("KIT-ML"), std::string::npos);
  EXPECT_NE(of_shape({0, 22, 3}).find("no frames"), std::string::npos);
}

TEST(JointArray, PoseParametersAreNotTakenForPositions) {
  formats::NpyArray pose{{20, 72}, std::vector<float>(20 * 72)};
  for (size_t i = 0; i < pose.values.size(); ++i) {
    pose.values[i] = 0.3f * static_cast<float>(std::sin(0.37 * static_cast<double>(i * i)));
  }
  EXPECT_NE(refusal_of(pose).find("pose parameters"), std::string::npos) << refusal_of(pose);
}

TEST(JointArray, NamesTheFrameOfWhatIsNotANumber) {
  formats::NpyArray array = joints_array(make_walker(5), 22);
  array.values[2 * 66 + 12] = NAN;
  const std::string text = refusal_of(array);
  EXPECT_NE(text.find("frame 2, joint left_knee"), std::string::npos) << text;
}

}  // namespace remomask
