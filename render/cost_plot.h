// Scatter plots of what choices cost: error against time, gain against cost.
#ifndef BRDFIT_RENDER_COST_PLOT_H_
#define BRDFIT_RENDER_COST_PLOT_H_

#include <cstddef>
#include <string>
#include <vector>

namespace brdfit::render {

// A figure with what it spreads over, low <= middle <= high; all the same where it was not repeated.
struct PlotSpread {
  double middle = 0.0;
  double low = 0.0;
  double high = 0.0;

  static PlotSpread of(double value) { return {value, value, value}; }
};

struct CostPlotPoint {
  std::string name;        // what is said of it on hover and to those who cannot see it
  std::size_t series = 0;  // an index of CostPlot::series: its colour and shape
  PlotSpread cost;         // to the right
  PlotSpread error;        // upwards
  bool is_on_front = false;
  std::string key = {};  // data-point: the same for a point that stands in several plots
};

struct CostPlot {
  std::string title;
  std::string cost_name;   // of the axis to the right, with its unit
  std::string error_name;  // of the axis upwards
  std::vector<std::string> series;
  std::vector<CostPlotPoint> points;
  bool with_zero = false;  // linear axes that show 0, for differences
};

// Whether a plot can show a point: its figures are finite.
bool is_drawable(const CostPlotPoint& point);

// Indices of the drawn points on the front, from the lowest cost on: the numbers in the plot, from 1.
std::vector<std::size_t> front_of(const CostPlot& plot);

// SVG text without a header. Axes are logarithmic where their range asks for it. Bars show spreads, a stepped
// line the front. Each point is a group of class "point" with a tooltip; the first can be reached by
// keyboard, the others from it by a script. A style sheet may recolour the classes paper, grid, frame, front,
// number and series-N, N from 0 to 6. Points that are not drawable are left out; empty where that leaves
// none. Throws std::invalid_argument where a series is not there.
std::string cost_plot(const CostPlot& plot);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_COST_PLOT_H_
