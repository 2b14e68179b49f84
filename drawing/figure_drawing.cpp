#include "drawing/figure_drawing.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace remomask::drawing {

namespace {

struct Colour {
  double red, green, blue;
};

constexpr Colour kWarm{0.91, 0.43, 0.23}, kCool{0.16, 0.50, 0.79}, kTrunk{0.22, 0.25, 0.33};
constexpr double kHeadRadius = 0.105;

/// A limb and its thickness at both ends, in metres.
struct Limb {
  int from, to;
  double from_radius, to_radius;
};

constexpr Limb kLimbs[] = {
    {1, 4, 0.072, 0.052},   {4, 7, 0.050, 0.034},   {7, 10, 0.034, 0.027},  // left leg
    {2, 5, 0.072, 0.052},   {5, 8, 0.050, 0.034},   {8, 11, 0.034, 0.027},  // right leg
    {16, 18, 0.046, 0.036}, {18, 20, 0.035, 0.025},                         // left arm
    {17, 19, 0.046, 0.036}, {19, 21, 0.035, 0.025},                         // right arm
    {12, 15, 0.045, 0.045},                                                 // neck
};
constexpr int kNeckLimb = 10;
constexpr int kTrunkOutline[] = {16, 17, 2, 1};

Colour limb_colour(int joint) {
  const std::string& name = humanml_skeleton().joint_names[joint];
  if (name.starts_with("left")) return kWarm;
  if (name.starts_with("right")) return kCool;
  return kTrunk;
}

/// Limbs behind the body's middle fade a little into the paper.
Colour faded(const Colour& colour, double depth) {
  const double share = std::clamp(0.10 - depth * 0.7, 0.0, 0.30);
  const auto towards_paper = [&](double value) { return value + (0.96 - value) * share; };
  return {towards_paper(colour.red), towards_paper(colour.green), towards_paper(colour.blue)};
}

void set_colour(cairo_t* cairo, const Colour& colour, double opacity) {
  cairo_set_source_rgba(cairo, colour.red, colour.green, colour.blue, opacity);
}

/// Outline of the hull of two circles.
void capsule_path(cairo_t* cairo, const Eigen::Vector2d& a, double a_radius,
                  const Eigen::Vector2d& b, double b_radius) {
  const Eigen::Vector2d along = b - a;
  const double length = along.norm();
  cairo_new_path(cairo);
  if (length <= std::abs(a_radius - b_radius) + 1e-6) {  // seen end on
    const bool first = a_radius > b_radius;
    cairo_arc(cairo, first ? a.x() : b.x(), first ? a.y() : b.y(), std::max(a_radius, b_radius), 0,
              2 * std::numbers::pi);
    return;
  }
  const double angle = std::atan2(along.y(), along.x());
  const double tangent = std::acos((a_radius - b_radius) / length);
  cairo_arc(cairo, a.x(), a.y(), a_radius, angle + tangent, angle - tangent + 2 * std::numbers::pi);
  cairo_arc(cairo, b.x(), b.y(), b_radius, angle - tangent, angle + tangent);
  cairo_close_path(cairo);
}

void fill_with_edge(cairo_t* cairo, const Colour& colour, double edge) {
  // A thin light edge keeps crossing limbs apart.
  cairo_set_source_rgb(cairo, 0.99, 0.985, 0.975);
  cairo_set_line_width(cairo, 2 * edge);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke_preserve(cairo);
  set_colour(cairo, colour, 1);
  cairo_fill(cairo);
}

void draw_trunk(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame) {
  const Vec3 centre = joint_position(motion, frame, 6);
  cairo_new_path(cairo);
  std::vector<Eigen::Vector2d> corners;
  for (int joint : kTrunkOutline) {
    // Inside the joints: the stroke around the outline adds the flesh.
    const bool hip = joint <= 2;
    const Vec3 p = centre + (joint_position(motion, frame, joint) - centre) * (hip ? 1.0 : 0.90);
    corners.push_back(camera.project(p));
  }
  const Eigen::Vector2d collar = camera.project(joint_position(motion, frame, 12));
  const Eigen::Vector2d waist = camera.project(joint_position(motion, frame, 3));
  const auto pinch = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return Eigen::Vector2d(0.5 * (0.5 * (a + b)) + 0.5 * waist);
  };
  const Eigen::Vector2d right = pinch(corners[1], corners[2]), left = pinch(corners[3], corners[0]);
  cairo_move_to(cairo, corners[0].x(), corners[0].y());
  cairo_line_to(cairo, collar.x(), collar.y());
  cairo_line_to(cairo, corners[1].x(), corners[1].y());
  cairo_curve_to(cairo, right.x(), right.y(), right.x(), right.y(), corners[2].x(), corners[2].y());
  cairo_line_to(cairo, corners[3].x(), corners[3].y());
  cairo_curve_to(cairo, left.x(), left.y(), left.x(), left.y(), corners[0].x(), corners[0].y());
  cairo_close_path(cairo);
  const double flesh = 0.075 * camera.pixels_per_metre;
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_source_rgb(cairo, 0.99, 0.985, 0.975);
  cairo_set_line_width(cairo, 2 * flesh + 0.02 * camera.pixels_per_metre);
  cairo_stroke_preserve(cairo);
  set_colour(cairo, kTrunk, 1);
  cairo_set_line_width(cairo, 2 * flesh);
  cairo_stroke_preserve(cairo);
  cairo_fill(cairo);
}

