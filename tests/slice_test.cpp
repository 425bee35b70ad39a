// The grid of the slice measures: which stored cell each pixel shows.
#include "measured/slice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace brdfit {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Every cell valid but those of the set.
MeasuredTable table_with_holes(const Grid& grid, const std::set<std::size_t>& holes) {
  std::vector<float> planes(3 * grid.cell_count(), 0.25F);
  for (const std::size_t cell : holes) planes[cell] = -1.0F;
  return MeasuredTable(grid, planes);
}

TEST(Slice, OfAMerlTableHas90By90PixelsRowByRow) {
  const Slice slice = make_slice(table_with_holes({}, {}));
  EXPECT_EQ(slice.size, 90);
  ASSERT_EQ(slice.pixels.size(), 8100U);
  for (int row = 0; row < 90; ++row) {
    for (int column = 0; column < 90; ++column) {
      const SlicePixel& pixel = slice.pixels[static_cast<std::size_t>(row * 90 + column)];
      EXPECT_EQ(pixel.row, row);
      EXPECT_EQ(pixel.column, column);
    }
  }
}

// Column (i + 0.5) deg shows the stored row whose lower edge is the last at or below it.
TEST(Slice, ShowsTheStoredThetaHRowThatContainsThePixelsCentre) {
  for (const CellAnchor anchor : {CellAnchor::kLowerEdge, CellAnchor::kCentre}) {
    Grid grid;
    grid.anchor = anchor;
    const Slice slice = make_slice(table_with_holes(grid, {}));
    for (const SlicePixel& pixel : slice.pixels) {
      const double centre_deg = pixel.column + 0.5;
      const auto edge_deg = [](int i) { return 90.0 * i * i / 8100.0; };
      EXPECT_LE(edge_deg(pixel.i_theta_h), centre_deg);
      EXPECT_GT(edge_deg(pixel.i_theta_h + 1), centre_deg);
    }
  }
}

TEST(Slice, ShowsStoredThetaDAndPhiD) {
  const Grid grid;
  const Slice slice = make_slice(table_with_holes(grid, {}));
  EXPECT_EQ(slice.i_phi_d, 90);
  EXPECT_NEAR(grid.phi_d_rad(slice.i_phi_d), 90 * kDegree, 1e-15);
  for (const SlicePixel& pixel : slice.pixels) {
    EXPECT_EQ(pixel.i_theta_d, pixel.row);
    EXPECT_NEAR(grid.theta_d_rad(pixel.i_theta_d), pixel.row * kDegree, 1e-15);
    EXPECT_EQ(pixel.cell, grid.index(pixel.i_theta_h, pixel.i_theta_d, 90));
  }
}

TEST(Slice, OfOtherGridsStaysInsideThem) {
  for (const Grid& grid : {Grid{7, 5, 3, CellAnchor::kLowerEdge}, Grid{1, 1, 1, CellAnchor::kCentre},
                           Grid{200, 131, 64, CellAnchor::kLowerEdge}}) {
    for (const double phi_d : {0.0, 45.0, 90.0, 179.999}) {
      const Slice slice = make_slice(table_with_holes(grid, {}), phi_d, 33);
      ASSERT_EQ(slice.pixels.size(), 33U * 33U);
      for (const SlicePixel& pixel : slice.pixels) {
        const double theta_d_share = (pixel.row + 0.5) / 33;
        EXPECT_EQ(pixel.i_theta_d, static_cast<int>(theta_d_share * grid.n_theta_d));
        const double root = std::sqrt((pixel.column + 0.5) / 33);
        EXPECT_EQ(pixel.i_theta_h, static_cast<int>(root * grid.n_theta_h));
        EXPECT_LT(pixel.cell, grid.cell_count());
      }
    }
  }
}

TEST(Slice, MarksPixelsOfInvalidCells) {
  const Grid grid;
  const std::set<std::size_t> holes = {grid.index(0, 3, 90), grid.index(89, 89, 90), grid.index(40, 7, 91)};
  const Slice slice = make_slice(table_with_holes(grid, holes));
  for (const SlicePixel& pixel : slice.pixels) EXPECT_EQ(pixel.valid, !holes.contains(pixel.cell));
}

TEST(PhiDIndex, IsTheStoredAngleAtOrBelow) {
  Grid grid;
  for (int i = 0; i < grid.n_phi_d; ++i) {
    EXPECT_EQ(phi_d_index(grid, i), i);
    EXPECT_EQ(phi_d_index(grid, i + 0.5), i);
    EXPECT_EQ(phi_d_index(grid, i + 0.999), i);
  }
  grid.n_phi_d = 36;
  EXPECT_EQ(phi_d_index(grid, 90.0), 18);
  EXPECT_EQ(phi_d_index(grid, 89.9), 17);
}

// Every stored angle finds itself, whatever the division does to its last digit.
TEST(PhiDIndex, FindsStoredAnglesOfAnyGrid) {
  for (int n = 1; n <= 400; ++n) {
    Grid grid;
    grid.n_phi_d = n;
    for (int i = 0; i < n; ++i) ASSERT_EQ(phi_d_index(grid, 180.0 * i / n), i) << n;
  }
}

TEST(PhiDIndex, FoldsByReciprocity) {
  const Grid grid;
  for (const double phi_d : {0.0, 12.5, 90.0, 179.5}) {
    for (const double turn : {-360.0, -180.0, 180.0, 360.0}) {
      EXPECT_EQ(phi_d_index(grid, phi_d + turn), phi_d_index(grid, phi_d)) << phi_d << " + " << turn;
    }
  }
}

}  // namespace
}  // namespace brdfit
