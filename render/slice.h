// Pictures of BRDF slices: theta_h on x (0 to 90 deg, left to right), theta_d on y (0 at the bottom, 90 deg
// at the top), at one phi_d. At phi_d = 90 deg the Fresnel peak is at the top, the specular peak on the left,
// retroreflection on the right (Burley 2012).
#ifndef BRDFIT_RENDER_SLICE_H_
#define BRDFIT_RENDER_SLICE_H_

#include <string>

#include "brdf/half_diff.h"
#include "measured/table.h"
#include "render/image.h"
#include "render/subject.h"

namespace brdfit::render {

enum class ThetaHAxis {
  kLinear,
  kSquareRoot,  // sqrt(theta_h / 90 deg): room for narrow peaks
};

enum class Quantity { kF, kFCos };

enum class SliceSampling {
  kSmooth,  // every pixel at its own angles; tables are interpolated
  kStored,  // every pixel at the stored angles of the cell that contains it, as the slice measures compare
};

struct SliceOptions {
  int size = 512;           // pixels along both sides
  double phi_d_deg = 90.0;  // any; folded into [0, 360) for materials, [0, 180) for tables
  ThetaHAxis axis = ThetaHAxis::kLinear;
  Quantity quantity = Quantity::kF;
  SliceSampling sampling = SliceSampling::kSmooth;
  Grid grid;  // of the cells for kStored when a material is drawn; a table uses its own

  // Size in 1..16384, a finite phi_d, 1..65536 cells along each side of the grid.
  bool is_valid(std::string* why) const;
};

// The angles that a pixel (0 to size - 1, from the top left) shows: those of its centre, or of the stored
// cell of options.grid. A centre on the edge of two cells belongs to the one that begins there.
HalfDiff slice_angles(const SliceOptions& options, int x, int y);

// f or f cos_i, in sr^-1, of each pixel; for a material with kF f(wi, wo), not the mean of both orders. A
// pixel whose own cell of a table is not measured has that state even where neighbours could be interpolated.
//
// A pixel is below the horizon when a cosine at the angles that it shows is below 1e-9, whatever a table
// holds there: closer, rounding would decide. MERL's files and the error measures draw the same line. It also
// bounds f, which Proxima and correlated masking let grow towards the horizon: values of a valid material
// stay below 1e22. A material that is not valid may exceed a float; such pixels are kNotFinite.
//
// Parallel over rows; memory is that of the image and a row per thread. Throws std::invalid_argument when the
// options are not valid or the table is empty.
Image draw_slice(const Subject& subject, const SliceOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_SLICE_H_
