// Losses: names, targets, and the slopes of their transforms.
#include "fit/loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fit/loss_kernel.h"

namespace brdfit::fit {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Loss, NamesRoundTripAndAreThoseOfTheCommandLine) {
  std::vector<std::string_view> names;
  for (const Loss loss : all_losses()) {
    names.push_back(name_of(loss));
    EXPECT_EQ(loss_by_name(name_of(loss)), loss);
  }
  EXPECT_EQ(names, (std::vector<std::string_view>{"log-ratio", "cube-root", "linear", "srgb", "slice"}));
}

TEST(Loss, HasNoOtherNames) {
  for (const char* name : {"", "log", "Log-Ratio", "log_ratio", "cuberoot", "sRGB", "linear "}) {
    EXPECT_EQ(loss_by_name(name), std::nullopt) << name;
  }
}

TEST(Loss, DefaultIsTheLogRatio) {
  EXPECT_EQ(Loss{}, Loss::kLogRatio);
}

// sRGB's published table: 8-bit values of linear light (IEC 61966-2-1).
TEST(LossTarget, OfSrgbIsTheStandardsCurveOfRadiance) {
  const auto shown = [](double linear) { return loss_target(Loss::kSrgb, linear / kPi, 1.0); };
  EXPECT_DOUBLE_EQ(shown(0.0), 0.0);
  EXPECT_NEAR(shown(1.0), 1.0, 1e-15);
  EXPECT_NEAR(shown(0.002), 0.02584, 1e-15);
  EXPECT_NEAR(255 * shown(0.21586050), 128.0, 1e-4);
  EXPECT_NEAR(255 * shown(0.05126946), 64.0, 1e-4);
  EXPECT_NEAR(255 * shown(0.52711513), 192.0, 1e-4);
}

// The two pieces of the curve meet as the standard lets them: to the digits of its constants.
TEST(LossTarget, OfSrgbJoinsItsPieces) {
  const double below = loss_target(Loss::kSrgb, std::nextafter(0.0031308, 0.0) / kPi, 1.0);
  const double above = loss_target(Loss::kSrgb, 0.0031309 / kPi, 1.0);
  EXPECT_GT(above, below);
  EXPECT_NEAR(above, below, 2e-6);
}

// Highlights keep a gradient.
TEST(LossTarget, OfSrgbGrowsBeyondWhite) {
  EXPECT_NEAR(loss_target(Loss::kSrgb, 100.0 / kPi, 1.0), 1.055 * std::pow(100.0, 1 / 2.4) - 0.055, 1e-12);
}

TEST(LossTarget, IsTheTransformOfFTimesTheCosine) {
  for (const double f : {0.0, 1e-6, 0.01, 0.3, 0.9, 5.0, 2000.0}) {
    for (const double cos_i : {0.01, 0.4, 1.0}) {
      const double y = f * cos_i;
      EXPECT_DOUBLE_EQ(loss_target(Loss::kLogRatio, f, cos_i), std::log(y + 1e-3));
      EXPECT_NEAR(loss_target(Loss::kCubeRoot, f, cos_i), std::cbrt(y + 1e-6), 1e-14 * std::cbrt(y + 1));
      EXPECT_DOUBLE_EQ(loss_target(Loss::kLinear, f, cos_i), y);
      EXPECT_NEAR(loss_target(Loss::kSlice, f, cos_i), std::min(f, 1.0), 1e-15);
    }
  }
}

// Slopes against differences of the transforms, away from the corners at sRGB's join and at f = 1.
TEST(LossTransform, SlopesAreThoseOfTheValues) {
  for (const Loss loss : all_losses()) {
    const int id = static_cast<int>(loss);
    for (const double y : {1e-5, 5e-4, 2e-3, 0.04, 0.6, 3.0, 400.0}) {
      for (const double cos_i : {0.1, 1.0}) {
        const double h = 1e-4 * y;
        const auto at = [&](double x) { return transform(id, x, cos_i).value; };
        const double slope = (8 * (at(y + h) - at(y - h)) - (at(y + 2 * h) - at(y - 2 * h))) / (12 * h);
        EXPECT_NEAR(transform(id, y, cos_i).slope, slope, 1e-9 * (std::abs(slope) + 1))
            << name_of(loss) << " at " << y;
      }
    }
  }
}

// The corner of the sRGB curve: each side's own slope.
TEST(LossTransform, SrgbIsStraightInTheDark) {
  const int id = static_cast<int>(Loss::kSrgb);
  EXPECT_DOUBLE_EQ(transform(id, 0.0, 1.0).slope, 12.92 * kPi);
  EXPECT_DOUBLE_EQ(transform(id, 0.003 / kPi, 1.0).slope, 12.92 * kPi);
  EXPECT_LT(transform(id, 0.0032 / kPi, 1.0).slope, 12.92 * kPi);
}

TEST(LossTransform, IsFiniteAndRisesFromZero) {
  for (const Loss loss : all_losses()) {
    const int id = static_cast<int>(loss);
    double before = transform(id, 0.0, 1.0).value;
    EXPECT_TRUE(std::isfinite(before));
    EXPECT_TRUE(std::isfinite(transform(id, 0.0, 1.0).slope));
    for (double y = 1e-8; y < 1e6; y *= 1.7) {
      const auto t = transform(id, y, 1.0);
      const bool clipped = loss == Loss::kSlice && y > 1.0;
      EXPECT_TRUE(clipped ? t.value == 1.0 && t.slope == 0.0 : t.slope > 0.0) << name_of(loss) << " at " << y;
      EXPECT_GE(t.value, before);
      before = t.value;
    }
  }
}

TEST(LossShape, IsRobustForTheLogRatioAlone) {
  for (const Loss loss : all_losses()) {
    const LossShape shape = shape_of(loss);
    EXPECT_EQ(shape.robust_width > 0.0, loss == Loss::kLogRatio) << name_of(loss);
    EXPECT_EQ(shape.clipped_share > 0.0, loss == Loss::kLogRatio) << name_of(loss);
    // A share without a width would be squares, which is allowed; a width without a share means nothing.
    EXPECT_EQ(shape.clipped_width > 0.0, shape.clipped_share > 0.0) << name_of(loss);
  }
}

}  // namespace
}  // namespace brdfit::fit
