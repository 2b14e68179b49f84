#include "lab/ablation_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "drawing/png_canvas.h"
#include "lab/ablation_report.h"

namespace remomask::lab {

namespace {

constexpr int kChartWidth = 1180;
constexpr double kChartPanelWidth = 300, kChartPanelHeight = 250, kChartLeft = 76,
                 kChartBetween = 76, kChartTop = 120;
constexpr double kChartBetweenRows = 140;

/// The figures of the table that the pictures show.
std::vector<lab::AblationColumn> drawn_columns() {
  return {lab::ablation_columns()[0], lab::ablation_columns()[2], lab::ablation_columns()[3]};
}

double mean_of_seeds(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The smallest of 1, 2, 5 x 10^n that is not below the value.
double axis_end(double value) {
  if (value <= 0) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= value) return step * power;
  }
  return 10 * power;
}

/// A panel whose vertical axis goes from 0 to `high`.
struct ChartPanel {
  cairo_t* cairo;
  double left, top, high;

  double y(double value) const { return top + kChartPanelHeight * (1 - value / high); }

  void draw(const lab::AblationColumn& column) const {
    drawing::rounded_rectangle(cairo, left - 52, top - 44, kChartPanelWidth + 68,
                               kChartPanelHeight + 124, 14);
    cairo_set_source_rgb(cairo, 0.995, 0.992, 0.985);
    cairo_fill(cairo);
    drawing::show_text(cairo, left, top - 18, column.title, 16, true, 0.16, kChartPanelWidth);
    cairo_set_line_width(cairo, 1);
    for (int i = 0; i <= 4; ++i) {
      const double value = high * i / 4;
      cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, i == 0 ? 0.5 : 0.12);
      cairo_move_to(cairo, left, y(value));
      cairo_line_to(cairo, left + kChartPanelWidth, y(value));
      cairo_stroke(cairo);
      drawing::show_text(cairo, left - 42, y(value) + 5, fmt::format("{:.3g}", value), 12.5, false,
                         0.4, 42);
    }
  }

  void draw_reference(const std::vector<double>& real) const {
    if (real.empty() || real.front() > high) return;
    const double dashes[] = {6, 5};
    cairo_set_dash(cairo, dashes, 2, 0);
    cairo_set_source_rgba(cairo, 0.2, 0.2, 0.3, 0.6);
    cairo_set_line_width(cairo, 1.5);
    cairo_move_to(cairo, left, y(real.front()));
    cairo_line_to(cairo, left + kChartPanelWidth, y(real.front()));
    cairo_stroke(cairo);
    cairo_set_dash(cairo, nullptr, 0, 0);
  }

  void draw_range(double x, double least, double most) const {
    cairo_set_source_rgb(cairo, 0.2, 0.2, 0.3);
    cairo_set_line_width(cairo, 2);
    cairo_move_to(cairo, x, y(least));
    cairo_line_to(cairo, x, y(most));
    cairo_stroke(cairo);
  }
};

/// In the unit of the table.
std::vector<double> printed_values(const nlohmann::json& variant,
                                   const lab::AblationColumn& column) {
  std::vector<double> values = lab::seed_values(variant, "all", column.path);
  for (double& value : values) value *= column.scale;
  return values;
}

void show_slanted(cairo_t* cairo, double x, double y, const std::string& text) {
  cairo_save(cairo);
  cairo_translate(cairo, x, y);
  cairo_rotate(cairo, std::numbers::pi / 5);
  drawing::show_text(cairo, 0, 0, text, 12, false, 0.25, 118);
  cairo_restore(cairo);
}

void draw_bars(const ChartPanel& panel, const nlohmann::json& variants,
               const lab::AblationColumn& column) {
  const double slot = kChartPanelWidth / static_cast<double>(variants.size());
  for (size_t i = 0; i < variants.size(); ++i) {
    const double x = panel.left + slot * static_cast<double>(i);
    show_slanted(panel.cairo, x + 0.4 * slot, panel.y(0) + 16, variants[i].at("name"));
    const std::vector<double> values = printed_values(variants[i], column);
    if (values.empty()) continue;
    const double mean = mean_of_seeds(values);
    if (i == 0) {
      cairo_set_source_rgb(panel.cairo, 0.91, 0.43, 0.23);
    } else {
      cairo_set_source_rgb(panel.cairo, 0.16, 0.50, 0.79);
    }
    cairo_rectangle(panel.cairo, x + 0.15 * slot, panel.y(mean), 0.7 * slot,
                    panel.y(0) - panel.y(mean));
    cairo_fill(panel.cairo);
    if (values.size() == 1) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    panel.draw_range(x + 0.5 * slot, *least, *most);
  }
}

