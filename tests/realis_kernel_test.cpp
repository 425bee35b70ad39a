// Realis at run time: the fade is whole on the surface that was baked and gone on another one.
#include "brdf/kernel/realis.h"

#include <gtest/gtest.h>

namespace brdfit::kernel {
namespace {

TEST(RealisKernel, AmplitudesAreStepsFromZero) {
  EXPECT_EQ(realis_amplitude(255.0, 127.0, 0.25), 32.0);
  EXPECT_EQ(realis_amplitude(0.0, 7.0, 2.0), -14.0);
  EXPECT_EQ(realis_amplitude(7.0, 7.0, 2.0), 0.0);
}

TEST(RealisKernel, NothingFadesWhereTheSurfaceIsAsBaked) {
  EXPECT_EQ(realis_fade(0.0, 1.0, 0.2, 0.9), 1.0);
}

TEST(RealisKernel, FadesSteadilyToNothingWithAlbedoAndWithNormal) {
  double by_albedo = 1.0;
  double by_normal = 1.0;
  for (int step = 1; step <= 10; ++step) {
    const double next_albedo = realis_fade(0.02 * step, 1.0, 0.2, 0.9);
    const double next_normal = realis_fade(0.0, 1.0 - 0.01 * step, 0.2, 0.9);
    EXPECT_LT(next_albedo, by_albedo);
    EXPECT_LT(next_normal, by_normal);
    by_albedo = next_albedo;
    by_normal = next_normal;
  }
  EXPECT_NEAR(by_albedo, 0.0, 1e-12);
  EXPECT_NEAR(by_normal, 0.0, 1e-12);
  EXPECT_EQ(realis_fade(5.0, 1.0, 0.2, 0.9), 0.0);
  EXPECT_EQ(realis_fade(0.0, -1.0, 0.2, 0.9), 0.0);
}

}  // namespace
}  // namespace brdfit::kernel
