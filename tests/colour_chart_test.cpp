// The chart's reference colours, and the matrix that follows from a photograph of it.
#include "io/colour_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "io/transfer.h"

namespace brdfit::io {
namespace {

// X-Rite prints 8-bit sRGB beside L*a*b*, made by another route: greys agree, saturated patches to 12 codes.
// A wrong order, white or matrix is off by far more.
TEST(ColourChart, ReferenceAgreesWithThePublishedSrgb) {
  constexpr int kPublished[kChartPatches][3] = {
      {115, 82, 68},   {194, 150, 130}, {98, 122, 157},  {87, 108, 67},   {133, 128, 177}, {103, 189, 170},
      {214, 126, 44},  {80, 91, 166},   {193, 90, 99},   {94, 60, 108},   {157, 188, 64},  {224, 163, 46},
      {56, 61, 150},   {70, 148, 73},   {175, 54, 60},   {231, 199, 31},  {187, 86, 149},  {8, 133, 161},
      {243, 243, 242}, {200, 200, 200}, {160, 160, 160}, {122, 122, 121}, {85, 85, 85},    {52, 52, 52}};
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double code = 255.0 * to_code({Transfer::Kind::kSrgb}, chart_reference()[k][c]);
      const bool is_outside = k == 17 && c == 0;  // cyan's red is below 0
      if (is_outside) {
        EXPECT_LT(code, 0.0);
      } else {
        EXPECT_NEAR(code, kPublished[k][c], k >= 18 ? 3.0 : 12.0) << "patch " << k + 1 << ", channel " << c;
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
