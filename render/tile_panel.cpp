// Tiles: where each goes, then drawing them.
#include "render/tile_panel.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "render/canvas.h"
#include "render/figure.h"
#include "render/text_layout.h"

namespace brdfit::render {
namespace {

constexpr Colour8 kPaper = {255, 255, 255};
constexpr Colour8 kInk = {32, 32, 32};

std::vector<TextRow> bold_rows(const std::string& text, int size_px, int width) {
  std::vector<TextRow> rows;
  for (std::string& line : wrap_text(text, size_px, FontWeight::kBold, width)) {
    rows.push_back({std::move(line), "", {}, false});
  }
  return rows;
}

// The first tile, which gives all their size.
const Picture& first_of(const TilePanel& panel) {
  for (const std::vector<Tile>& row : panel.rows) {
    if (!row.empty()) return row.front().picture;
  }
  throw std::invalid_argument("a panel has at least one tile");
}

class Layout {
 public:
  explicit Layout(const TilePanel& panel)
      : panel_(panel),
        tile_width_(first_of(panel).width),
        tile_height_(first_of(panel).height),
        text_px_(figure_text_px(std::max(tile_width_, tile_height_))),
        gap_(text_px_),
        column_width_(std::max(tile_width_, 11 * text_px_)),
        bar_(colour_bar(panel.kind, panel.range, panel.unit, tile_height_, text_px_)) {
    std::size_t columns = 0;
    for (const std::vector<Tile>& row : panel.rows) columns = std::max(columns, row.size());
    bar_x_ = text_px_ + static_cast<int>(columns) * (column_width_ + gap_);
    width_ = bar_x_ + bar_.width + text_px_;
    if (!panel.title.empty()) title_ = bold_rows(panel.title, title_px(), text_room());
    description_ = rows_of(panel.description, text_px_, text_room());
    place();
  }

  DrawnTiles draw() const {
    Canvas canvas(width_, height_, kPaper);
    draw_rows(canvas, text_px_, text_px_, title_, title_px(), text_room(), FontWeight::kBold);
    draw_rows(canvas, text_px_, description_y_, description_, text_px_, text_room());
    for (std::size_t r = 0; r < panel_.rows.size(); ++r) draw_row(canvas, r);
    return {canvas.picture(), places_};
  }

 private:
  int title_px() const { return 5 * text_px_ / 4; }
  int text_room() const { return width_ - 2 * text_px_; }
  int height_of(std::size_t rows, int text_px) const { return static_cast<int>(rows) * row_height(text_px); }

  std::vector<TextRow> title_of(const Tile& tile) const {
    if (tile.title.empty()) return {};
    return bold_rows(tile.title, text_px_, column_width_);
  }
  std::vector<TextRow> lines_of(const Tile& tile) const {
    return rows_of(tile.lines, text_px_, column_width_);
  }

  void place() {
    description_y_ = text_px_ + height_of(title_.size(), title_px());
    int y = description_y_ + height_of(description_.size(), text_px_) + text_px_ / 2;
    for (const std::vector<Tile>& row : panel_.rows) {
      std::size_t above = 0;
      std::size_t below = 0;
      for (const Tile& tile : row) {
        if (tile.picture.width != tile_width_ || tile.picture.height != tile_height_) {
          throw std::invalid_argument("the tiles of a panel differ in size");
        }
        above = std::max(above, title_of(tile).size());
        below = std::max(below, lines_of(tile).size());
      }
      titles_y_.push_back(y);
      y += height_of(above, text_px_) + text_px_ / 4;
      std::vector<TilePlace>& places = places_.emplace_back();
      for (std::size_t c = 0; c < row.size(); ++c) {
        places.push_back(
            {text_px_ + static_cast<int>(c) * (column_width_ + gap_), y, tile_width_, tile_height_});
      }
      y += tile_height_ + text_px_ / 4 + height_of(below, text_px_) + text_px_ / 2;
    }
    height_ = y;
  }

  void draw_row(Canvas& canvas, std::size_t r) const {
    const std::vector<Tile>& row = panel_.rows[r];
    for (std::size_t c = 0; c < row.size(); ++c) {
      const TilePlace& at = places_[r][c];
      draw_rows(canvas, at.x, titles_y_[r], title_of(row[c]), text_px_, column_width_, FontWeight::kBold);
      canvas.frame(at.x - 1, at.y - 1, at.width + 2, at.height + 2, kInk);
      canvas.paste(row[c].picture, at.x, at.y);
      draw_rows(canvas, at.x, at.y + at.height + text_px_ / 4, lines_of(row[c]), text_px_, column_width_);
    }
    if (!row.empty()) canvas.paste(bar_, bar_x_, places_[r].front().y);
  }

  const TilePanel& panel_;
  int tile_width_;
  int tile_height_;
  int text_px_;
  int gap_;
  int column_width_;
  Picture bar_;
  int bar_x_ = 0;
  int width_ = 0;
  int height_ = 0;
  int description_y_ = 0;
  std::vector<int> titles_y_;
  std::vector<std::vector<TilePlace>> places_;
  std::vector<TextRow> title_;
  std::vector<TextRow> description_;
};

}  // namespace

DrawnTiles draw_tile_panel(const TilePanel& panel) {
  return Layout(panel).draw();
}

Picture enlarged(const Picture& picture, int factor) {
  if (factor < 1) throw std::invalid_argument("pictures are enlarged by 1 or more");
  Picture out(picture.width * factor, picture.height * factor);
  const auto width = static_cast<std::size_t>(out.width);
  const auto by = static_cast<std::size_t>(factor);
  const auto from_width = static_cast<std::size_t>(picture.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(out.height); ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        out.rgb[3 * (y * width + x) + c] = picture.rgb[3 * ((y / by) * from_width + x / by) + c];
      }
    }
  }
  return out;
}

}  // namespace brdfit::render
