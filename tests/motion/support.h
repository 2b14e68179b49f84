#pragma once

#include <functional>
#include <string>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::testing_support {

/// Path of a file or folder of the shared data; empty where there is none.
std::string shared_data(const std::string& name);

/// Folder that lives as long as the test program.
const std::string& temporary_folder();

/// A walking figure with the uniform bone lengths, y >= 0 not guaranteed.
/// `heading` gives the facing angle of a frame in radians.
Motion make_walker(int frames, const std::function<double(int)>& heading);
inline Motion make_walker(int frames) {
  return make_walker(frames, [](int) { return 0.0; });
}

/// The same pose in every frame, its hips and shoulders square, turned by `heading`.
Motion make_statue(int frames, const std::function<double(int)>& heading);

/// A body that sways and squats over feet that stand still; its bones keep their lengths.
Motion make_swaying_statue(int frames);

/// Every frame turned by `angle` around Y and moved.
Motion moved(const Motion& motion, double angle, const Vec3& shift, double scale = 1);

/// Largest coordinate difference; infinite when the shapes differ.
double largest_difference(const Motion& a, const Motion& b);

}  // namespace remomask::testing_support