void draw_line(const ChartPanel& panel, const nlohmann::json& points,
               const lab::AblationColumn& column) {
  const double slot = kChartPanelWidth / static_cast<double>(points.size());
  std::vector<std::pair<double, double>> corners;
  for (size_t i = 0; i < points.size(); ++i) {
    const double x = panel.left + slot * (static_cast<double>(i) + 0.5);
    drawing::show_text(panel.cairo, x - 8, panel.y(0) + 20,
                       fmt::format("{:g}", points[i].at("value").get<double>()), 12.5, false, 0.3,
                       40);
    const auto values = printed_values(lab::one_seed(points[i].at("figures")), column);
    if (!values.empty()) corners.emplace_back(x, panel.y(values.front()));
  }
  cairo_set_source_rgb(panel.cairo, 0.16, 0.50, 0.79);
  cairo_set_line_width(panel.cairo, 2.5);
  cairo_new_path(panel.cairo);  // text leaves a current point
  for (const auto& [x, y] : corners) cairo_line_to(panel.cairo, x, y);
  cairo_stroke(panel.cairo);
  for (const auto& [x, y] : corners) {
    cairo_new_path(panel.cairo);
    cairo_arc(panel.cairo, x, y, 4.5, 0, 2 * std::numbers::pi);
    cairo_fill(panel.cairo);
  }
}

/// The panels of a row: `series` are variants or points of a sweep.
template <typename Draw>
void draw_row(cairo_t* cairo, double top, const nlohmann::json& series,
              const nlohmann::json& document, Draw draw) {
  const std::vector<lab::AblationColumn> columns = drawn_columns();
  for (size_t i = 0; i < columns.size(); ++i) {
    const auto real = printed_values(lab::one_seed(document.at("real")), columns[i]);
    double high = real.empty() ? 0 : real.front();
    for (const auto& entry : series) {
      const auto values = printed_values(
          entry.contains("seeds") ? entry : lab::one_seed(entry.at("figures")), columns[i]);
      for (const double value : values) high = std::max(high, value);
    }
    const ChartPanel panel{cairo,
                           kChartLeft + static_cast<double>(i) * (kChartPanelWidth + kChartBetween),
                           top, axis_end(high)};
    panel.draw(columns[i]);
    panel.draw_reference(real);
    draw(panel, series, columns[i]);
  }
}

std::string heading_note(const nlohmann::json& document) {
  return fmt::format("preset {}, {} prompts of split {}; dashed: real clips",
                     document.at("preset").get<std::string>(), document.at("prompts").get<int>(),
                     document.at("split").get<std::string>());
}

}  // namespace

void draw_ablation_bars(const std::string& png_path, const nlohmann::json& document) {
  const drawing::PngCanvas canvas(kChartWidth, kChartTop + kChartPanelHeight + 110);
  cairo_t* cairo = canvas.cairo();
  drawing::show_text(cairo, 32, 40, "What each part of the model brings", 21, true, 0.16,
                     kChartWidth - 64);
  drawing::show_text(
      cairo, 32, 63,
      heading_note(document) + "; bars: mean of the seeds, lines: minimum to maximum", 13.5, false,
      0.45, kChartWidth - 64);
  draw_row(cairo, kChartTop, document.at("variants"), document, draw_bars);
  canvas.write(png_path);
}

bool draw_ablation_sweeps(const std::string& png_path, const nlohmann::json& document) {
  const std::vector<std::pair<const char*, const char*>> sweeps = {
      {"guidance", "against guidance"}, {"steps", "against the number of passes"}};
  std::vector<std::pair<const char*, const char*>> measured;
  for (const auto& sweep : sweeps) {
    if (!document.at("sweeps").at(sweep.first).empty()) measured.push_back(sweep);
  }
  if (measured.empty()) return false;
  const double row = kChartPanelHeight + kChartBetweenRows;
  const drawing::PngCanvas canvas(kChartWidth,
                                  kChartTop + row * static_cast<double>(measured.size()));
  cairo_t* cairo = canvas.cairo();
  drawing::show_text(cairo, 32, 40, "Sampling one model in other ways", 21, true, 0.16,
                     kChartWidth - 64);
  drawing::show_text(cairo, 32, 63, heading_note(document), 13.5, false, 0.45, kChartWidth - 64);
  for (size_t i = 0; i < measured.size(); ++i) {
    const double top = kChartTop + row * static_cast<double>(i);
    draw_row(cairo, top, document.at("sweeps").at(measured[i].first), document, draw_line);
    drawing::show_text(cairo, kChartLeft, top + kChartPanelHeight + 46, measured[i].second, 14,
                       false, 0.3, 400);
  }
  canvas.write(png_path);
  return true;
}

}  // namespace remomask::lab
