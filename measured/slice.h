// The BRDF slice at phi_d = 90 deg as the slice measures see it.
#ifndef BRDFIT_MEASURED_SLICE_H_
#define BRDFIT_MEASURED_SLICE_H_

#include <cstddef>
#include <vector>

#include "measured/table.h"

namespace brdfit {

// One pixel of a slice: the stored cell that it shows.
struct SlicePixel {
  int column;  // theta_h, 0 at 0 deg
  int row;     // theta_d, 0 at 0 deg
  int i_theta_h;
  int i_theta_d;
  std::size_t cell;  // in the table
  bool valid;
};

// A square image of a slice, size x size pixels over [0, 90) deg in theta_h and theta_d, row by row. A pixel
// shows the stored cell that contains its centre; its value belongs to that cell's own angles.
struct Slice {
  int size = 0;
  int i_phi_d = 0;
  std::vector<SlicePixel> pixels;
};

// The stored index that contains phi_d (folded into [0, 180)).
int phi_d_index(const Grid& grid, double phi_d_deg);

// The stored theta_h row that contains the centre of a column, of size columns over [0, 90) deg. Exact: a
// centre on an edge belongs to the row that begins there.
int theta_h_row_of_column(const Grid& grid, int column, int size);

Slice make_slice(const MeasuredTable& table, double phi_d_deg = 90.0, int size = 90);

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_SLICE_H_
