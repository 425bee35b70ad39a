// Slices of a measured table.
#include "measured/slice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace brdfit {

int phi_d_index(const Grid& grid, double phi_d_deg) {
  const double folded = phi_d_deg - 180.0 * std::floor(phi_d_deg / 180.0);
  // The small term keeps 90 / 180 * n from falling just below a stored angle.
  const int index = static_cast<int>(std::floor(folded / 180.0 * grid.n_phi_d + 1e-9));
  return std::min(index, grid.n_phi_d - 1);
}

int theta_h_row_of_column(const Grid& grid, int column, int size) {
  // Row i begins at (i/n)^2 of the axis, the centre lies at (2 column + 1) / (2 size): in whole numbers, as
  // rounding would decide ties (the centre of column 62 of 90 is where row 75 of 90 begins).
  const auto n = static_cast<std::int64_t>(grid.n_theta_h);
  const std::int64_t centre = (2 * static_cast<std::int64_t>(column) + 1) * n * n;
  const auto begins_by_then = [&](std::int64_t i) { return i * i * 2 * size <= centre; };
  auto row = static_cast<std::int64_t>(std::sqrt(static_cast<double>(centre) / (2.0 * size)));
  while (begins_by_then(row + 1)) ++row;
  while (!begins_by_then(row)) --row;
  return static_cast<int>(std::min(row, n - 1));
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
      const int i_theta_h = theta_h_row_of_column(grid, column, size);
      const std::size_t cell = grid.index(i_theta_h, i_theta_d, slice.i_phi_d);
      slice.pixels.push_back({column, row, i_theta_h, i_theta_d, cell, table.is_valid(cell)});
    }
  }
  return slice;
}

}  // namespace brdfit
