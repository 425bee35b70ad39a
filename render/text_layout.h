// Lines of text in a column of given width: wrapped, with values aligned to its right edge.
#ifndef BRDFIT_RENDER_TEXT_LAYOUT_H_
#define BRDFIT_RENDER_TEXT_LAYOUT_H_

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/canvas.h"
#include "render/image.h"

namespace brdfit::render {

// Words on as few lines as they need; a word wider than the column is broken. At least one line, which may be
// empty. '\n' ends a line.
std::vector<std::string> wrap_text(std::string_view text, int size_px, FontWeight weight, int width);

// One row of a column of text.
struct TextRow {
  std::string left;
  std::string right;                 // aligned to the column's right edge
  std::optional<PixelState> swatch;  // a sample of how such pixels look, before the text
  bool indented = false;             // goes on with the text of a row with a swatch
};

// A line as rows: what follows a tab is aligned to the right, in a row of its own where there is no room.
std::vector<TextRow> rows_of(const std::string& line, int size_px, int width);
std::vector<TextRow> rows_of(std::span<const std::string> lines, int size_px, int width);

// A note with a swatch before it.
std::vector<TextRow> rows_with_swatch(PixelState state, const std::string& text, int size_px, int width);

// From one baseline to the next.
int row_height(int size_px);

// Rows from the top y downwards.
void draw_rows(Canvas& canvas, int x, int y, std::span<const TextRow> rows, int size_px, int width,
               FontWeight weight = FontWeight::kRegular);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_TEXT_LAYOUT_H_
