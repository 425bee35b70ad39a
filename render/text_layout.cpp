// Wrapping and aligning lines of text.
#include "render/text_layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "render/font.h"
#include "render/view.h"

namespace brdfit::render {
namespace {

int swatch_px(int size_px) {
  return size_px;
}
int swatch_room(int size_px) {
  return size_px + size_px / 2;
}

// The longest beginning of a word that fits, of one character at least.
std::size_t fitting_bytes(std::string_view word, int size_px, FontWeight weight, int width) {
  std::size_t fits = next_character(word, 0);
  while (fits < word.size()) {
    const std::size_t next = next_character(word, fits);
    if (text_width(word.substr(0, next), size_px, weight) > width) break;
    fits = next;
  }
  return fits;
}

std::vector<std::string> wrap_line(std::string_view text, int size_px, FontWeight weight, int width) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    std::string longer = lines.back().empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (text_width(longer, size_px, weight) <= width) {
      lines.back() = std::move(longer);
      continue;
    }
    if (!lines.back().empty()) lines.emplace_back();
    while (text_width(word, size_px, weight) > width) {
      const std::size_t fits = fitting_bytes(word, size_px, weight, width);
      lines.back() = word.substr(0, fits);
      word.remove_prefix(fits);
      if (word.empty()) break;
      lines.emplace_back();
    }
    if (!word.empty()) lines.back() = word;
  }
  return lines;
}

Picture swatch_picture(PixelState state, int size) {
  Image image(size, size);
  image.state.assign(image.pixel_count(), state);
  return to_picture(image, {});
}

}  // namespace

std::vector<std::string> wrap_text(std::string_view text, int size_px, FontWeight weight, int width) {
  std::vector<std::string> lines;
  while (true) {
    const std::size_t end = text.find('\n');
    const std::vector<std::string> wrapped = wrap_line(text.substr(0, end), size_px, weight, width);
    lines.insert(lines.end(), wrapped.begin(), wrapped.end());
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

std::vector<TextRow> rows_of(const std::string& line, int size_px, int width) {
  constexpr FontWeight kWeight = FontWeight::kRegular;
  const std::size_t tab = line.find('\t');
  std::vector<TextRow> rows;
  for (std::string& part : wrap_text(line.substr(0, tab), size_px, kWeight, width)) {
    rows.push_back({std::move(part), "", {}, false});
  }
  if (tab == std::string::npos) return rows;
  for (std::string& part : wrap_text(line.substr(tab + 1), size_px, kWeight, width)) {
    TextRow& last = rows.back();
    const int used = text_width(last.left, size_px, kWeight) + text_width(part, size_px, kWeight);
    if (last.right.empty() && used + size_px / 2 <= width) {
      last.right = std::move(part);
    } else {
      rows.push_back({"", std::move(part), {}, false});
    }
  }
  return rows;
}

std::vector<TextRow> rows_of(std::span<const std::string> lines, int size_px, int width) {
  std::vector<TextRow> rows;
  for (const std::string& line : lines) {
    const std::vector<TextRow> more = rows_of(line, size_px, width);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

std::vector<TextRow> rows_with_swatch(PixelState state, const std::string& text, int size_px, int width) {
  std::vector<TextRow> rows;
  for (std::string& part : wrap_text(text, size_px, FontWeight::kRegular, width - swatch_room(size_px))) {
    rows.push_back({std::move(part), "", {}, true});
  }
  rows.front().swatch = state;
  return rows;
}

int row_height(int size_px) {
  return static_cast<int>(std::lround(1.3 * size_px));
}

void draw_rows(Canvas& canvas, int x, int y, std::span<const TextRow> rows, int size_px, int width,
               FontWeight weight) {
  TextStyle style;
  style.size_px = size_px;
  style.weight = weight;
  style.align_y = AlignY::kTop;
  for (const TextRow& row : rows) {
    if (row.swatch) {
      canvas.paste(swatch_picture(*row.swatch, swatch_px(size_px)), x, y - size_px / 8);
      canvas.frame(x, y - size_px / 8, swatch_px(size_px), swatch_px(size_px), style.colour);
    }
    style.align_x = AlignX::kLeft;
    canvas.text(x + (row.indented ? swatch_room(size_px) : 0), y, row.left, style);
    style.align_x = AlignX::kRight;
    canvas.text(x + width, y, row.right, style);
    y += row_height(size_px);
  }
}

}  // namespace brdfit::render
