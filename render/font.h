// Glyphs of the packaged font (DejaVu Sans), as coverage bitmaps.
#ifndef BRDFIT_RENDER_FONT_H_
#define BRDFIT_RENDER_FONT_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "render/canvas.h"

namespace brdfit::render {

// A glyph with the pen at (0, 0) on the baseline; x to the right, y down.
struct Glyph {
  int advance = 0;  // of the pen, in pixels
  int left = 0;     // the ink's box
  int top = 0;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> coverage;  // width x height, 255 is full ink
};

// The glyphs of a line of UTF-8 text. Bytes that are not UTF-8 are shown as U+FFFD, control characters as
// spaces. Throws std::runtime_error that names the package to install when the font is not found, and
// std::invalid_argument for a size below 1.
//
// Glyphs are kept for the life of the program, by character, size and weight; what is drawn does not depend
// on what is kept. May be called from any thread.
std::vector<const Glyph*> glyphs_of(std::string_view text, int size_px, FontWeight weight);

// Code points of UTF-8 text, as above.
std::u32string decode_utf8(std::string_view text);

// The first byte after the UTF-8 character that begins at `begin`.
std::size_t next_character(std::string_view text, std::size_t begin);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_FONT_H_
