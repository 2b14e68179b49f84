#include "drawing/png_canvas.h"

#include <cmath>

#include "base/file.h"
#include "remomask/error.h"

namespace remomask::drawing {

namespace {

cairo_status_t append_png(void* closure, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

PngCanvas::PngCanvas(int width, double height)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width,
                                          static_cast<int>(std::ceil(height)))),
      cairo_(cairo_create(surface_.get())) {
  cairo_set_source_rgb(cairo(), 0.955, 0.95, 0.94);
  cairo_paint(cairo());
}

void PngCanvas::write(const std::string& png_path) const {
  cairo_surface_flush(surface_.get());
  std::string png;
  cairo_status_t status = cairo_status(cairo());
  if (status == CAIRO_STATUS_SUCCESS) {
    status = cairo_surface_write_to_png_stream(surface_.get(), append_png, &png);
  }
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Error(png_path + ": cannot draw the picture: " + cairo_status_to_string(status) +
                "; a picture has at most 32767 pixels a side, so draw fewer motions in one");
  }
  write_file_atomically(png_path, png);
}

void rounded_rectangle(cairo_t* cairo, double x, double y, double width, double height, double r) {
  const double quarter = std::acos(0.0);
  cairo_new_path(cairo);
  cairo_arc(cairo, x + width - r, y + r, r, -quarter, 0);
  cairo_arc(cairo, x + width - r, y + height - r, r, 0, quarter);
  cairo_arc(cairo, x + r, y + height - r, r, quarter, 2 * quarter);
  cairo_arc(cairo, x + r, y + r, r, 2 * quarter, 3 * quarter);
  cairo_close_path(cairo);
}

/// Text from its left baseline, truncated with an ellipsis if it is too wide.
void show_text(cairo_t* cairo, double x, double y, const std::string& text, double size, bool bold,
               double grey, double max_width) {
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, size);
  std::string shown = text;
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, shown.c_str(), &extents);
  std::string kept = text;
  while (extents.x_advance > max_width && !kept.empty()) {
    // Removes whole UTF-8 characters.
    do {
      const bool inside = (static_cast<unsigned char>(kept.back()) & 0xC0) == 0x80;
      kept.pop_back();
      if (!inside) break;
    } while (!kept.empty());
    shown = kept + "\u2026";
    cairo_text_extents(cairo, shown.c_str(), &extents);
  }
  cairo_set_source_rgb(cairo, grey, grey, grey * 1.08);
  cairo_move_to(cairo, x, y);
  cairo_show_text(cairo, shown.c_str());
}

}  // namespace remomask::drawing
