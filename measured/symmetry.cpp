// Comparing cells with their mirror images.
#include "measured/symmetry.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <vector>

#include "measured/grid_geometry.h"

namespace brdfit {
namespace {

struct Sum {
  double total = 0.0;
  std::size_t count = 0;
};

// The pairs of one theta_h row.
Sum sum_of_row(const MeasuredTable& table, const GridGeometry& geometry, int i_theta_h) {
  constexpr double kFloor = 1e-3;
  const Grid& grid = table.grid();
  Sum sum;
  for (int d = 0; d < grid.n_theta_d; ++d) {
    for (int p = 0; p < grid.n_phi_d; ++p) {
      const int mirrored = geometry.mirror(p);
      // Each pair once; the image of phi_d = 0 is not stored, and a cell at 90 deg is its own.
      if (mirrored <= p || mirrored >= grid.n_phi_d) continue;
      const std::size_t cell = grid.index(i_theta_h, d, p);
      const std::size_t image = grid.index(i_theta_h, d, mirrored);
      if (!table.is_valid(cell) || !table.is_valid(image)) continue;
      const Rgb a = table.value(cell);
      const Rgb b = table.value(image);
      for (std::size_t c = 0; c < 3; ++c) sum.total += std::abs(std::log((a[c] + kFloor) / (b[c] + kFloor)));
      sum.count += 3;
    }
  }
  return sum;
}

}  // namespace

double mirror_asymmetry_pct(const MeasuredTable& table) {
  const GridGeometry geometry(table.grid());
  std::vector<Sum> rows(static_cast<std::size_t>(table.grid().n_theta_h));
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t h) { rows[h] = sum_of_row(table, geometry, static_cast<int>(h)); });
  Sum all;
  for (const Sum& row : rows) {
    all.total += row.total;
    all.count += row.count;
  }
  return all.count == 0 ? 0.0 : 100.0 * all.total / static_cast<double>(all.count);
}

}  // namespace brdfit
