// Panels: where everything goes, then drawing it.
#include "render/panel.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include "render/axes.h"
#include "render/canvas.h"
#include "render/caption.h"
#include "render/text_layout.h"

namespace brdfit::render {
namespace {

constexpr Colour8 kPaper = {255, 255, 255};
constexpr Colour8 kInk = {32, 32, 32};

// What a panel shows: rows of pictures, one for each column, all of one size.
struct Contents {
  int size = 0;
  int rows = 0;
  std::string description;
  std::string unit;                             // of the differences
  std::vector<std::string> row_labels;          // one for each row, or none
  std::vector<Image> images;                    // row by row
  std::vector<std::vector<std::string>> notes;  // of each column, above its lines
  std::optional<SliceOptions> axes;

  const Image& image(int row, std::size_t column, std::size_t columns) const {
    return images[static_cast<std::size_t>(row) * columns + column];
  }
};

// Draws every picture; those that are drawn at the same time share the threads.
std::vector<Image> draw_all(std::size_t columns, std::size_t rows,
                            const std::function<Image(std::size_t row, std::size_t column)>& draw) {
  std::vector<Image> images(columns * rows);
  tbb::parallel_for(std::size_t{0}, images.size(),
                    [&](std::size_t k) { images[k] = draw(k / columns, k % columns); });
  return images;
}

std::string words_of(DifferenceKind kind, const std::string& reference) {
  switch (kind) {
    case DifferenceKind::kSigned:
      return "model − " + reference;
    case DifferenceKind::kAbsolute:
      return "|model − " + reference + "|";
    case DifferenceKind::kLogRatio:
      break;
  }
  return "ln of (model + 0.001) / (" + reference + " + 0.001)";
}

std::string words_of_channel(DifferenceKind kind, Channel channel) {
  if (channel == Channel::kRgb) return kind == DifferenceKind::kLogRatio ? "mean of RGB" : "luminance";
  return channel == Channel::kLuminance ? "luminance" : std::string(name_of(channel)) + " channel";
}

std::string percent(double share) {
  return share < 0.001 ? "less than 0.1%" : fmt::format("{:.1f}%", 100.0 * share);
}

class Panel {
 public:
  Panel(std::span<const Column> columns, const Contents& contents, const PanelOptions& options)
      : columns_(columns),
        contents_(contents),
        options_(options),
        size_(contents.size),
        text_px_(figure_text_px(size_)),
        gap_(std::max(text_px_, size_ / 16)),
        column_width_(std::max(size_, 11 * text_px_)) {
    if (options.show_difference && columns.size() > 1) make_differences();
    make_room();
    make_text();
  }

  Picture draw() {
    place();
    Canvas canvas(width_, height_, kPaper);
    draw_rows(canvas, text_px_, text_px_, title_, title_px(), text_room(), FontWeight::kBold);
    draw_rows(canvas, text_px_, description_y_, description_, text_px_, text_room());
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      draw_rows(canvas, column_x(c), column_titles_y_, column_titles_[c], text_px_, column_width_,
                FontWeight::kBold);
      draw_rows(canvas, column_x(c), text_y_, text_[c], text_px_, column_width_);
    }
    for (int row = 0; row < contents_.rows; ++row) draw_row(canvas, row);
    if (!differences_.empty()) {
      draw_rows(canvas, column_x(0), explanation_y_, explanation_, text_px_, explanation_room());
      draw_colour_bar(canvas);
    }
    return canvas.picture();
  }

 private:
  int title_px() const { return 5 * text_px_ / 4; }
  int text_room() const { return width_ - 2 * text_px_; }
  int explanation_room() const { return width_ - text_px_ - column_x(0); }
  int column_x(std::size_t column) const { return left_ + static_cast<int>(column) * (column_width_ + gap_); }
  int picture_y(int row) const { return pictures_y_ + row * row_pitch_; }
  int difference_y(int row) const { return differences_y_ + row * (size_ + gap_); }
  AxisDetail detail_of(std::size_t column) const {
    return column == 0 ? AxisDetail::kFull : AxisDetail::kTicks;
  }

