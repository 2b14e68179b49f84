#pragma once

#include <cairo.h>

#include <memory>
#include <string>

namespace remomask::drawing {

/// A picture in the colour of paper that becomes a PNG file.
class PngCanvas {
 public:
  /// In pixels.
  PngCanvas(int width, double height);

  cairo_t* cairo() const { return cairo_.get(); }
  /// Atomically. Throws Error when drawing failed or the file cannot be written.
  void write(const std::string& png_path) const;

 private:
  struct Deleter {
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  };
  std::unique_ptr<cairo_surface_t, Deleter> surface_;
  std::unique_ptr<cairo_t, Deleter> cairo_;
};

/// Makes the path, draws nothing.
void rounded_rectangle(cairo_t* cairo, double x, double y, double width, double height, double r);

/// Text from its left baseline, cut with an ellipsis where it is too wide.
void show_text(cairo_t* cairo, double x, double y, const std::string& text, double size, bool bold,
               double grey, double max_width);

}  // namespace remomask::drawing
