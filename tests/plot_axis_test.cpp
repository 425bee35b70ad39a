// Axes hold their data and have ticks that can be read.
#include "render/plot_axis.h"

#include <gmock/gmock.h>

#include <cmath>

namespace brdfit::render {
namespace {

TEST(PlotAxis, HoldsItsDataInOrderWhateverTheirSize) {
  for (const double scale : {1e-12, 1e-3, 1.0, 1e9}) {
    for (const double ratio : {1.0, 1.001, 2.0, 50.0, 1e6, 1e12}) {
      const PlotAxis axis(scale, scale * ratio);
      EXPECT_GT(axis.place(scale), 0.0) << scale << " x " << ratio;
      EXPECT_LT(axis.place(scale * ratio), 1.0) << scale << " x " << ratio;
      EXPECT_LE(axis.place(scale), axis.place(scale * ratio));
    }
  }
}

TEST(PlotAxis, TicksRiseWithinItAndAreNeitherFewNorMany) {
  for (const double smallest : {1e-7, 0.3, 0.97, 41.0}) {
    for (const double ratio : {1.01, 3.0, 9.0, 300.0, 1e5, 1e11}) {
      const PlotAxis axis(smallest, smallest * ratio);
      EXPECT_GE(axis.ticks().size(), 2U) << smallest << " x " << ratio;
      EXPECT_LE(axis.ticks().size(), 12U) << smallest << " x " << ratio;
      double before = -1e-9;
      for (const AxisTick& tick : axis.ticks()) {
        EXPECT_GT(axis.place(tick.value), before);
        before = axis.place(tick.value);
        EXPECT_FALSE(tick.label.empty());
      }
      EXPECT_LE(before, 1.0 + 1e-9);
    }
  }
}

TEST(PlotAxis, EqualRatiosAreEqualDistancesWhereTheRangeIsWide) {
  const PlotAxis wide(1.0, 100.0);
  EXPECT_TRUE(wide.is_logarithmic());
  EXPECT_NEAR(wide.place(10.0) - wide.place(1.0), wide.place(100.0) - wide.place(10.0), 1e-12);
  const PlotAxis narrow(1.0, 3.0);
  EXPECT_FALSE(narrow.is_logarithmic());
  EXPECT_NEAR(narrow.place(2.0) - narrow.place(1.0), narrow.place(3.0) - narrow.place(2.0), 1e-12);
}

TEST(PlotAxis, ShowsZeroWhereItIsAskedFor) {
  for (const auto& [smallest, largest] : {std::pair(1.0, 100.0), {-3.0, -1.0}, {-1.0, 2.0}, {0.0, 0.0}}) {
    const PlotAxis axis(smallest, largest, true);
    EXPECT_FALSE(axis.is_logarithmic());
    EXPECT_GE(axis.place(0.0), 0.0);
    EXPECT_LE(axis.place(0.0), 1.0);
    EXPECT_TRUE(std::isfinite(axis.place(smallest)));
  }
}

}  // namespace
}  // namespace brdfit::render
