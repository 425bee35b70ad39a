// One picture on a page of its own.
#include "render/figure.h"

#include <algorithm>
#include <span>
#include <vector>

#include "render/axes.h"
#include "render/canvas.h"
#include "render/caption.h"
#include "render/text_layout.h"

namespace brdfit::render {
namespace {

constexpr Colour8 kPaper = {255, 255, 255};
constexpr Colour8 kInk = {32, 32, 32};

// A picture with text above and below it. Text is as wide as the page, which is never so narrow that words
// would have to be broken.
class Page {
 public:
  Page(const Image& image, const ViewOptions& view, const AxisRoom& room)
      : text_px_(figure_text_px(std::max(image.width, image.height))),
        margin_(text_px_),
        room_(room),
        image_(image),
        view_(view) {
    text_width_ = std::max(room.left + image.width + room.right, 14 * text_px_);
  }

  void set_title(const std::string& title) {
    if (title.empty()) return;
    for (std::string& line : wrap_text(title, title_px(), FontWeight::kBold, text_width_)) {
      title_.push_back({std::move(line), "", {}, false});
    }
  }
  void add_below(const std::string& text) {
    if (!text.empty()) append(rows_of(text, text_px_, text_width_));
  }
  void add_missing_notes() {
    for (const MissingNote& note : missing_notes(image_.counts())) {
      append(rows_with_swatch(note.state, note.text, text_px_, text_width_));
    }
  }

  int picture_x() const { return margin_ + room_.left; }
  int picture_y() const {
    const int title_height = static_cast<int>(title_.size()) * row_height(title_px());
    return margin_ + (title_.empty() ? 0 : title_height + text_px_ / 2) + room_.top;
  }

  Canvas draw() const {
    const int below_y = picture_y() + image_.height + room_.bottom + (below_.empty() ? 0 : text_px_ / 2);
    const int height = below_y + static_cast<int>(below_.size()) * row_height(text_px_) + margin_;
    Canvas canvas(text_width_ + 2 * margin_, height, kPaper);
    draw_rows(canvas, margin_, margin_, title_, title_px(), text_width_, FontWeight::kBold);
    canvas.frame(picture_x() - 1, picture_y() - 1, image_.width + 2, image_.height + 2, kInk);
    canvas.paste(to_picture(image_, view_), picture_x(), picture_y());
    draw_rows(canvas, margin_, below_y, below_, text_px_, text_width_);
    return canvas;
  }

 private:
  int title_px() const { return 5 * text_px_ / 4; }
  void append(std::vector<TextRow> rows) { below_.insert(below_.end(), rows.begin(), rows.end()); }

  int text_px_;
  int margin_;
  int text_width_ = 0;
  AxisRoom room_;
  const Image& image_;
  const ViewOptions& view_;
  std::vector<TextRow> title_;
  std::vector<TextRow> below_;
};

}  // namespace

int figure_text_px(int picture_px) {
  return std::max(16, picture_px / 26);
}

std::string describe_missing(const Image& image) {
  std::string text;
  for (const MissingNote& note : missing_notes(image.counts())) {
    text += (text.empty() ? "" : "; ") + note.text;
  }
  return text;
}

Picture slice_figure(const Image& slice, const SliceOptions& slice_options, const FigureOptions& options) {
  const int text_px = figure_text_px(slice.width);
  Page page(slice, options.view, options.axes ? axis_room(AxisDetail::kFull, text_px) : AxisRoom{1, 1, 1, 1});
  page.set_title(options.title);
  page.add_below(describe_slice(slice_options) + ", " + describe_view(options.view));
  page.add_missing_notes();
  Canvas canvas = page.draw();
  SliceOptions drawn = slice_options;
  drawn.size = slice.width;
  if (options.axes) {
    draw_axes(canvas, page.picture_x(), page.picture_y(), drawn, AxisDetail::kFull, text_px);
  }
  if (options.regions) {
    draw_region_names(canvas, page.picture_x(), page.picture_y(), slice.width, text_px);
  }
  return canvas.picture();
}

Picture plain_figure(const Image& image, const std::string& caption, const FigureOptions& options) {
  Page page(image, options.view, AxisRoom{1, 1, 1, 1});
  page.set_title(options.title);
  page.add_below(caption);
  page.add_missing_notes();
  return page.draw().picture();
}

}  // namespace brdfit::render
