#include "evaluation/reliability_diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drawing/png_canvas.h"

namespace remomask::evaluation {

namespace {

constexpr int kWidth = 1180, kHeight = 620;
constexpr double kPanel = 430, kTop = 120, kLeft = 90, kBetween = 140;
constexpr int kHistogramBars = 40;

/// A square panel with axes from `low` to `high` and from 0 to 1.
struct Panel {
  cairo_t* cairo;
  double left, low, high;

  double x(double value) const { return left + kPanel * (value - low) / (high - low); }
  double y(double share) const { return kTop + kPanel * (1 - share); }

  void draw(const std::string& title, const std::string& below) const {
    drawing::rounded_rectangle(cairo, left - 58, kTop - 48, kPanel + 82, kPanel + 110, 14);
    cairo_set_source_rgb(cairo, 0.995, 0.992, 0.985);
    cairo_fill(cairo);
    drawing::show_text(cairo, left, kTop - 18, title, 16, true, 0.16, kPanel);
    cairo_set_line_width(cairo, 1);
    for (int i = 0; i <= 5; ++i) {
      const double share = i / 5.0, value = low + share * (high - low);
      cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, i == 0 ? 0.5 : 0.12);
      cairo_move_to(cairo, left, y(share));
      cairo_line_to(cairo, left + kPanel, y(share));
      cairo_move_to(cairo, x(value), y(0));
      cairo_line_to(cairo, x(value), y(1));
      cairo_stroke(cairo);
      drawing::show_text(cairo, left - 40, y(share) + 5, fmt::format("{:.1f}", share), 13, false,
                         0.4, 60);
      drawing::show_text(cairo, x(value) - 12, y(0) + 22, fmt::format("{:.2f}", value), 13, false,
                         0.4, 60);
    }
    drawing::show_text(cairo, left, y(0) + 46, below, 14, false, 0.3, kPanel);
  }
};

void draw_histogram(const Panel& panel, const std::vector<double>& values) {
  std::vector<double> bars(kHistogramBars);
  for (const double value : values) {
    const double place = (value - panel.low) / (panel.high - panel.low) * kHistogramBars;
    bars[static_cast<size_t>(std::clamp(place, 0.0, kHistogramBars - 1.0))] += 1;
  }
  const double most = *std::max_element(bars.begin(), bars.end());
  if (most == 0) return;
  cairo_set_source_rgba(panel.cairo, 0.16, 0.50, 0.79, 0.25);
  for (int i = 0; i < kHistogramBars; ++i) {
    const double height = 0.3 * kPanel * bars[static_cast<size_t>(i)] / most;
    cairo_rectangle(panel.cairo, panel.left + kPanel * i / kHistogramBars + 1, panel.y(0) - height,
                    kPanel / kHistogramBars - 2, height);
  }
  cairo_fill(panel.cairo);
}

void draw_calibration(const Panel& panel, const search::Calibration& calibration) {
  cairo_set_source_rgb(panel.cairo, 0.91, 0.43, 0.23);
  cairo_set_line_width(panel.cairo, 3);
  for (int i = 0; i <= 400; ++i) {
    const double score = panel.low + (panel.high - panel.low) * i / 400;
    cairo_line_to(panel.cairo, panel.x(score), panel.y(calibration.probability(score)));
  }
  cairo_stroke(panel.cairo);
}

void draw_bins(const Panel& panel, const std::vector<search::ReliabilityBin>& bins) {
  cairo_set_source_rgba(panel.cairo, 0.2, 0.2, 0.3, 0.5);
  cairo_set_line_width(panel.cairo, 1.5);
  cairo_move_to(panel.cairo, panel.x(0), panel.y(0));
  cairo_line_to(panel.cairo, panel.x(1), panel.y(1));
  cairo_stroke(panel.cairo);
  int64_t most = 1;
  for (const search::ReliabilityBin& bin : bins) most = std::max(most, bin.count);
  for (const search::ReliabilityBin& bin : bins) {
    if (bin.count == 0) continue;
    const double radius =
        4 + 14 * std::sqrt(static_cast<double>(bin.count) / static_cast<double>(most));
    cairo_new_path(panel.cairo);
    cairo_arc(panel.cairo, panel.x(bin.predicted), panel.y(bin.right), radius, 0,
              2 * std::numbers::pi);
    cairo_set_source_rgba(panel.cairo, 0.91, 0.43, 0.23, 0.75);
    cairo_fill(panel.cairo);
  }
}

}  // namespace

void write_reliability_diagram(const std::string& png_path, const ReliabilityPicture& picture) {
  const drawing::PngCanvas canvas(kWidth, kHeight);
  cairo_t* cairo = canvas.cairo();
  drawing::show_text(cairo, 32, 40, picture.heading, 21, true, 0.16, kWidth - 64);
  drawing::show_text(cairo, 32, 63, picture.note, 13.5, false, 0.45, kWidth - 64);
  const auto [low, high] =
      std::minmax_element(picture.similarities.begin(), picture.similarities.end());
  const bool spread = low != picture.similarities.end() && *low < *high;
  const Panel table{cairo, kLeft, spread ? *low : -1, spread ? *high : 1};
  table.draw("Share right at a " + picture.scored,
             picture.scored + " of the hit (bars: how often it occurs)");
  draw_histogram(table, picture.similarities);
  draw_calibration(table, picture.calibration);
  const Panel reliability{cairo, kLeft + kPanel + kBetween, 0, 1};
  reliability.draw("Share right against the predicted share",
                   "predicted share (area: number of hits)");
  draw_bins(reliability, picture.bins);
  canvas.write(png_path);
}

}  // namespace remomask::evaluation
