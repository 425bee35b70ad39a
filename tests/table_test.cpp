// The measured table: angles of the grid, validity, interpolation.
#include "measured/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace brdfit {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Grid small_grid(CellAnchor anchor) {
  return {7, 5, 6, anchor};
}

void for_each_cell(const Grid& grid, const std::function<void(int, int, int)>& visit) {
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) visit(h, d, p);
    }
  }
}

std::vector<float> planes_of(const Grid& grid, const std::function<Rgb(int, int, int)>& value) {
  std::vector<float> planes(3 * grid.cell_count());
  for_each_cell(grid, [&](int h, int d, int p) {
    const Rgb f = value(h, d, p);
    for (std::size_t c = 0; c < 3; ++c) {
      planes[c * grid.cell_count() + grid.index(h, d, p)] = static_cast<float>(f[c]);
    }
  });
  return planes;
}

// Values without any pattern.
MeasuredTable noise_table(const Grid& grid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> f(0.0, 3.0);
  return {grid, planes_of(grid, [&](int, int, int) { return Rgb{f(random), f(random), f(random)}; })};
}

// Trilinear in the cell numbers; dyadic, so that floats hold it exactly.
Rgb trilinear(double h, double d, double p) {
  const double f = 4.0 + 0.5 * h - 0.25 * d + 0.125 * p + 0.0625 * h * d * p;
  return {f, 2.0 * f, 16.0 + h};
}

// The angles at a place given in cells from the anchor of the first.
HalfDiff angles_at(const Grid& grid, double h, double d, double p) {
  const double offset = grid.anchor == CellAnchor::kCentre ? 0.5 : 0.0;
  const double root = (h + offset) / grid.n_theta_h;
  return {root * root * 0.5 * kPi, (d + offset) / grid.n_theta_d * 0.5 * kPi,
          (p + offset) / grid.n_phi_d * kPi};
}

class TableOfBothAnchors : public testing::TestWithParam<CellAnchor> {};

INSTANTIATE_TEST_SUITE_P(Anchors, TableOfBothAnchors,
                         testing::Values(CellAnchor::kLowerEdge, CellAnchor::kCentre),
                         [](const auto& instance) {
                           return instance.param == CellAnchor::kCentre ? "Centre" : "LowerEdge";
                         });

TEST_P(TableOfBothAnchors, InterpolationGivesBackEveryStoredValueExactly) {
  for (const Grid& grid : {small_grid(GetParam()), Grid{90, 9, 12, GetParam()}}) {
    const MeasuredTable table = noise_table(grid);
    for_each_cell(grid, [&](int h, int d, int p) {
      EXPECT_EQ(table.interpolate(grid.angles(h, d, p)), table.value(grid.index(h, d, p)));
    });
  }
}

TEST_P(TableOfBothAnchors, FunctionsTrilinearInTheGridAreExact) {
  const Grid grid = small_grid(GetParam());
  const MeasuredTable table(grid, planes_of(grid, trilinear));
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const double h = unit(random) * (grid.n_theta_h - 1);
    const double d = unit(random) * (grid.n_theta_d - 1);
    const double p = unit(random) * (grid.n_phi_d - 1);  // short of the wrap
    const auto f = table.interpolate(angles_at(grid, h, d, p));
    ASSERT_TRUE(f);
    const Rgb expected = trilinear(h, d, p);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((*f)[c], expected[c], 1e-10);
  }
}

TEST_P(TableOfBothAnchors, PhiWrapsAtPiIntoTheFirstColumn) {
  const Grid grid = small_grid(GetParam());
  const MeasuredTable table = noise_table(grid);
  const int last = grid.n_phi_d - 1;
  for (const double t : {0.0, 0.125, 0.5, 0.875}) {
    const auto f = table.interpolate(angles_at(grid, 3, 2, last + t));
    ASSERT_TRUE(f);
    for (std::size_t c = 0; c < 3; ++c) {
      const double from = table.value(grid.index(3, 2, last))[c];
      const double to = table.value(grid.index(3, 2, 0))[c];
      EXPECT_NEAR((*f)[c], from + (to - from) * t, 1e-12);
    }
  }
}

TEST_P(TableOfBothAnchors, SwappedDirectionsGiveTheSameValue) {
  const Grid grid = small_grid(GetParam());
  const MeasuredTable table = noise_table(grid);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  for (int k = 0; k < 1000; ++k) {
    const HalfDiff angles{unit(random) * 0.5 * kPi, unit(random) * 0.5 * kPi, unit(random) * 2.0 * kPi};
    const auto [wi, wo] = directions_from_half_diff(angles);
    const auto one = table.interpolate(wi, wo);
    const auto other = table.interpolate(wo, wi);
    const auto direct = table.interpolate(angles);
    ASSERT_TRUE(one && other && direct);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR((*one)[c], (*other)[c], 1e-10);
      EXPECT_NEAR((*one)[c], (*direct)[c], 1e-10);
    }
  }
}

