// Comparing a model with its reference.
#ifndef BRDFIT_TESTS_MODEL_MATCHERS_H_
#define BRDFIT_TESTS_MODEL_MATCHERS_H_

#include <gtest/gtest.h>

#include "brdf/models.h"
#include "tests/random_parameters.h"
#include "tests/reference_callisto.h"

namespace brdfit::testing_support {

// Relative to what is added up to give the value.
inline void expect_close(const Rgb& actual, const std::array<reference::Expected, 3>& expected,
                         double relative, const Material& material, const Pair& pair) {
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_NEAR(actual[c], static_cast<double>(expected[c].value),
                relative * static_cast<double>(expected[c].magnitude))
        << "channel " << c << " of " << describe(material, pair);
  }
}

// Random materials with every subset of the model's effects, at random and adversarial pairs.
inline void expect_equals_reference(Model model, const MaterialOptions& options, double relative) {
  Random random(20240611);
  const std::vector<Pair> pairs = test_pairs(100, random);
  const unsigned subsets = effects_of(model).bits() == 0 ? 1U : 32U;
  for (unsigned index = 0; index < 4 * subsets; ++index) {
    Material material = random_material(model, effect_subset(model, index % subsets), random);
    material.options() = options;
    for (const Pair& pair : pairs) {
      expect_close(eval_cos(material, pair.wi, pair.wo), reference::eval_cos(material, pair.wi, pair.wo),
                   relative, material, pair);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

// f(wi, wo) = f(wo, wi) for random materials with the effects.
inline void expect_reciprocal(Model model, const MaterialOptions& options, Effects effects) {
  Random random(7);
  for (int k = 0; k < 50; ++k) {
    Material material = random_material(model, effects, random);
    material.options() = options;
    ASSERT_TRUE(is_reciprocal(material));
    for (const Pair& pair : random_pairs(100, random)) {
      const Rgb forward = eval(material, pair.wi, pair.wo);
      const Rgb backward = eval(material, pair.wo, pair.wi);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(forward[c], backward[c], 1e-13 * forward[c]) << describe(material, pair);
      }
    }
  }
}

// 0 where a direction is at or below the horizon.
inline void expect_dark_below_horizon(Model model, const MaterialOptions& options) {
  Random random(8);
  const std::vector<Vec3> below = {{1, 0, 0}, {0, -1, 0}, {0.6, 0, -0.8}, {0, 0, -1}, {1, 0, -1e-12}};
  for (int k = 0; k < 20; ++k) {
    Material material = random_material(model, effects_of(model), random);
    material.options() = options;
    for (const Vec3& w : below) {
      for (const Vec3& other : {Vec3{0, 0, 1}, Vec3{-w.x, -w.y, -w.z}, w, random_direction(random)}) {
        if (w.z > 0 && other.z > 0) continue;
        for (const Rgb& f : {eval(material, w, other), eval(material, other, w), eval_cos(material, w, other),
                             eval_cos(material, other, w)}) {
          ASSERT_EQ(f, (Rgb{0, 0, 0})) << describe(material, {w, other});
        }
      }
    }
  }
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_MODEL_MATCHERS_H_
