// The mirror asymmetry of tables: 0 for a material's own, and what was planted elsewhere.
#include "measured/symmetry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace brdfit {
namespace {

// f = 1 everywhere but where phi_d is below 90 deg.
MeasuredTable lopsided(CellAnchor anchor, float low) {
  const Grid grid{3, 4, 10, anchor};
  std::vector<float> planes(3 * grid.cell_count(), 1.0F);
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (k % 10 < 5) planes[k] = low;
  }
  return {grid, std::move(planes)};
}

TEST(MirrorAsymmetry, IsTheLogarithmOfTheRatioOfEachPair) {
  const double expected = 100.0 * std::abs(std::log((0.5 + 1e-3) / (1.0 + 1e-3)));
  // Values at centres: every cell of the low half has its image in the other.
  EXPECT_NEAR(mirror_asymmetry_pct(lopsided(CellAnchor::kCentre, 0.5F)), expected, 1e-9);
  // At lower edges 1..4 have 9..6; 0 and 5 are their own.
  EXPECT_NEAR(mirror_asymmetry_pct(lopsided(CellAnchor::kLowerEdge, 0.5F)), expected, 1e-9);
  EXPECT_EQ(mirror_asymmetry_pct(lopsided(CellAnchor::kCentre, 1.0F)), 0.0);
}

TEST(MirrorAsymmetry, LeavesOutPairsOfWhichOneIsNotMeasured) {
  const Grid grid{1, 1, 4, CellAnchor::kCentre};
  const MeasuredTable table(grid, {1, -1, 7, 1, 1, -1, 7, 1, 1, -1, 7, 1});
  EXPECT_EQ(mirror_asymmetry_pct(table), 0.0);
}

}  // namespace
}  // namespace brdfit