TEST_P(TableOfBothAnchors, AnglesPastTheGridUseItsEnds) {
  const Grid grid = small_grid(GetParam());
  const MeasuredTable table = noise_table(grid);
  const double phi_rad = grid.phi_d_rad(2);
  EXPECT_EQ(table.interpolate(HalfDiff{0.5 * kPi, 0.5 * kPi, phi_rad}), table.value(grid.index(6, 4, 2)));
  EXPECT_EQ(table.interpolate(HalfDiff{2.0, 2.0, phi_rad}), table.value(grid.index(6, 4, 2)));
  EXPECT_EQ(table.interpolate(HalfDiff{0.0, 0.0, phi_rad}), table.value(grid.index(0, 0, 2)));
  EXPECT_EQ(table.interpolate(HalfDiff{-0.1, -0.1, phi_rad}), table.value(grid.index(0, 0, 2)));
}

TEST_P(TableOfBothAnchors, InvalidCornersAreLeftOutAndTheRestKeepsItsProportions) {
  const Grid grid = small_grid(GetParam());
  // One valid cell in the middle of a sea of invalid ones, then a second beside it.
  const auto with_valid = [&](int more) {
    return MeasuredTable(grid, planes_of(grid, [&](int h, int d, int p) {
                           if (h == 3 && d == 2 && p == 2) return Rgb{1, 2, 3};
                           if (h == 3 && d == 2 && p == 3 && more > 0) return Rgb{3, 4, 5};
                           return Rgb{-1, -1, -1};
                         }));
  };
  const HalfDiff near = angles_at(grid, 3.5, 2.5, 2.25);
  EXPECT_EQ(with_valid(0).interpolate(near), (Rgb{1, 2, 3}));
  const auto both = with_valid(1).interpolate(near);
  ASSERT_TRUE(both);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR((*both)[c], 1.5 + static_cast<double>(c), 1e-10);
}

TEST_P(TableOfBothAnchors, NothingComesOfInvalidCornersAlone) {
  const Grid grid = small_grid(GetParam());
  const MeasuredTable table(grid, planes_of(grid, [](int h, int, int) {
                              return h == 3 ? Rgb{-1, -1, -1} : Rgb{1, 1, 1};
                            }));
  // On the invalid row itself its neighbours have no weight, even after rounding.
  EXPECT_FALSE(table.interpolate(grid.angles(3, 2, 2)));
  EXPECT_TRUE(table.interpolate(angles_at(grid, 3.01, 2, 2)));
}

