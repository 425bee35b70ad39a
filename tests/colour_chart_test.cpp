// The chart's reference colours, and the matrix that follows from a photograph of it.
#include "io/colour_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "io/transfer.h"

namespace brdfit::io {
namespace {

// Computed by others from the same L*a*b* (Pascale, "RGB coordinates of the Macbeth ColorChecker", 2006), to
// the nearest code.
TEST(ColourChart, ReferenceAgreesWithThePublishedSrgb) {
  constexpr int kPublished[kChartPatches][3] = {
      {115, 81, 67},   {199, 147, 129}, {91, 122, 156},  {90, 108, 64},   {130, 128, 176}, {92, 190, 172},
      {224, 124, 47},  {68, 91, 170},   {198, 82, 97},   {94, 58, 106},   {159, 189, 63},  {230, 162, 39},
      {35, 63, 147},   {67, 149, 74},   {180, 49, 57},   {238, 198, 20},  {193, 84, 151},  {0, 136, 170},
      {245, 245, 243}, {200, 202, 202}, {161, 163, 163}, {121, 121, 122}, {82, 84, 86},    {49, 49, 51}};
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double code = 255.0 * to_code({Transfer::Kind::kSrgb}, chart_reference()[k][c]);
      const bool is_outside = k == 17 && c == 0;  // cyan's red is below 0
      if (is_outside) {
        EXPECT_LT(code, 0.0);
      } else {
        EXPECT_NEAR(code, kPublished[k][c], 1.0) << "patch " << k + 1 << ", channel " << c;
      }
    }
  }
}

TEST(ColourChart, TheChartItselfGivesTheIdentity) {
  const ChartFit fit = fit_chart(chart_reference());
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(fit.matrix[i][j], i == j ? 1.0 : 0.0, 1e-12);
  }
  EXPECT_LT(fit.rms, 1e-12);
}

TEST(ColourChart, TheFitIsTheLeastOfItsNeighbours) {
  std::array<Rgb, kChartPatches> camera = chart_reference();
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      camera[k][c] = std::pow(std::abs(camera[k][c]), 1.1) + 0.003 * double(k % 5);
  }
  const ChartFit fit = fit_chart(camera);
  const auto rms_of = [&](const Matrix3& matrix) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kChartPatches; ++k) {
      const Rgb got = matrix * camera[k];
      for (std::size_t c = 0; c < 3; ++c) sum += std::pow(got[c] - chart_reference()[k][c], 2);
    }
    return std::sqrt(sum / (3.0 * kChartPatches));
  };
  EXPECT_NEAR(rms_of(fit.matrix), fit.rms, 1e-15);
  for (std::size_t i = 0; i < 9; ++i) {
    for (const double step : {-0.01, 0.01}) {
      Matrix3 other = fit.matrix;
      other[i / 3][i % 3] += step;
      EXPECT_GT(rms_of(other), fit.rms);
    }
  }
}

TEST(ColourChart, PatchesWithoutColourAreRefused) {
  std::array<Rgb, kChartPatches> grey;
  for (std::size_t k = 0; k < kChartPatches; ++k) grey[k].fill(chart_reference()[k][1]);
  EXPECT_THROW(fit_chart(grey), std::invalid_argument);
  EXPECT_THROW(fit_chart(std::array<Rgb, kChartPatches>{}), std::invalid_argument);
  std::array<Rgb, kChartPatches> bad = chart_reference();
  bad[3][1] = std::nan("");
  EXPECT_THROW(fit_chart(bad), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::io