  void make_differences() {
    for (int row = 0; row < contents_.rows; ++row) {
      for (std::size_t c = 1; c < columns_.size(); ++c) {
        differences_.push_back(difference_of(contents_.image(row, c, columns_.size()),
                                             contents_.image(row, 0, columns_.size()), options_.difference,
                                             options_.view));
      }
    }
    range_ = options_.range > 0.0 ? options_.range : difference_range(differences_);
  }

  const Difference& difference(int row, std::size_t column) const {
    return differences_[static_cast<std::size_t>(row) * (columns_.size() - 1) + column - 1];
  }

  void make_room() {
    const AxisRoom axes = contents_.axes ? axis_room(AxisDetail::kFull, text_px_) : AxisRoom{1, 1, 1, 1};
    const int label_room = contents_.row_labels.empty() ? 0 : 3 * text_px_ / 2;
    left_ = text_px_ + axes.left + label_room;
    below_picture_ = axes.bottom;
    row_pitch_ = size_ + (contents_.axes ? axes.bottom : 0) + gap_;
    const int columns_width = static_cast<int>(columns_.size()) * (column_width_ + gap_) - gap_;
    width_ = left_ + columns_width + std::max(text_px_, axes.right);
  }

  void make_text() {
    if (!options_.title.empty()) {
      for (std::string& line : wrap_text(options_.title, title_px(), FontWeight::kBold, text_room())) {
        title_.push_back({std::move(line), "", {}, false});
      }
    }
    description_ = rows_of(contents_.description, text_px_, text_room());
    if (!differences_.empty()) explanation_ = rows_of(explanation(), text_px_, explanation_room());
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      std::vector<TextRow> title;
      for (std::string& line : wrap_text(columns_[c].title, text_px_, FontWeight::kBold, column_width_)) {
        title.push_back({std::move(line), "", {}, false});
      }
      column_titles_.push_back(std::move(title));
      text_.push_back(text_below(c));
    }
  }

  // Pixels without a value, what there is to know of the pictures, and the column's own lines.
  std::vector<TextRow> text_below(std::size_t column) const {
    std::array<std::size_t, kPixelStateCount> counts{};
    for (int row = 0; row < contents_.rows; ++row) {
      const auto more = contents_.image(row, column, columns_.size()).counts();
      for (std::size_t s = 0; s < counts.size(); ++s) counts[s] += more[s];
    }
    std::vector<TextRow> rows;
    const auto append = [&rows](const std::vector<TextRow>& more) {
      rows.insert(rows.end(), more.begin(), more.end());
    };
    for (const MissingNote& note : missing_notes(counts)) {
      // The horizon is the same for all columns.
      if (note.state == PixelState::kBelowHorizon && column > 0) continue;
      append(rows_with_swatch(note.state, note.text, text_px_, column_width_));
    }
    if (!contents_.notes.empty()) append(rows_of(contents_.notes[column], text_px_, column_width_));
    append(rows_of(columns_[column].lines, text_px_, column_width_));
    return rows;
  }

  static std::size_t most_rows(const std::vector<std::vector<TextRow>>& texts) {
    std::size_t most = 0;
    for (const std::vector<TextRow>& text : texts) most = std::max(most, text.size());
    return most;
  }
  int height_of(std::size_t rows, int text_px) const { return static_cast<int>(rows) * row_height(text_px); }

  void place() {
    description_y_ = text_px_ + height_of(title_.size(), title_px());
    column_titles_y_ = description_y_ + height_of(description_.size(), text_px_) + text_px_ / 2;
    pictures_y_ = column_titles_y_ + height_of(most_rows(column_titles_), text_px_) + text_px_ / 4;
    explanation_y_ = picture_y(contents_.rows);
    differences_y_ = explanation_y_;
    if (!explanation_.empty()) differences_y_ += height_of(explanation_.size(), text_px_) + text_px_ / 2;
    text_y_ = differences_.empty() ? differences_y_ : difference_y(contents_.rows);
    height_ = text_y_ + height_of(most_rows(text_), text_px_) + text_px_ / 2;
  }

