#pragma once

#include <cairo.h>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::drawing {

/// Parallel projection for a camera that looks down on the floor.
struct SheetCamera {
  Vec3 right, up, towards;     ///< axes; `towards` points to the viewer
  Vec3 centre = Vec3::Zero();  ///< drawn at (x, y)
  double x = 0, y = 0, pixels_per_metre = 100;

  SheetCamera(double azimuth_degrees, double elevation_degrees);
  Eigen::Vector2d project(const Vec3& point) const;
  double depth(const Vec3& point) const { return towards.dot(point - centre); }
};

/// A body of 22 joints with rounded limbs: left side warm, right side cool, trunk dark; far limbs
/// behind near ones. `opacity` is 0 .. 1.
void draw_figure(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame,
                 double opacity);

/// Soft shadow on the floor below a body.
void draw_shadow(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame,
                 double opacity);

/// Floor lines every `step` metres over a rectangle, fading towards its edge.
void draw_floor(cairo_t* cairo, const SheetCamera& camera, const Vec3& low, const Vec3& high,
                double step);

/// Path of the root on the floor with a dot every half second.
void draw_root_path(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, double fps);

}  // namespace remomask::drawing
