// The plot of a choice of effects: the held-out error of every rung, and below it what an evaluation costs.
#ifndef BRDFIT_RENDER_LADDER_PLOT_H_
#define BRDFIT_RENDER_LADDER_PLOT_H_

#include <optional>
#include <string>
#include <vector>

namespace brdfit::render {

struct LadderPoint {
  double held_out_pct = 0.0;
  std::optional<double> standard_error_pct = {};  // of the difference to the point before
  std::optional<double> evaluation_ns = {};
  bool is_removal = false;  // drawn hollow
};

// SVG text without a header. points: from rung 0 on. all_pct: with all effects on, drawn as a level. The cost
// is left out where no point has one. Empty where there is no point, or where a number is not finite.
std::string ladder_plot(const std::string& title, const std::vector<LadderPoint>& points,
                        std::optional<double> all_pct);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_LADDER_PLOT_H_
