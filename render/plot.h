// What all plots share: line styles, numbers as labels, the title with its legend, and logarithmic scales.
#ifndef BRDFIT_RENDER_PLOT_H_
#define BRDFIT_RENDER_PLOT_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/vec3.h"
#include "render/svg.h"
#include "render/view.h"

namespace brdfit::render {

inline constexpr std::string_view kPlotFont =
    R"(font-family="DejaVu Sans, Arial, sans-serif" font-size="15" fill="#222")";
inline constexpr std::string_view kGridStyle = R"(stroke="#ddd" stroke-width="1")";
inline constexpr std::string_view kFrameStyle = R"(stroke="#444" stroke-width="1" fill="none")";

// Attributes of the line of the k-th model: colours that differ for the colour-blind too (Okabe and Ito 2008)
// and dashes that differ in grey. class="model-K".
std::string model_line_style(std::size_t model);

// Attributes of a group of measured points.
inline constexpr std::string_view kMeasuredStyle = R"(class="measured" fill="#222")";

// A curve's points without those that lie on it anyway, to a twentieth of a pixel: files stay small.
std::vector<SvgPoint> thinned(const std::vector<SvgPoint>& points);

// One number of a colour. Luminance is that of Rec.709. Throws std::invalid_argument for kRgb.
double channel_value(const Rgb& value, Channel channel);

// "10", superscripts for other powers than 0 and 1: "10⁻³".
std::string power_label(int exponent);

// A short decimal, or a mantissa with a power: "0.25", "3×10⁻⁵".
std::string number_label(double value);

// Whole decades from 10^lower to 10^upper.
struct LogScale {
  int lower = -1;
  int upper = 0;

  // The smallest scale that holds both; at most kMostDecades, the upper ones. smallest, largest > 0.
  static LogScale around(double smallest, double largest);
  static constexpr int kMostDecades = 10;

  // 0 at the lower end, 1 at the upper one; far below 0 for values that are not positive.
  double place(double value) const;
};

// Title, subtitle and legend above the plots.
struct PlotHead {
  std::string title;     // may be empty
  std::string subtitle;  // as for Svg::symbols
  bool has_reference = false;
  std::vector<std::string> models;

  // The height that it takes with so much width.
  double height(double width) const;
  void draw(Svg& svg, double width) const;

 private:
  struct Entry {
    SvgPoint at;
    std::string label;
    int model;  // -1: the reference
  };
  double text_height() const;
  std::vector<Entry> entries(double width) const;
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_PLOT_H_
