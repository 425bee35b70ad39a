// Windowed spherical Gaussians: 1 on the axis, and an end without an edge.
#include "brdf/kernel/spherical_gaussian.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bake/lobes.h"
#include "brdf/realis.h"

namespace brdfit {
namespace {

using Jet = ceres::Jet<double, 1>;

TEST(SphericalGaussian, IsOneOnTheAxis) {
  for (const double sharpness : {0.0, 1.0, 30.0, 1e6}) {
    EXPECT_EQ(kernel::windowed_lobe(0.0, sharpness, 0.2), 1.0);
  }
}

TEST(SphericalGaussian, EndsWithValueAndSlopeZeroAtTheCutOff) {
  for (const double cut_off : {-1.0, -0.3, 0.0, 0.7}) {
    const Jet at = kernel::windowed_lobe(Jet(1.0 - cut_off, 0), Jet(2.0), Jet(cut_off));
    EXPECT_EQ(at.a, 0.0);
    EXPECT_EQ(at.v[0], 0.0);
    const double inside = kernel::windowed_lobe(1.0 - cut_off - 1e-4, 2.0, cut_off);
    EXPECT_GT(inside, 0.0);
    EXPECT_LT(inside, 1e-6);
    EXPECT_EQ(kernel::windowed_lobe(1.0 - cut_off + 1e-3, 2.0, cut_off), 0.0);
  }
}

TEST(SphericalGaussian, FallsSteadilyFromTheAxis) {
  double before = 1.0;
  for (int step = 1; step <= 200; ++step) {
    const double value = kernel::windowed_lobe(0.01 * step, 3.0, -1.0);
    EXPECT_LT(value, before);
    before = value;
  }
}

// A rounding of the cosine, times the sharpness, would be a sixteenth of the value and more.
TEST(SphericalGaussian, KeepsItsDigitsInFloatHoweverSharp) {
  constexpr double kSharpness = 1e6;
  for (const double angle : {0.0, 1e-4, 5e-4, 1e-3, 2e-3}) {
    for (const double tilt : {0.0, 0.3, 1.1}) {
      const Vec3 axis = {std::sin(tilt), 0.0, std::cos(tilt)};
      const Vec3 towards = {std::sin(tilt + angle), 0.0, std::cos(tilt + angle)};
      // Of directions that are rounded to float, as a device has them.
      const auto f = [](double x) { return static_cast<float>(x); };
      const float single =
          kernel::windowed_lobe(kernel::one_minus_cos_between(f(axis.x), f(axis.y), f(axis.z), f(towards.x),
                                                              f(towards.y), f(towards.z)),
                                f(kSharpness), -1.0F);
      const auto wide = [&](double x) { return static_cast<double>(f(x)); };
      const Lobe lobe = {{wide(axis.x), wide(axis.y), wide(axis.z)}, kSharpness, -1.0};
      const double exact = eval(lobe, {wide(towards.x), wide(towards.y), wide(towards.z)});
      EXPECT_NEAR(static_cast<double>(single), exact, 1e-6) << angle << " " << tilt;
      EXPECT_LE(single, 1.0F);
      EXPECT_LE(exact, 1.0);
    }
  }
}

TEST(SphericalGaussian, ValuesOfASetAreThoseOfItsLobes) {
  const LobeSet lobes{{{0.0, 0.0, 1.0}, 4.0, -1.0}, {{0.6, 0.0, 0.8}, 9.0, 0.1}};
  const std::vector<Vec3> directions{{0.0, 0.0, 1.0}, {0.0, 0.6, 0.8}, {1.0, 0.0, 0.0}};
  const Eigen::MatrixXd values = bake::lobe_values(lobes, directions);
  ASSERT_EQ(values.rows(), 3);
  ASSERT_EQ(values.cols(), 2);
  EXPECT_EQ(values(0, 0), 1.0);
  EXPECT_EQ(values(1, 1), eval(lobes[1], directions[1]));
  EXPECT_NEAR(values(2, 1), std::exp(9.0 * (0.6 - 1.0)) * std::pow(1.0 - std::pow(0.4 / 0.9, 2), 2), 1e-15);
}

}  // namespace
}  // namespace brdfit
