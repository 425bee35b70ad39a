// Where a fit begins: inside the ranges, off neutral values, the same for the same seed.
#include "fit/starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "brdf/half_diff.h"
#include "brdf/models.h"

namespace brdfit::fit {
namespace {

Parametrisation full_parametrisation(Model model) {
  return make_parametrisation(Material(model),
                              {Tier::kFull, effects_of(model).without(Effect::kAnisotropic), {}});
}

// Observations of a material all over the hemisphere.
SampleSet samples_of(const Material& material) {
  SampleSet samples;
  for (double theta_h = 0.01; theta_h < 1.4; theta_h += 0.1) {
    for (double theta_d = 0.0; theta_d < 1.4; theta_d += 0.1) {
      const HalfDiff angles = {theta_h, theta_d, 1.5};
      const DirectionPair pair = directions_from_half_diff(angles);
      if (pair.wi.z < 0.05 || pair.wo.z < 0.05) continue;
      samples.add(cell_geometry(angles), eval(material, pair.wi, pair.wo), 1.0);
    }
  }
  samples.finish();
  return samples;
}

Material lambert(const Rgb& albedo) {
  Material material;
  material.set("base_color", albedo);
  material.set("specular", 0.0);
  return material;
}

TEST(Starts, AreAsManyAsAskedForAndInsideTheRanges) {
  const SampleSet samples = samples_of(lambert({0.9, 0.5, 0.001}));
  for (const Model model : all_models()) {
    const Parametrisation p = full_parametrisation(model);
    for (const int count : {1, 2, 12, 100}) {
      const auto starts = make_starts(p, samples, count, 7);
      ASSERT_EQ(starts.size(), static_cast<std::size_t>(count));
      for (const auto& x : starts) {
        ASSERT_EQ(x.size(), p.size());
        for (std::size_t k = 0; k < x.size(); ++k) {
          EXPECT_GT(x[k], p.free[k].lower) << p.free[k].name;
          EXPECT_LT(x[k], p.free[k].upper) << p.free[k].name;
        }
      }
    }
  }
}

TEST(Starts, DependOnTheSeedAlone) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  const Parametrisation p = full_parametrisation(Model::kCallisto);
  EXPECT_EQ(make_starts(p, samples, 20, 3), make_starts(p, samples, 20, 3));
  EXPECT_NE(make_starts(p, samples, 20, 3), make_starts(p, samples, 20, 4));
}

TEST(Starts, DifferFromEachOther) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  for (const Model model : all_models()) {
    const auto starts = make_starts(full_parametrisation(model), samples, 64, 1);
    EXPECT_EQ(std::set(starts.begin(), starts.end()).size(), 64U) << name_of(model);
  }
}

// More starts begin with the same ones.
TEST(Starts, AreASequence) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  const Parametrisation p = full_parametrisation(Model::kCallisto);
  const auto few = make_starts(p, samples, 5, 1);
  const auto many = make_starts(p, samples, 50, 1);
  for (std::size_t k = 0; k < few.size(); ++k) EXPECT_EQ(few[k], many[k]);
}

// At neutral intensities a falloff has no gradient; at n_s = 0.5 is a kink.
TEST(Starts, KeepOffNeutralValuesAndKinks) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  const Parametrisation p = full_parametrisation(Model::kCallisto);
  for (const auto& x : make_starts(p, samples, 100, 1)) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      const std::string& name = p.free[k].parameter;
      if (name == "diffuse_fresnel" || name == "retroreflection") {
        EXPECT_GT(std::abs(x[k] - 1), 0.1) << name;
      }
      if (name == "smooth_terminator") {
        EXPECT_GT(std::abs(x[k]), 0.05);
      }
      if (name == "dual_specular_opacity") {
        EXPECT_GT(x[k], 0.05);
      }
      if (name == "specular_fresnel_falloff") {
        EXPECT_GT(std::abs(x[k] - 0.5), 0.01);
      }
    }
  }
}

TEST(Starts, TakeTheBaseColourFromTheData) {
  const Rgb albedo = {0.7, 0.4, 0.1};
  const SampleSet samples = samples_of(lambert(albedo));
  const Parametrisation p = full_parametrisation(Model::kLambertGgx);
  const auto starts = make_starts(p, samples, 3, 1);
  // The first is of a dielectric. Fresnel reflects a little even with specular 0.
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(starts[0][c], albedo[c], 1e-5);
}

TEST(Starts, GiveTheChannelsOfAProductOneSignAndTryBoth) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  const Parametrisation p = full_parametrisation(Model::kCallisto);
  std::set<bool> signs;
  for (const auto& x : make_starts(p, samples, 8, 1)) {
    const bool positive = x[p.one_signed[0]] > 0;
    signs.insert(positive);
    for (const std::size_t k : p.one_signed) EXPECT_EQ(x[k] > 0, positive);
  }
  EXPECT_EQ(signs.size(), 2U);
}

TEST(Starts, SpreadRoughnessFromNarrowToWide) {
  const SampleSet samples = samples_of(lambert({0.5, 0.5, 0.5}));
  const Parametrisation p = full_parametrisation(Model::kLambertGgx);
  double narrowest = 1.0;
  double widest = 0.0;
  for (const auto& x : make_starts(p, samples, 12, 1)) {
    narrowest = std::min(narrowest, x[5]);
    widest = std::max(widest, x[5]);
  }
  EXPECT_LT(narrowest, 0.06);
  EXPECT_GT(widest, 0.6);
}

TEST(Staging, SetsEveryFreeNumberOnceInTheArtistsOrder) {
  for (const Model model : all_models()) {
    const Parametrisation p = full_parametrisation(model);
    std::vector<std::size_t> all;
    for (const auto& stage : staging(p)) {
      EXPECT_FALSE(stage.empty());
      all.insert(all.end(), stage.begin(), stage.end());
    }
    std::ranges::sort(all);
    ASSERT_EQ(all.size(), p.size());
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k], k);
  }
  const Parametrisation p = full_parametrisation(Model::kCallisto);
  const auto stages = staging(p);
  ASSERT_EQ(stages.size(), 5U);
  const auto first_of = [&](std::size_t stage) { return p.free[stages[stage].front()].parameter; };
  EXPECT_EQ(first_of(0), "base_color");
  EXPECT_TRUE(first_of(1).starts_with("dual_specular"));
  EXPECT_TRUE(first_of(2).starts_with("retroreflection"));
  EXPECT_TRUE(first_of(3).starts_with("smooth_terminator"));
  EXPECT_TRUE(first_of(4).find("fresnel") != std::string::npos);
}

TEST(Staging, LeavesEmptyStagesOut) {
  EXPECT_EQ(staging(full_parametrisation(Model::kLambertGgx)).size(), 1U);
}

}  // namespace
}  // namespace brdfit::fit