  void draw_label(Canvas& canvas, int row, int y) const {
    if (contents_.row_labels.empty()) return;
    const std::string& label = contents_.row_labels[static_cast<std::size_t>(row)];
    TextStyle style{.size_px = text_px_,
                    .colour = kInk,
                    .align_x = AlignX::kCentre,
                    .align_y = AlignY::kBottom,
                    .upwards = true};
    while (style.size_px > 8 && text_width(label, style.size_px, style.weight) > size_ + gap_ / 2) {
      --style.size_px;
    }
    canvas.text(left_ - text_px_ / 2, y + size_ / 2, label, style);
  }

  void draw_framed(Canvas& canvas, const Picture& picture, int x, int y) const {
    canvas.frame(x - 1, y - 1, size_ + 2, size_ + 2, kInk);
    canvas.paste(picture, x, y);
  }

  void draw_row(Canvas& canvas, int row) const {
    const int y = picture_y(row);
    draw_label(canvas, row, y);
    if (!differences_.empty()) draw_label(canvas, row, difference_y(row));
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const int x = column_x(c);
      draw_framed(canvas, to_picture(contents_.image(row, c, columns_.size()), options_.view), x, y);
      if (contents_.axes) draw_axes(canvas, x, y, *contents_.axes, detail_of(c), text_px_);
      if (contents_.axes && options_.regions && c == 0) draw_region_names(canvas, x, y, size_, text_px_);
      if (differences_.empty() || c == 0) continue;
      draw_framed(canvas, difference_picture(difference(row, c), options_.difference, range_), x,
                  difference_y(row));
      if (contents_.axes) {
        draw_axes(canvas, x, difference_y(row), *contents_.axes, AxisDetail::kTicks, text_px_);
      }
    }
  }

  // The colour bar, in the reference's column.
  void draw_colour_bar(Canvas& canvas) const {
    const Picture bar = colour_bar(options_.difference, range_, "", size_, text_px_);
    canvas.paste(bar, column_x(0) + column_width_ - bar.width, differences_y_);
  }

  // What the differences are, in one line over all columns.
  std::string explanation() const {
    std::string text = words_of(options_.difference, columns_[0].title) + ", " +
                       words_of_channel(options_.difference, options_.view.channel);
    if (options_.difference != DifferenceKind::kLogRatio) text += contents_.unit;
    const double beyond = share_beyond(differences_, range_);
    if (beyond > 0.0) text += fmt::format("; {} of the pixels beyond the bar", percent(beyond));
    return text;
  }

  std::span<const Column> columns_;
  const Contents& contents_;
  const PanelOptions& options_;
  int size_;
  int text_px_;
  int gap_;
  int column_width_;
  std::vector<Difference> differences_;
  double range_ = 0.0;
  int left_ = 0;
  int below_picture_ = 0;
  int row_pitch_ = 0;
  int width_ = 0;
  int height_ = 0;
  int description_y_ = 0;
  int column_titles_y_ = 0;
  int pictures_y_ = 0;
  int explanation_y_ = 0;
  int differences_y_ = 0;
  int text_y_ = 0;
  std::vector<TextRow> title_;
  std::vector<TextRow> description_;
  std::vector<TextRow> explanation_;
  std::vector<std::vector<TextRow>> column_titles_;
  std::vector<std::vector<TextRow>> text_;
};

void check(std::span<const Column> columns, const PanelOptions& options) {
  if (columns.empty()) throw std::invalid_argument("a panel has at least one column");
  if (!std::isfinite(options.range) || options.range < 0.0) {
    throw std::invalid_argument("a panel's range is a positive number, or 0 to choose one");
  }
}

