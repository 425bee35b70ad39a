// Drawing into 8-bit pictures; everything is cut off at the borders.
#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "render/font.h"

namespace brdfit::render {
namespace {

std::uint8_t* pixel(Picture& picture, int x, int y) {
  return picture.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                   static_cast<std::size_t>(x));
}

std::uint8_t mix(std::uint8_t below, std::uint8_t above, int coverage) {
  return static_cast<std::uint8_t>((below * (255 - coverage) + above * coverage + 127) / 255);
}

void blend(Picture& picture, int x, int y, Colour8 colour, int coverage) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height || coverage == 0) return;
  std::uint8_t* p = pixel(picture, x, y);
  p[0] = mix(p[0], colour.r, coverage);
  p[1] = mix(p[1], colour.g, coverage);
  p[2] = mix(p[2], colour.b, coverage);
}

// From the place that a text is aligned to, to the baseline, by the font's own measures (DejaVu Sans has
// ascenders of 0.76 em, capitals of 0.73 em, descenders of 0.24 em): lines of different letters then agree.
int baseline_below(AlignY align, int size_px) {
  const auto em = [size_px](double share) { return static_cast<int>(std::lround(share * size_px)); };
  switch (align) {
    case AlignY::kTop:
      return em(0.76);
    case AlignY::kCentre:
      return em(0.365);
    case AlignY::kBottom:
      return -em(0.24);
    case AlignY::kBaseline:
      break;
  }
  return 0;
}

int pen_start(AlignX align, int width) {
  if (align == AlignX::kCentre) return -width / 2;
  return align == AlignX::kRight ? -width : 0;
}

int advance_of(const std::vector<const Glyph*>& glyphs) {
  int width = 0;
  for (const Glyph* glyph : glyphs) width += glyph->advance;
  return width;
}

}  // namespace

Canvas::Canvas(int width, int height, Colour8 background) {
  if (width < 1 || height < 1) throw std::invalid_argument("Canvas: a side is below 1 pixel");
  picture_ = Picture(width, height);
  fill(0, 0, width, height, background);
}

void Canvas::fill(int x, int y, int width, int height, Colour8 colour) {
  const int x_begin = std::max(x, 0);
  const int x_end = std::min(x + width, picture_.width);
  const int y_end = std::min(y + height, picture_.height);
  for (int row = std::max(y, 0); row < y_end; ++row) {
    for (int column = x_begin; column < x_end; ++column) {
      std::uint8_t* p = pixel(picture_, column, row);
      p[0] = colour.r;
      p[1] = colour.g;
      p[2] = colour.b;
    }
  }
}

void Canvas::frame(int x, int y, int width, int height, Colour8 colour) {
  fill(x, y, width, 1, colour);
  fill(x, y + height - 1, width, 1, colour);
  fill(x, y, 1, height, colour);
  fill(x + width - 1, y, 1, height, colour);
}

void Canvas::line(int x0, int y0, int x1, int y1, Colour8 colour) {
  if (x0 != x1 && y0 != y1) throw std::invalid_argument("Canvas::line: neither horizontal nor vertical");
  fill(std::min(x0, x1), std::min(y0, y1), std::abs(x1 - x0) + 1, std::abs(y1 - y0) + 1, colour);
}

void Canvas::paste(const Picture& picture, int x, int y) {
  const int first = std::max(0, -x);
  const int last = std::min(picture.width, picture_.width - x);
  if (first >= last) return;
  for (int row = std::max(0, -y); row < std::min(picture.height, picture_.height - y); ++row) {
    const std::size_t begin = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                                   static_cast<std::size_t>(first));
    std::copy_n(picture.rgb.data() + begin, 3 * static_cast<std::size_t>(last - first),
                pixel(picture_, x + first, y + row));
  }
}

void Canvas::text(int x, int y, std::string_view text, const TextStyle& style) {
  const std::vector<const Glyph*> glyphs = glyphs_of(text, style.size_px, style.weight);
  const int baseline = baseline_below(style.align_y, style.size_px);
  int pen = pen_start(style.align_x, advance_of(glyphs));
  for (const Glyph* glyph : glyphs) {
    for (int row = 0; row < glyph->height; ++row) {
      for (int column = 0; column < glyph->width; ++column) {
        const int along = pen + glyph->left + column;
        const int down = baseline + glyph->top + row;
        const int coverage =
            glyph->coverage[static_cast<std::size_t>(row) * static_cast<std::size_t>(glyph->width) +
                            static_cast<std::size_t>(column)];
        if (style.upwards) {
          blend(picture_, x + down, y - 1 - along, style.colour, coverage);
        } else {
          blend(picture_, x + along, y + down, style.colour, coverage);
        }
      }
    }
    pen += glyph->advance;
  }
}

int text_width(std::string_view text, int size_px, FontWeight weight) {
  return advance_of(glyphs_of(text, size_px, weight));
}

}  // namespace brdfit::render
