// From pictures and a render to the problem of each texel.
#include "bake/texel_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/lobe_data.h"

namespace brdfit::bake {
namespace {

// Two texels under three lights of different colours; everything differs from everything.
struct Scene {
  StackInfo info;
  TexelBlock block;
  BlockRender render;

  Scene() {
    info.width = 2;
    info.height = 1;
    const std::vector<Vec3> directions = bake_data::dome(3);
    for (std::size_t l = 0; l < 3; ++l) {
      StackLight light;
      light.direction = directions[l];
      const auto at = static_cast<double>(l);
      light.intensity = {1.0 + at, 2.0, 0.5 * at};
      info.lights.push_back(light);
    }
    block.texels = {0, 1};
    block.lights = 3;
    for (int k = 0; k < 18; ++k) {
      block.rgb.push_back(0.1F * static_cast<float>(k));
      render.rgb.push_back(0.01F * static_cast<float>(k * k));
    }
    render.shade = {0.9F, 0.8F, 0.7F, 0.6F, 0.0F, 0.4F};
  }
};

TEST(TexelProblem, LuminanceIsThatOfTheChannels) {
  for (const bool with_albedo : {false, true}) {
    Scene scene;
    if (with_albedo) scene.render.albedo = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
    const TexelProblem luminance = luminance_problem(scene.info, scene.block, scene.render);
    const std::array<TexelProblem, 3> channels = rgb_problems(scene.info, scene.block, scene.render);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(luminance.residual[k],
                  0.2126 * channels[0].residual[k] + 0.7152 * channels[1].residual[k] +
                      0.0722 * channels[2].residual[k],
                  1e-6);
      EXPECT_NEAR(luminance.modulation[k],
                  0.2126 * channels[0].modulation[k] + 0.7152 * channels[1].modulation[k] +
                      0.0722 * channels[2].modulation[k],
                  1e-6);
    }
  }
}

TEST(TexelProblem, AChannelIsReferenceMinusRenderUnderIntensityTimesShade) {
  const Scene scene;
  const std::array<TexelProblem, 3> channels = rgb_problems(scene.info, scene.block, scene.render);
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t from = (l * 3 + c) * 2 + i;
        EXPECT_FLOAT_EQ(channels[c].residual[channels[c].at(l, i)],
                        scene.block.rgb[from] - scene.render.rgb[from]);
        EXPECT_FLOAT_EQ(
            channels[c].modulation[channels[c].at(l, i)],
            static_cast<float>(scene.info.lights[l].intensity[c]) * scene.render.shade[l * 2 + i]);
      }
    }
  }
}

TEST(TexelProblem, ValuesThatAreNotFiniteLoseTheirWeight) {
  Scene scene;
  scene.render.rgb[2 * 3 * 1 + 1] = std::numeric_limits<float>::quiet_NaN();  // light 1, red, texel 1
  scene.render.shade[0] = std::numeric_limits<float>::infinity();             // light 0, texel 0
  const TexelProblem problem = luminance_problem(scene.info, scene.block, scene.render);
  for (const float e : problem.residual) EXPECT_TRUE(std::isfinite(e));
  for (const float m : problem.modulation) EXPECT_TRUE(std::isfinite(m));
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t i = 0; i < 2; ++i) {
      const bool broken = (l == 1 && i == 1) || (l == 0 && i == 0);
      EXPECT_EQ(problem.weight_of(l, i), broken ? 0.0F : 1.0F);
    }
  }
}

TEST(TexelProblem, NearLightsBringTheirDirections) {
  Scene scene;
  EXPECT_TRUE(luminance_problem(scene.info, scene.block, scene.render).directions.empty());
  scene.info.lights[1].position = Vec3{0.0, 0.0, 2.0};
  const TexelProblem problem = luminance_problem(scene.info, scene.block, scene.render);
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 expected = incidence(scene.info, l, static_cast<std::uint32_t>(i)).direction;
      const Vec3 d = problem.direction(l, i, {0.0, 0.0, 0.0});
      EXPECT_NEAR(d.x, expected.x, 1e-7);
      EXPECT_NEAR(d.y, expected.y, 1e-7);
      EXPECT_NEAR(d.z, expected.z, 1e-7);
    }
  }
}

TEST(TexelProblem, PartsKeepTheirPlanes) {
  Scene scene;
  scene.info.lights[1].position = Vec3{0.0, 0.0, 2.0};
  scene.block.weight = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  const TexelProblem whole = luminance_problem(scene.info, scene.block, scene.render);
  const std::vector<std::size_t> lights = {2, 0};
  const TexelProblem part = with_lights(whole, lights);
  const std::vector<std::size_t> texels = {1};
  const TexelProblem corner = with_texels(part, texels);
  for (std::size_t l = 0; l < 2; ++l) {
    EXPECT_EQ(part.residual[part.at(l, 1)], whole.residual[whole.at(lights[l], 1)]);
    EXPECT_EQ(corner.modulation[l], whole.modulation[whole.at(lights[l], 1)]);
    EXPECT_EQ(corner.weight_of(l, 0), whole.weight_of(lights[l], 1));
    EXPECT_EQ(corner.direction(l, 0, {}).x, whole.direction(lights[l], 1, {}).x);
    EXPECT_EQ(corner.direction(l, 0, {}).z, whole.direction(lights[l], 1, {}).z);
  }
}

TEST(TexelProblem, ChromaIsRecoveredFromWhatLuminanceExplains) {
  const std::vector<Vec3> directions = bake_data::dome(12);
  std::array<TexelProblem, 3> channels;
  std::vector<float> sums;
  const float scales[3][2] = {{1.5F, 0.2F}, {1.0F, -0.5F}, {0.0F, 2.0F}};
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c] = bake_data::lit_texels(directions, 3, 0.5, c);
    if (sums.empty()) {
      for (std::size_t k = 0; k < channels[c].residual.size(); ++k) {
        sums.push_back(k % 3 == 2 ? 0.0F : 0.1F + 0.01F * static_cast<float>(k));  // none in texel 2
      }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      if (k % 3 < 2) channels[c].residual[k] = scales[c][k % 3] * channels[c].modulation[k] * sums[k];
    }
  }
  const std::vector<float> found = chroma_scales(channels, sums);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(found[c * 3 + i], scales[c][i], 1e-6);
    EXPECT_EQ(found[c * 3 + 2], 1.0F);
  }
}

TEST(TexelProblem, RefusesSizesThatDisagree) {
  const auto refused = [](auto spoil) {
    Scene scene;
    spoil(scene);
    EXPECT_THROW(luminance_problem(scene.info, scene.block, scene.render), std::invalid_argument);
  };
  refused([](Scene& s) { s.render.shade.pop_back(); });
  refused([](Scene& s) { s.render.rgb.pop_back(); });
  refused([](Scene& s) { s.render.albedo = {1.0F}; });
  refused([](Scene& s) { s.block.weight = {1.0F}; });
  refused([](Scene& s) { s.info.lights.pop_back(); });
}

}  // namespace
}  // namespace brdfit::bake