// Differences are drawn as exposed.
std::string exposed(const std::string& unit, const ViewOptions& view) {
  return view.exposure_stops == 0.0 ? unit : unit + " × 2^" + pretty_number(view.exposure_stops, 4);
}

std::string error_note(const EnvironmentImage& drawn) {
  // Rounded up: a stated bound must hold.
  const double error = std::max(0.01, std::ceil(100.0 * drawn.error_steps) / 100.0);
  const std::string text = fmt::format("{:.2f} of an 8-bit step", error);
  return drawn.converged ? "quadrature error < " + text : "quadrature not converged: error about " + text;
}

}  // namespace

Picture slice_panel(std::span<const Column> columns, const SliceOptions& slice, const PanelOptions& options) {
  check(columns, options);
  SliceOptions shared = slice;
  if (const MeasuredTable* table = columns[0].subject.table()) shared.grid = table->grid();
  Contents contents;
  contents.size = slice.size;
  contents.rows = 1;
  contents.description = describe_slice(shared) + ", " + describe_view(options.view);
  contents.unit = " of " + exposed(describe_quantity(slice.quantity), options.view);
  contents.axes = shared;
  contents.images = draw_all(columns.size(), 1, [&](std::size_t, std::size_t column) {
    return draw_slice(columns[column].subject, shared);
  });
  return Panel(columns, contents, options).draw();
}

Picture sphere_panel(std::span<const Column> columns, Shape shape, std::span<const double> light_angles_deg,
                     int size, const PanelOptions& options) {
  check(columns, options);
  if (light_angles_deg.empty()) throw std::invalid_argument("a panel of spheres has at least one light");
  Contents contents;
  contents.size = size;
  contents.rows = static_cast<int>(light_angles_deg.size());
  contents.description =
      std::string(shape == Shape::kSphere ? "Sphere" : "Patch") + " under a directional light, " +
      "radiance (1: a white Lambert surface that faces the light), " + describe_view(options.view);
  contents.unit = " of " + exposed("radiance", options.view);
  for (const double angle : light_angles_deg) {
    contents.row_labels.push_back("light at " + pretty_number(angle, 6) + "°");
  }
  contents.images =
      draw_all(columns.size(), light_angles_deg.size(), [&](std::size_t row, std::size_t column) {
        return draw_lit(columns[column].subject, shape, light_angles_deg[row], size);
      });
  return Panel(columns, contents, options).draw();
}

Picture environment_panel(std::span<const Column> columns, int size, const PanelOptions& options) {
  check(columns, options);
  Contents contents;
  contents.size = size;
  contents.rows = 2;
  contents.description =
      "Sphere under an environment, uniform (radiance 1) and gradient (1 above, 0 below), " +
      describe_view(options.view);
  contents.unit = " of " + exposed("radiance", options.view);
  contents.row_labels = {"uniform", "gradient"};
  std::vector<EnvironmentImage> drawn(2 * columns.size());
  contents.images = draw_all(columns.size(), 2, [&](std::size_t row, std::size_t column) {
    EnvironmentImage& result = drawn[row * columns.size() + column];
    result = draw_environment(columns[column].subject,
                              row == 0 ? Environment::kUniform : Environment::kGradient, size);
    return std::move(result.image);
  });
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const EnvironmentImage& uniform = drawn[c];
    const EnvironmentImage& gradient = drawn[columns.size() + c];
    const bool uniform_is_worse = uniform.converged == gradient.converged
                                      ? uniform.error_steps > gradient.error_steps
                                      : !uniform.converged;
    contents.notes.push_back({error_note(uniform_is_worse ? uniform : gradient)});
    const double unmeasured = std::max(uniform.unmeasured_fraction, gradient.unmeasured_fraction);
    if (unmeasured > 0.0) {
      contents.notes.back().push_back(
          fmt::format("up to {} of the hemisphere not measured, counted as 0", percent(unmeasured)));
    }
  }
  return Panel(columns, contents, options).draw();
}

}  // namespace brdfit::render
