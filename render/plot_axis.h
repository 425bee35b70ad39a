// Axes whose ends and ticks follow the data.
#ifndef BRDFIT_RENDER_PLOT_AXIS_H_
#define BRDFIT_RENDER_PLOT_AXIS_H_

#include <string>
#include <vector>

namespace brdfit::render {

// A linear scale from one tick to another that holds both ends. Ticks are 1, 2 or 5 times a power of ten
// apart, about four of them.
struct LinearScale {
  double lower;
  double upper;
  double step;

  static LinearScale around(double smallest, double largest);
  int ticks() const;
  double tick(int k) const { return lower + k * step; }
};

struct AxisTick {
  double value;
  std::string label;
};

// Linear, or logarithmic where values are positive and the largest is many times the smallest.
class PlotAxis {
 public:
  // smallest <= largest, finite; values of both are well inside. with_zero: linear, and 0 is on it.
  PlotAxis(double smallest, double largest, bool with_zero = false);

  bool is_logarithmic() const { return is_logarithmic_; }
  // 0 at the lower end, 1 at the upper one.
  double place(double value) const;
  const std::vector<AxisTick>& ticks() const { return ticks_; }

 private:
  void make_linear(double smallest, double largest);
  void make_logarithmic(double smallest, double largest);

  bool is_logarithmic_ = false;
  double lower_ = 0.0;  // of a logarithmic axis, decimal logarithms
  double upper_ = 1.0;
  std::vector<AxisTick> ticks_;
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_PLOT_AXIS_H_