void draw_head(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame) {
  const Vec3 head = joint_position(motion, frame, 15), neck = joint_position(motion, frame, 12);
  const Eigen::Vector2d at = camera.project(head + (head - neck).normalized() * 0.045);
  cairo_new_path(cairo);
  cairo_arc(cairo, at.x(), at.y(), kHeadRadius * camera.pixels_per_metre, 0, 2 * std::numbers::pi);
  fill_with_edge(cairo, kTrunk, 0.01 * camera.pixels_per_metre);
}

}  // namespace

SheetCamera::SheetCamera(double azimuth_degrees, double elevation_degrees) {
  const double a = azimuth_degrees * std::numbers::pi / 180;
  const double e = elevation_degrees * std::numbers::pi / 180;
  right = Vec3(std::cos(a), 0, -std::sin(a));
  towards = Vec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
  up = towards.cross(right);
}

Eigen::Vector2d SheetCamera::project(const Vec3& point) const {
  const Vec3 d = point - centre;
  return {x + pixels_per_metre * right.dot(d), y - pixels_per_metre * up.dot(d)};
}

void draw_figure(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame,
                 double opacity) {
  struct Piece {
    double depth;
    int limb;  // -1 trunk, -2 head
  };
  const double middle = camera.depth(joint_position(motion, frame, 3));
  std::vector<Piece> pieces{{middle, -1}, {camera.depth(joint_position(motion, frame, 15)), -2}};
  for (int i = 0; i < static_cast<int>(std::size(kLimbs)); ++i) {
    const Limb& limb = kLimbs[i];
    pieces.push_back({(camera.depth(joint_position(motion, frame, limb.from)) +
                       camera.depth(joint_position(motion, frame, limb.to))) /
                          2,
                      i});
  }
  // The neck lies within head and trunk from every side, so it is drawn before both.
  for (Piece& piece : pieces) {
    if (piece.limb == kNeckLimb) piece.depth = std::min(pieces[0].depth, pieces[1].depth) - 0.01;
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.depth < b.depth; });
  cairo_push_group(cairo);
  for (const Piece& piece : pieces) {
    if (piece.limb == -1) {
      draw_trunk(cairo, camera, motion, frame);
    } else if (piece.limb == -2) {
      draw_head(cairo, camera, motion, frame);
    } else {
      const Limb& limb = kLimbs[piece.limb];
      const double scale = camera.pixels_per_metre;
      capsule_path(cairo, camera.project(joint_position(motion, frame, limb.from)),
                   limb.from_radius * scale, camera.project(joint_position(motion, frame, limb.to)),
                   limb.to_radius * scale);
      fill_with_edge(cairo, faded(limb_colour(limb.to), piece.depth - middle), 0.008 * scale);
    }
  }
  cairo_pop_group_to_source(cairo);
  cairo_paint_with_alpha(cairo, opacity);
}

