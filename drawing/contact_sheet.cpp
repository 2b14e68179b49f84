#include "drawing/contact_sheet.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drawing/figure_drawing.h"
#include "drawing/png_canvas.h"
#include "remomask/error.h"

namespace remomask::drawing {

namespace {

constexpr double kMargin = 28, kCardGap = 18, kPadding = 22;
constexpr double kTitleHeight = 34, kSubtitleHeight = 24, kTimesHeight = 26;
constexpr double kFigureHeight = 250;  // pixels for the tallest pose
constexpr double kShownHeight = 2.05;  // metres that fit into it; grows for high jumps
constexpr double kOnionShare = 0.30;   // of the card's width

void check_sheet(const std::vector<SheetRow>& rows, const SheetOptions& options) {
  if (rows.empty()) throw Error("a contact sheet needs at least one motion");
  if (options.poses < 2 || options.poses > 24)
    throw Error("a contact sheet shows 2 to 24 poses in a row");
  if (options.width < 600 || options.width > 8000)
    throw Error("a contact sheet must be 600 to 8000 pixels wide");
  if (options.onion_poses < 0 || options.onion_poses == 1) {
    throw Error("the strip through space must show 0 or at least 2 poses");
  }
  for (const SheetRow& row : rows) {
    if (row.motion.joints != humanml_skeleton().joints() || row.motion.frames < 1) {
      throw Error("contact sheet: \"" + row.title + "\" is not a motion of 22 joints with frames");
    }
    if (!std::all_of(row.motion.positions.begin(), row.motion.positions.end(),
                     [](float v) { return std::isfinite(v); })) {
      throw Error("contact sheet: \"" + row.title + "\" has positions that are not finite");
    }
  }
}

double card_height(const SheetRow& row) {
  return 2 * kPadding + kTitleHeight + (row.subtitle.empty() ? 0 : kSubtitleHeight) +
         kFigureHeight + kTimesHeight;
}

int frame_of(int pose, int poses, int frames) {
  return static_cast<int>(std::lround(static_cast<double>(pose) * (frames - 1) / (poses - 1)));
}

void draw_poses(cairo_t* cairo, const SheetRow& row, const SheetOptions& options, double x,
                double base, double width) {
  const Motion& motion = row.motion;
  double highest = kShownHeight;
  for (int f = 0; f < motion.frames; ++f) {
    for (int j = 0; j < motion.joints; ++j) {
      highest = std::max(highest, joint_position(motion, f, j).y() + 0.2);
    }
  }
  const double cell = width / options.poses;
  for (int i = 0; i < options.poses; ++i) {
    const int frame = frame_of(i, options.poses, motion.frames);
    SheetCamera camera(options.camera_azimuth, options.camera_elevation);
    camera.centre = joint_position(motion, frame, 0);
    camera.centre.y() = 0;
    camera.x = x + cell * (i + 0.5);
    camera.y = base - 22;
    camera.pixels_per_metre = std::min(kFigureHeight / (highest + 0.1), cell / 1.0);
    draw_shadow(cairo, camera, motion, frame, 1);
    draw_figure(cairo, camera, motion, frame, 1);
    char time[32];
    std::snprintf(time, sizeof time, "%.1f s", frame / options.fps);
    show_text(cairo, camera.x - 15, base + 22, time, 12, false, 0.52, cell);
  }
}

void draw_onion(cairo_t* cairo, const SheetRow& row, const SheetOptions& options, double x,
                double top, double width, double height) {
  const Motion& motion = row.motion;
  SheetCamera camera(options.camera_azimuth + 10, options.camera_elevation + 10);
  Vec3 low(1e9, 0, 1e9), high(-1e9, 0, -1e9);
  for (int f = 0; f < motion.frames; ++f) {
    const Vec3 root = joint_position(motion, f, 0);
    low = low.cwiseMin(Vec3(root.x() - 0.6, 0, root.z() - 0.6));
    high = high.cwiseMax(Vec3(root.x() + 0.6, 0, root.z() + 0.6));
  }
  // Fit what will be drawn: the bodies and the floor under them.
  camera.pixels_per_metre = 1;
  Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9);
  const auto include = [&](const Vec3& p) {
    least = least.cwiseMin(camera.project(p));
    most = most.cwiseMax(camera.project(p));
  };
  for (int f = 0; f < motion.frames; ++f) {
    for (int j = 0; j < motion.joints; ++j) include(joint_position(motion, f, j));
  }
  for (const Vec3& corner : {low, high, Vec3(low.x(), 0, high.z()), Vec3(high.x(), 0, low.z())})
    include(corner);
  least.array() -= 0.15;
  most.array() += 0.1;
  const double scale =
      std::min({width / (most.x() - least.x()), height / (most.y() - least.y()), 130.0});
  camera.pixels_per_metre = scale;
  camera.x = x + width / 2 - scale * (least.x() + most.x()) / 2;
  camera.y = top + height / 2 - scale * (least.y() + most.y()) / 2;
  cairo_save(cairo);
  cairo_rectangle(cairo, x, top, width, height);
  cairo_clip(cairo);
  draw_floor(cairo, camera, low, high, 0.5);
  draw_root_path(cairo, camera, motion, options.fps);
  for (int i = 0; i < options.onion_poses; ++i) {
    const int frame = frame_of(i, options.onion_poses, motion.frames);
    const double age = static_cast<double>(i) / (options.onion_poses - 1);
    // Shadows in one place would add up to black.
    const bool moved_on =
        i + 1 == options.onion_poses ||
        (joint_position(motion, frame, 0) -
         joint_position(motion, frame_of(i + 1, options.onion_poses, motion.frames), 0))
                .norm() > 0.3;
    if (moved_on) draw_shadow(cairo, camera, motion, frame, 0.4 + 0.5 * age);
    draw_figure(cairo, camera, motion, frame, 0.22 + 0.78 * age * age);
  }
  cairo_restore(cairo);
}

void draw_row(cairo_t* cairo, const SheetRow& row, const SheetOptions& options, double y) {
  const double width = options.width - 2 * kMargin, height = card_height(row);
  rounded_rectangle(cairo, kMargin, y + 2, width, height, 14);
  cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, 0.07);
  cairo_fill(cairo);
  rounded_rectangle(cairo, kMargin, y, width, height, 14);
  cairo_set_source_rgb(cairo, 0.995, 0.992, 0.985);
  cairo_fill_preserve(cairo);
  cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, 0.10);
  cairo_set_line_width(cairo, 1);
  cairo_stroke(cairo);
  const double x = kMargin + kPadding, inner = width - 2 * kPadding;
  double at = y + kPadding;
  show_text(cairo, x, at + 18, row.title, 20, true, 0.16, inner);
  at += kTitleHeight;
  if (!row.subtitle.empty()) {
    show_text(cairo, x, at + 10, row.subtitle, 13.5, false, 0.45, inner);
    at += kSubtitleHeight;
  }
  const double onion = options.onion_poses > 0 ? inner * kOnionShare : 0;
  const double poses = inner - onion - (onion > 0 ? 24 : 0);
  draw_poses(cairo, row, options, x, at + kFigureHeight, poses);
  if (onion <= 0) return;
  cairo_move_to(cairo, x + poses + 12, at);
  cairo_line_to(cairo, x + poses + 12, y + height - kPadding);
  cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, 0.10);
  cairo_set_line_width(cairo, 1);
  cairo_stroke(cairo);
  draw_onion(cairo, row, options, x + poses + 24, at - 14, onion,
             kFigureHeight + kTimesHeight + 20);
}

}  // namespace

void write_contact_sheet(const std::string& png_path, const std::vector<SheetRow>& rows,
                         const SheetOptions& options) {
  check_sheet(rows, options);
  const double heading = options.heading.empty() ? 0 : 52;
  double height = 2 * kMargin + heading - kCardGap;
  for (const SheetRow& row : rows) height += card_height(row) + kCardGap;
  const PngCanvas canvas(options.width, height);
  cairo_t* cairo = canvas.cairo();
  double y = kMargin;
  if (heading > 0) {
    show_text(cairo, kMargin + 4, y + 26, options.heading, 27, true, 0.16,
              options.width - 2 * kMargin);
    y += heading;
  }
  for (const SheetRow& row : rows) {
    draw_row(cairo, row, options, y);
    y += card_height(row) + kCardGap;
  }
  canvas.write(png_path);
}

}  // namespace remomask::drawing
