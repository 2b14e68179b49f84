#pragma once

#include <cairo.h>

#include <memory>
#include <string>

namespace remomask::drawing {

/// A paper-coloured picture that becomes a PNG file.
class PngCanvas {
 public:
  /// Size in pixels.
  PngCanvas(int width, double height);

  cairo_t* cairo() const { return cairo_.get(); }
  /// Writes the file atomically. Throws Error if drawing failed or the file cannot be written.
  void write(const std::string& png_path) const;

 private:
  struct Deleter {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  std::unique_ptr<cairo_surface_t, Deleter> surface_;
  std::unique_ptr<cairo_t, Deleter> cairo_;
};

/// Makes the path without drawing it.
void rounded_rectangle(cairo_t* cairo, double x, double y, double width, double height, double r);

/// Text from its left baseline, truncated with an ellipsis if it is too wide.
void show_text(cairo_t* cairo, double x, double y, const std::string& text, double size, bool bold,
               double grey, double max_width);

}  // namespace remomask::drawing
