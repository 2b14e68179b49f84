#include "drawing/skeleton_drawing.h"

#include <algorithm>
#include <cmath>

#include "drawing/png_canvas.h"
#include "remomask/skeleton.h"

namespace remomask::drawing {

namespace {

constexpr int kWidth = 1500;
constexpr double kHeight = 860, kTop = 110, kBottom = 40;
constexpr double kFrontCentre = 620, kSideCentre = 1290;
constexpr double kColumn = 300;  // of labels, at either side of the front view
constexpr double kLineHeight = 34;

/// Draws one view; `across` is the axis that points to the right of the picture.
class SkeletonView2d {
 public:
  SkeletonView2d(cairo_t* cairo, const SkeletonPicture& picture, const Vec3& across, double centre)
      : cairo_(cairo), picture_(picture), across_(across), centre_(centre) {
    low_ = high_ = picture.ours.at(0, 0)[1];
    double widest = 0.1;
    for (int j = 0; j < picture.ours.joints; ++j) {
      const Vec3 p = joint_position(picture.ours, 0, j);
      low_ = std::min(low_, p.y());
      high_ = std::max(high_, p.y());
      middle_ += p / picture.ours.joints;
    }
    for (int j = 0; j < picture.ours.joints; ++j) {
      widest =
          std::max(widest, std::abs((joint_position(picture.ours, 0, j) - middle_).dot(across)));
    }
    scale_ = std::min((kHeight - kTop - kBottom - 60) / std::max(0.1, high_ - low_), 240 / widest);
  }

  Eigen::Vector2d project(const Vec3& point) const {
    return {centre_ + scale_ * (point - middle_).dot(across_),
            kHeight - kBottom - 20 - scale_ * (point.y() - low_)};
  }

  void draw() const {
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
    for (size_t j = 0; j < picture_.joints.size(); ++j) {
      const int parent = picture_.parents[j];
      if (parent < 0) continue;
      line(picture_.joints[static_cast<size_t>(parent)], picture_.joints[j], 7, {0.8, 0.79, 0.77});
    }
    const Skeleton& skeleton = humanml_skeleton();
    for (int j = 1; j < skeleton.joints(); ++j) {
      line(joint_position(picture_.ours, 0, skeleton.parents[static_cast<size_t>(j)]),
           joint_position(picture_.ours, 0, j), 2.5, colour(j));
    }
    for (int j = 0; j < skeleton.joints(); ++j) {
      const Eigen::Vector2d at = project(joint_position(picture_.ours, 0, j));
      const Vec3 c = colour(j);
      cairo_set_source_rgb(cairo_, c.x(), c.y(), c.z());
      cairo_new_path(cairo_);
      cairo_arc(cairo_, at.x(), at.y(), 5, 0, 4 * std::acos(0.0));
      cairo_fill(cairo_);
    }
  }

  /// The left side is warm, the right side cool, the trunk dark, as in all pictures.
  static Vec3 colour(int joint) {
    const int mirror = humanml_skeleton().mirror[static_cast<size_t>(joint)];
    if (mirror == joint) return {0.25, 0.25, 0.28};
    return mirror > joint ? Vec3(0.85, 0.42, 0.16) : Vec3(0.15, 0.43, 0.72);
  }

  void line(const Vec3& a, const Vec3& b, double width, const Vec3& rgb) const {
    const Eigen::Vector2d from = project(a), to = project(b);
    cairo_set_source_rgb(cairo_, rgb.x(), rgb.y(), rgb.z());
    cairo_set_line_width(cairo_, width);
    cairo_move_to(cairo_, from.x(), from.y());
    cairo_line_to(cairo_, to.x(), to.y());
    cairo_stroke(cairo_);
  }

 private:
  cairo_t* cairo_;
  const SkeletonPicture& picture_;
  Vec3 across_, middle_ = Vec3::Zero();
  double centre_, scale_ = 1, low_ = 0, high_ = 0;
};

/// Names of the joints in two columns, in the order of their heights, each with a line to its
/// joint. The trunk's go to the column of the person's right side, which has room on the left.
void draw_labels(cairo_t* cairo, const SkeletonPicture& picture, const SkeletonView2d& front) {
  const std::vector<std::string>& names = humanml_skeleton().joint_names;
  for (const bool left_column : {true, false}) {
    std::vector<int> joints;
    for (int j = 0; j < picture.ours.joints; ++j) {
      const double x = front.project(joint_position(picture.ours, 0, j)).x();
      const int mirror = humanml_skeleton().mirror[static_cast<size_t>(j)];
      const bool in_trunk = mirror == j;
      const bool here = in_trunk ? left_column == (j % 2 == 0) : left_column == (x < kFrontCentre);
      if (here) joints.push_back(j);
    }
    std::stable_sort(joints.begin(), joints.end(), [&](int a, int b) {
      return picture.ours.at(0, a)[1] > picture.ours.at(0, b)[1];
    });
    double next = kTop;
    for (size_t i = 0; i < joints.size(); ++i) {
      const int j = joints[i];
      const Eigen::Vector2d at = front.project(joint_position(picture.ours, 0, j));
      const double room = static_cast<double>(joints.size() - i) * kLineHeight;
      const double y = std::clamp(at.y() - 8, next, std::max(next, kHeight - kBottom - room));
      next = y + kLineHeight;
      const double x = left_column ? 24 : 2 * kFrontCentre - kColumn - 24;
      show_text(cairo, x, y, names[static_cast<size_t>(j)], 13, true, 0.2, kColumn - 80);
      show_text(cairo, x, y + 15, picture.labels[static_cast<size_t>(j)], 12, false, 0.4,
                kColumn - 80);
      const Vec3 c = SkeletonView2d::colour(j);
      cairo_set_source_rgba(cairo, c.x(), c.y(), c.z(), 0.35);
      cairo_set_line_width(cairo, 1);
      cairo_move_to(cairo, left_column ? x + kColumn - 76 : x - 6, y);
      cairo_line_to(cairo, at.x(), at.y());
      cairo_stroke(cairo);
    }
  }
}

}  // namespace

void write_skeleton_picture(const std::string& png_path, const SkeletonPicture& picture) {
  const PngCanvas canvas(kWidth, kHeight);
  cairo_t* cairo = canvas.cairo();
  show_text(cairo, 24, 40, picture.title, 20, true, 0.15, kWidth - 48);
  show_text(cairo, 24, 64, picture.subtitle, 13, false, 0.4, kWidth - 48);
  // From the front the person's left is at the right of the picture.
  const SkeletonView2d front(cairo, picture, Vec3(1, 0, 0), kFrontCentre);
  const SkeletonView2d side(cairo, picture, Vec3(0, 0, 1), kSideCentre);
  front.draw();
  side.draw();
  draw_labels(cairo, picture, front);
  canvas.write(png_path);
}

}  // namespace remomask::drawing