TEST_P(TableOfBothAnchors, AnglesThatAreNoNumbersGiveNothing) {
  const MeasuredTable table = noise_table(small_grid(GetParam()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(table.interpolate(HalfDiff{nan, 0.1, 0.1}));
  EXPECT_FALSE(table.interpolate(HalfDiff{0.1, nan, 0.1}));
  EXPECT_FALSE(table.interpolate(HalfDiff{0.1, 0.1, std::numeric_limits<double>::infinity()}));
}

TEST_P(TableOfBothAnchors, AGridOfOneCellIsConstant) {
  const MeasuredTable table(Grid{1, 1, 1, GetParam()}, {1.0F, 2.0F, 3.0F});
  for (const double t : {0.0, 0.3, 0.9, 1.5}) EXPECT_EQ(table.interpolate(HalfDiff{t, t, t}), (Rgb{1, 2, 3}));
}

TEST_P(TableOfBothAnchors, EveryStoredThetaHLiesInItsOwnRow) {
  for (int n = 1; n <= 200; ++n) {
    const Grid grid{n, 1, 1, GetParam()};
    for (int row = 0; row < n; ++row) EXPECT_EQ(grid.row_of_theta_h(grid.theta_h_rad(row)), row);
  }
}

TEST(Grid, RowsBeginAtTheirLowerEdgeAndEndBeforeTheNext) {
  const Grid grid;
  for (int row = 1; row < grid.n_theta_h; ++row) {
    const double edge = grid.theta_h_rad(row);
    EXPECT_EQ(grid.row_of_theta_h(std::nextafter(edge, 0.0)), row - 1);
    EXPECT_EQ(grid.row_of_theta_h(std::nextafter(edge, 2.0)), row);
  }
  EXPECT_EQ(grid.row_of_theta_h(-1.0), 0);
  EXPECT_EQ(grid.row_of_theta_h(0.5 * kPi), 89);
  EXPECT_EQ(grid.row_of_theta_h(3.0), 89);
}

TEST(Grid, AnglesAreThoseOfMerl) {
  const Grid lower;
  EXPECT_DOUBLE_EQ(lower.theta_h_rad(45), 0.25 * 0.5 * kPi);
  EXPECT_DOUBLE_EQ(lower.theta_d_rad(30), kPi / 6.0);
  EXPECT_DOUBLE_EQ(lower.phi_d_rad(90), 0.5 * kPi);
  const Grid centre{90, 90, 180, CellAnchor::kCentre};
  EXPECT_DOUBLE_EQ(centre.theta_h_rad(0), 0.5 * kPi / 32400.0);
  EXPECT_DOUBLE_EQ(centre.theta_d_rad(0), 0.5 * kPi / 180.0);
  EXPECT_DOUBLE_EQ(centre.phi_d_rad(179), 179.5 / 180.0 * kPi);
}

TEST(MeasuredTable, ACellWithOneBadChannelIsInvalidInAll) {
  const Grid grid{1, 2, 3, CellAnchor::kLowerEdge};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const MeasuredTable table(grid, {1, -1, 1, 1, 1, 0,             //
                                   1, 1, 1, kInfinity, 1, -0.0F,  //
                                   1, 1, 1, 1, nan, 0});
  EXPECT_EQ(table.valid_count(), 3U);
  for (const std::size_t cell : {0U, 2U, 5U}) EXPECT_TRUE(table.is_valid(cell));
  for (const std::size_t cell : {1U, 3U, 4U}) {
    EXPECT_FALSE(table.is_valid(cell));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(table.value(cell)[c], 0.0);
  }
}

TEST(MeasuredTable, AnInvalidCellKeepsItsReason) {
  const Grid grid{1, 2, 3, CellAnchor::kLowerEdge};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const MeasuredTable table(grid, {1, -7, -1, -kInfinity, 1, 0,  //
                                   1, 1, -2, -1, 1, 0,           //
                                   1, 1, -3, -1, nan, 0});
  const std::array<CellState, 6> expected = {CellState::kMeasured,   CellState::kNegative,
                                             CellState::kUnmeasured, CellState::kNotFinite,
                                             CellState::kNotFinite,  CellState::kMeasured};
  for (std::size_t cell = 0; cell < 6; ++cell) EXPECT_EQ(table.state(cell), expected[cell]) << cell;
  EXPECT_EQ(table.state_counts(), (std::array<std::size_t, 4>{2, 1, 1, 2}));
}

TEST(MeasuredTable, ValidityIsFoundInEveryPlaceOfALongTable) {
  const Grid grid{3, 50, 61, CellAnchor::kLowerEdge};  // more than one block, none of them full at the end
  for (std::size_t bad = 0; bad < grid.cell_count(); bad += 97) {
    std::vector<float> planes(3 * grid.cell_count(), 0.5F);
    planes[bad + (bad % 3) * grid.cell_count()] = -0.25F;
    const MeasuredTable table(grid, std::move(planes));
    EXPECT_EQ(table.valid_count(), grid.cell_count() - 1);
    EXPECT_FALSE(table.is_valid(bad));
    EXPECT_EQ(table.state(bad), CellState::kNegative);
  }
}

TEST(MeasuredTable, TheLargestValueIsThatOfAnyChannel) {
  const Grid grid{1, 1, 2, CellAnchor::kLowerEdge};
  EXPECT_DOUBLE_EQ(MeasuredTable(grid, {1, 2, 3, 7, 5, 6}).largest(), 7.0);
  EXPECT_DOUBLE_EQ(MeasuredTable(grid, {1, 2, 3, 70, 5, -6}).largest(), 5.0);  // 70 is in the invalid cell
  EXPECT_DOUBLE_EQ(MeasuredTable(grid, {-1, -1, -1, -1, -1, -1}).largest(), 0.0);
  EXPECT_DOUBLE_EQ(MeasuredTable().largest(), 0.0);
}

TEST(MeasuredTable, PlanesAreTheColoursInOrder) {
  const MeasuredTable table(Grid{1, 1, 2, CellAnchor::kLowerEdge}, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(table.plane(1)[0], 3.0F);
  EXPECT_EQ(table.plane(2)[1], 6.0F);
  EXPECT_EQ(table.plane(0).size(), 2U);
  EXPECT_TRUE(MeasuredTable().plane(0).empty());
}

TEST(MeasuredTable, PlanesOfAnotherSizeAreRefused) {
  const auto make = [](const Grid& grid, std::size_t size) { MeasuredTable(grid, std::vector<float>(size)); };
  EXPECT_THROW(make({2, 2, 2}, 23), std::invalid_argument);
  EXPECT_THROW(make({2, 2, 2}, 27), std::invalid_argument);
  EXPECT_THROW(make({2, 0, 2}, 0), std::invalid_argument);
  EXPECT_THROW(make({-2, -2, 2}, 24), std::invalid_argument);
  EXPECT_THROW(make({1 << 30, 1 << 30, 1 << 4}, 0), std::invalid_argument);  // the product is 2^64
  EXPECT_NO_THROW(make({2, 2, 2}, 24));
}

}  // namespace
}  // namespace brdfit