void draw_shadow(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, int frame,
                 double opacity) {
  // Between the feet and the root, lighter the higher the body is in the air.
  Vec3 floor = 0.5 * joint_position(motion, frame, 0) +
               0.25 * (joint_position(motion, frame, 7) + joint_position(motion, frame, 8));
  const double air =
      std::min(joint_position(motion, frame, 10).y(), joint_position(motion, frame, 11).y());
  const double spread =
      0.36 + 0.35 * (joint_position(motion, frame, 7) - joint_position(motion, frame, 8)).norm();
  floor.y() = 0;
  const Eigen::Vector2d at = camera.project(floor);
  const double strength = opacity * 0.38 / (1 + 3 * std::max(air, 0.0));
  cairo_save(cairo);
  cairo_translate(cairo, at.x(), at.y());
  cairo_scale(cairo, camera.pixels_per_metre * spread,
              camera.pixels_per_metre * spread * std::max(0.2, camera.towards.y() * 1.2));
  cairo_pattern_t* soft = cairo_pattern_create_radial(0, 0, 0.05, 0, 0, 1);
  cairo_pattern_add_color_stop_rgba(soft, 0, 0.15, 0.17, 0.25, strength);
  cairo_pattern_add_color_stop_rgba(soft, 0.5, 0.15, 0.17, 0.25, strength * 0.5);
  cairo_pattern_add_color_stop_rgba(soft, 1, 0.15, 0.17, 0.25, 0);
  cairo_set_source(cairo, soft);
  cairo_arc(cairo, 0, 0, 1, 0, 2 * std::numbers::pi);
  cairo_fill(cairo);
  cairo_pattern_destroy(soft);
  cairo_restore(cairo);
}

void draw_floor(cairo_t* cairo, const SheetCamera& camera, const Vec3& low, const Vec3& high,
                double step) {
  cairo_set_line_width(cairo, 1);
  cairo_set_source_rgb(cairo, 0.865, 0.865, 0.85);
  const auto line = [&](const Vec3& from, const Vec3& to) {
    const Eigen::Vector2d a = camera.project(from), b = camera.project(to);
    cairo_move_to(cairo, a.x(), a.y());
    cairo_line_to(cairo, b.x(), b.y());
    cairo_stroke(cairo);
  };
  const int x0 = static_cast<int>(std::floor(low.x() / step)),
            x1 = static_cast<int>(std::ceil(high.x() / step));
  const int z0 = static_cast<int>(std::floor(low.z() / step)),
            z1 = static_cast<int>(std::ceil(high.z() / step));
  for (int x = x0; x <= x1; ++x) line({x * step, 0, z0 * step}, {x * step, 0, z1 * step});
  for (int z = z0; z <= z1; ++z) line({x0 * step, 0, z * step}, {x1 * step, 0, z * step});
}

void draw_root_path(cairo_t* cairo, const SheetCamera& camera, const Motion& motion, double fps) {
  const auto on_floor = [&](int frame) {
    Vec3 p = joint_position(motion, frame, 0);
    p.y() = 0;
    return camera.project(p);
  };
  cairo_new_path(cairo);
  for (int f = 0; f < motion.frames; ++f) {
    const Eigen::Vector2d p = on_floor(f);
    cairo_line_to(cairo, p.x(), p.y());
  }
  cairo_set_source_rgba(cairo, 0.45, 0.30, 0.62, 0.75);
  cairo_set_line_width(cairo, 2.5);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(cairo);
  const int every = std::max(1, static_cast<int>(std::lround(fps / 2)));
  for (int f = 0; f < motion.frames; f += every) {
    const Eigen::Vector2d p = on_floor(f);
    cairo_arc(cairo, p.x(), p.y(), 3.2, 0, 2 * std::numbers::pi);
    cairo_fill(cairo);
  }
}

}  // namespace remomask::drawing
