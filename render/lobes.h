// Plots of lobes: measured points with model curves, as SVG.
#ifndef BRDFIT_RENDER_LOBES_H_
#define BRDFIT_RENDER_LOBES_H_

#include <string>
#include <vector>

#include "measured/table.h"
#include "render/subject.h"
#include "render/view.h"

namespace brdfit::render {

struct Curve {
  std::string label;
  Subject subject;
};

struct LobeOptions {
  std::string title;
  std::vector<double> theta_d_deg = {0.0, 30.0, 60.0, 75.0};  // one plot each, in [0, 90)
  double phi_d_deg = 90.0;
  Channel channel = Channel::kLuminance;  // kRgb is not possible
  int width_px = 960;                     // at least 320; two plots side by side from 640 on
};

// f in sr^-1 over theta_h (square-root axis, so that peaks are seen) at fixed theta_d, on a logarithmic
// scale; the reference's stored cells as points, models as lines. One plot per theta_d, on a common scale.
//
// With a reference each plot is at the stored theta_d and phi_d nearest to those asked for, and says so. A
// model's f is the mean of f(wi, wo) and f(wo, wi), which a table does not tell apart. Cells of 0 or below
// the scale (ten decades at most) are marked at its lower end and counted. reference may be null. Throws
// std::invalid_argument for options outside their ranges.
std::string lobe_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                       const LobeOptions& options);

struct PolarOptions {
  std::string title;
  std::vector<double> theta_i_deg = {0.0, 30.0, 60.0, 80.0};  // one plot each, in [0, 90)
  Channel channel = Channel::kLuminance;                      // kRgb is not possible
  int width_px = 960;                                         // as in LobeOptions
};

// Polar plots of f cos_o in the plane of incidence over the view's angle from -90 to 90 deg: the light comes
// from the left at theta_i, the mirror direction is on the right. The radius is the fourth root, so that
// diffuse and specular parts are both seen; the scale is common to a plot's curves. The reference is
// interpolated and shown as points. reference may be null. Throws as lobe_plots.
std::string polar_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                        const PolarOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_LOBES_H_
