// An 8-bit picture to draw panels on: rectangles, pictures, lines and text.
#ifndef BRDFIT_RENDER_CANVAS_H_
#define BRDFIT_RENDER_CANVAS_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "render/image.h"

namespace brdfit::render {

struct Colour8 {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};

enum class AlignX { kLeft, kCentre, kRight };
enum class AlignY { kTop, kCentre, kBaseline, kBottom };
enum class FontWeight { kRegular, kBold };

struct TextStyle {
  int size_px = 16;  // of the font's em square
  Colour8 colour = {32, 32, 32};
  AlignX align_x = AlignX::kLeft;
  AlignY align_y = AlignY::kBaseline;
  FontWeight weight = FontWeight::kRegular;
  bool upwards = false;  // turned by 90 degrees, read from bottom to top; alignment is along the text
};

// Coordinates are pixels from the top left corner; what lies outside is cut off.
class Canvas {
 public:
  // Throws std::invalid_argument when a side is below 1 pixel.
  Canvas(int width, int height, Colour8 background);

  int width() const { return picture_.width; }
  int height() const { return picture_.height; }

  void fill(int x, int y, int width, int height, Colour8 colour);
  void frame(int x, int y, int width, int height, Colour8 colour);  // one pixel wide, inside the rectangle
  // One pixel wide, with both ends. Throws std::invalid_argument unless it is horizontal or vertical.
  void line(int x0, int y0, int x1, int y1, Colour8 colour);
  void paste(const Picture& picture, int x, int y);

  // UTF-8, rendered with DejaVu Sans through FreeType. Throws std::runtime_error that names the package to
  // install (fonts-dejavu-core) when the font is not there, std::invalid_argument for a size below 1 pixel.
  // Bytes that are not UTF-8 are shown as U+FFFD, control characters as spaces.
  void text(int x, int y, std::string_view text, const TextStyle& style);

  const Picture& picture() const { return picture_; }

 private:
  Picture picture_;
};

// Width in pixels that a line of text takes. Throws as Canvas::text.
int text_width(std::string_view text, int size_px, FontWeight weight);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_CANVAS_H_
