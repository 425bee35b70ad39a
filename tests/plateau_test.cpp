// Where the second lobe's scale does not count: fits do not end there where that is worse.
#include "fit/plateau.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "fit/fit.h"
#include "tests/selection_study.h"

namespace brdfit::fit {
namespace {

Parametrisation parametrisation(const FixedValues& fixed = {}) {
  return make_parametrisation(Material(Model::kCallisto),
                              {Tier::kFull, Effects().with(Effect::kDualSpecular), fixed, std::nullopt});
}

std::size_t index_of(const Parametrisation& parametrisation, std::string_view name) {
  const auto found = std::ranges::find(parametrisation.free, name, &FreeParameter::name);
  return static_cast<std::size_t>(found - parametrisation.free.begin());
}

TEST(Plateau, IsLeftForWhereTheScaleCounts) {
  const Parametrisation parameters = parametrisation();
  const std::size_t roughness = index_of(parameters, "roughness");
  const std::size_t scale = index_of(parameters, "dual_specular_roughness_scale");
  for (const double r : {0.07, 0.3, 0.62, 0.8, 0.84}) {
    for (const double s : {1.0, 1.2, 2.0, 16.0}) {
      std::vector<double> x = parameters.from_material(Material(Model::kCallisto));
      x[roughness] = r;
      x[scale] = s;
      std::vector<double> moved = x;
      EXPECT_EQ(leave_plateau(parameters, moved), r * s >= 1.0);
      EXPECT_LT(r * moved[scale], 1.0);
      EXPECT_GE(moved[scale], parameters.free[scale].lower);
      // Nothing else moves.
      moved[scale] = s;
      EXPECT_EQ(moved, x);
    }
  }
}

TEST(Plateau, IsNotLeftWhereRoughnessOrScaleIsFixed) {
  for (const char* name : {"roughness", "dual_specular_roughness_scale"}) {
    const Parametrisation parameters = parametrisation({{name, {1.0}}});
    std::vector<double> x = parameters.from_material(Material(Model::kCallisto));
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = parameters.free[k].upper;
    const std::vector<double> before = x;
    EXPECT_FALSE(leave_plateau(parameters, x));
    EXPECT_EQ(x, before);
  }
}

// The best candidate of the search used to end on the plateau, and its fit with it.
TEST(Plateau, IsNotWhereAFitEndsThatIsBetterElsewhere) {
  std::mt19937_64 random(839);
  Effects effects = Effects().with(Effect::kDualSpecular);
  for (const Group& group : groups_of(Model::kCallisto)) {
    if (!group.refines && (random() >> 63) != 0) effects = effects.with(group.effect);
  }
  const Material truth = synthetic::random_material(Model::kCallisto, Tier::kAdvanced, effects, {}, random());
  const MeasuredTable table = testing_support::noisy_table(truth, 0.01, 62, testing_support::kSmallGrid);
  FitOptions options;
  options.effects = effects;
  options.samples = 4000;
  const FitResult found = fit(table, options);
  options.init = truth;
  EXPECT_LT(found.cost, 1.001 * fit(table, options).cost);
  EXPECT_LT(found.material.number("roughness") * found.material.number("dual_specular_roughness_scale"), 1.0);
}

}  // namespace
}  // namespace brdfit::fit
