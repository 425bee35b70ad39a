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
  std::vector<double> theta_d_deg = {0.0, 30.0, 60.0, 75.0};  // one plot each
  double phi_d_deg = 90.0;
  Channel channel = Channel::kLuminance;  // kRgb is not possible
  int width_px = 960;
};

// f in sr^-1 over theta_h (square-root axis, so that peaks are seen) at fixed theta_d, on a logarithmic
// scale; the reference's stored cells as points, models as lines. One plot per theta_d, on a common scale.
std::string lobe_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                       const LobeOptions& options);

struct PolarOptions {
  std::string title;
  std::vector<double> theta_i_deg = {0.0, 30.0, 60.0, 80.0};
  Channel channel = Channel::kLuminance;
  int width_px = 960;
};

// Polar plots of f cos_o in the plane of incidence over the view's angle from -90 to 90 deg: the light comes
// from the left at theta_i, the mirror direction is on the right. The radius is the fourth root, so that
// diffuse and specular parts are both seen; the scale is common to a plot's curves.
std::string polar_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                        const PolarOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_LOBES_H_
