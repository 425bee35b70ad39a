// Error measures of a material, or of another table, against a measured table.
#ifndef BRDFIT_FIT_METRICS_H_
#define BRDFIT_FIT_METRICS_H_

#include <cstddef>
#include <functional>

#include "brdf/material.h"
#include "measured/table.h"

namespace brdfit::fit {

// With f the model, r the reference, over channels and cells of uniform weight. f of a cell is the mean of
// f(wi, wo) and f(wo, wi), as an exported table stores it; cos_i is that of the stored order.
struct Measures {
  double slice_pct = 0.0;  // 100 RMS of clip(f, 0, 1) - clip(r, 0, 1), below 80 deg in theta_h and theta_d
  double log_ratio_pct = 0.0;  // 100 mean |ln((f cos_i + 1e-3) / (r cos_i + 1e-3))|
  double relative = 0.0;       // mean |f - r| / (r + 1e-3)
  double cube_root = 0.0;      // RMS of cbrt(f cos_i) - cbrt(r cos_i)
  double srgb = 0.0;           // RMS of sRGB(clip(pi f cos_i)) - sRGB(clip(pi r cos_i))
  double cosine_l2 = 0.0;      // RMS of f cos_i - r cos_i
  std::size_t cells = 0;       // that were compared
};

struct Evaluation {
  Measures slice;  // the slice at phi_d = 90 deg, 90 x 90 pixels
  Measures table;  // every valid cell above the horizon once
  // 100 mean |ln((f(wi, wo) cos_i + 1e-3) / (f(wo, wi) cos_i + 1e-3))| over the table: 0 for a reciprocal
  // material.
  double reciprocity_gap_pct = 0.0;
};

// Cells with wi or wo further than max_theta_deg from the normal are left out of all measures.
Evaluation evaluate(const Material& material, const MeasuredTable& reference, double max_theta_deg = 90.0);

// The same for a table on the same grid; cells that either lacks are left out.
// Throws std::invalid_argument when the grids differ.
Evaluation evaluate(const MeasuredTable& candidate, const MeasuredTable& reference,
                    double max_theta_deg = 90.0);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_METRICS_H_
