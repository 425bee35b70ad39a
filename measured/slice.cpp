// Slices of a measured table.
#include "measured/slice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brdfit {

int phi_d_index(const Grid& grid, double phi_d_deg) {
  const double folded = phi_d_deg - 180.0 * std::floor(phi_d_deg / 180.0);
  // The small term keeps 90 / 180 * n from falling just below a stored angle.
  const int index = static_cast<int>(std::floor(folded / 180.0 * grid.n_phi_d + 1e-9));
  return std::min(index, grid.n_phi_d - 1);
}

Slice make_slice(const MeasuredTable& table, double phi_d_deg, int size) {
  const Grid& grid = table.grid();
  Slice slice;
  slice.size = size;
  slice.i_phi_d = phi_d_index(grid, phi_d_deg);
  slice.pixels.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) {
    const int i_theta_d = std::min(static_cast<int>((row + 0.5) / size * grid.n_theta_d), grid.n_theta_d - 1);
    for (int column = 0; column < size; ++column) {
      const double theta_h_rad = (column + 0.5) / size * std::numbers::pi / 2;
      const int i_theta_h = grid.row_of_theta_h(theta_h_rad);
      const std::size_t cell = grid.index(i_theta_h, i_theta_d, slice.i_phi_d);
      slice.pixels.push_back({column, row, i_theta_h, i_theta_d, cell, table.is_valid(cell)});
    }
  }
  return slice;
}

}  // namespace brdfit
