// Axes whose ends and ticks follow the data.
#include "render/plot_axis.h"

#include <algorithm>
#include <cmath>

#include "render/plot.h"

namespace brdfit::render {
namespace {

// From here on equal ratios say more than equal distances.
constexpr double kLogarithmicRatio = 8.0;
// Left free at both ends, as a share of what the data take.
constexpr double kMargin = 0.06;
// Ticks of a plot that is large are nearer to each other by this.
constexpr double kFinerTicks = 0.6;
// More decades have room for their powers of ten alone.
constexpr double kMostFineDecades = 2.6;
constexpr double kMostDecades = 7.0;

double tick_step(double span) {
  const double rough = span / 4.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

LinearScale LinearScale::around(double smallest, double largest) {
  const double span = largest > smallest ? largest - smallest : std::max(0.1 * std::abs(largest), 1e-3);
  const double step = tick_step(span);
  const double lower = step * std::floor(smallest / step + 1e-9);
  double upper = step * std::ceil(largest / step - 1e-9);
  if (!(upper > lower)) upper = lower + step;
  return {lower, upper, step};
}

int LinearScale::ticks() const {
  return static_cast<int>(std::lround((upper - lower) / step));
}

PlotAxis::PlotAxis(double smallest, double largest, bool with_zero) {
  is_logarithmic_ = !with_zero && smallest > 0.0 && largest > kLogarithmicRatio * smallest;
  if (is_logarithmic_) {
    make_logarithmic(smallest, largest);
  } else {
    make_linear(with_zero ? std::min(smallest, 0.0) : smallest, with_zero ? std::max(largest, 0.0) : largest);
  }
}

double PlotAxis::place(double value) const {
  return ((is_logarithmic_ ? std::log10(value) : value) - lower_) / (upper_ - lower_);
}

void PlotAxis::make_linear(double smallest, double largest) {
  // Where all values are the same they are in the middle.
  const double least = std::max(0.1 * std::abs(largest), 1e-12);
  const double margin = largest - smallest > 1e-9 * least ? kMargin * (largest - smallest) : least;
  lower_ = smallest >= 0.0 && smallest - margin < 0.0 ? 0.0 : smallest - margin;
  upper_ = largest + margin;
  const double step = tick_step(kFinerTicks * (upper_ - lower_));
  for (double k = std::ceil(lower_ / step - 1e-9); k * step <= upper_ + 1e-9 * step; k += 1.0) {
    const double value = k == 0.0 ? 0.0 : k * step;
    ticks_.push_back({value, number_label(value)});
  }
}

void PlotAxis::make_logarithmic(double smallest, double largest) {
  const double from = std::log10(smallest);
  const double to = std::log10(largest);
  lower_ = from - kMargin * (to - from);
  upper_ = to + kMargin * (to - from);
  const double decades = upper_ - lower_;
  const int stride = decades > kMostDecades ? static_cast<int>(std::ceil(decades / kMostDecades)) : 1;
  for (int decade = static_cast<int>(std::floor(lower_)); decade <= static_cast<int>(std::ceil(upper_));
       ++decade) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, decade);
      const double at = std::log10(value);
      const bool is_wanted = factor == 1.0 ? decade % stride == 0 : decades <= kMostFineDecades;
      if (is_wanted && at >= lower_ && at <= upper_) ticks_.push_back({value, number_label(value)});
    }
  }
}

}  // namespace brdfit::render
