// Walks the hard cases with one scalar type, or one device.
#include "tests/stability_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "brdf/models.h"
#include "tests/random_parameters.h"
#include "tests/reference_callisto.h"

namespace brdfit::stability {
namespace {

using testing_support::Pair;

// Through memory: the vectoriser of g++ 12.2 drops the rounding of a conversion to float and back.
double as_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}

Vec3 as_float(const Vec3& w) {
  return {as_float(w.x), as_float(w.y), as_float(w.z)};
}

void round_inputs(Material& material, std::vector<Pair>& pairs) {
  for (double& x : material.values()) x = as_float(x);
  for (Pair& pair : pairs) pair = {as_float(pair.wi), as_float(pair.wo)};
}

template <class Real, class G>
void evaluate_as(const Material& material, std::span<const Pair> pairs, std::span<Rgb> out) {
  const std::vector<double> exact = product_form(material);
  std::vector<Real> q;
  for (const double x : exact) q.push_back(Real(static_cast<G>(x)));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto f = eval_product(material.model(), material.options(), material.effects(), q.data(),
                                testing_support::kernel_geometry<G>(pairs[k]));
    for (std::size_t c = 0; c < 3; ++c) {
      if constexpr (std::is_arithmetic_v<Real>) {
        out[k][c] = static_cast<double>(f[c]);
      } else {
        out[k][c] = f[c].a;
      }
    }
  }
}

// Scalar and vector code must agree; scalar code gives the result.
void evaluate_in_double(const Material& material, std::span<const Pair> pairs, std::span<Rgb> out) {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  for (const Pair& pair : pairs) {
    wi.push_back(pair.wi);
    wo.push_back(pair.wo);
  }
  std::vector<Rgb> vectors(pairs.size());
  eval_cos(material, wi, wo, vectors);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    out[k] = eval_cos(material, wi[k], wo[k]);
    const auto scale = reference::eval_cos(material, wi[k], wo[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(vectors[k][c], out[k][c], 1e-13 * static_cast<double>(scale[c].magnitude))
          << "vector code at " << testing_support::describe(material, pairs[k]);
    }
  }
}

// What a value has to be, and the size of what is added up to give it.
struct Goal {
  double value;
  double magnitude;
};

std::array<Goal, 3> goals_of(const Walker& walker, const Material& material, const Pair& pair) {
  const auto published = reference::eval_cos(material, pair.wi, pair.wo);
  const Rgb in_double = eval_cos(material, pair.wi, pair.wo);
  std::array<Goal, 3> goals;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = walker.is_single ? in_double[c] : static_cast<double>(published[c].value);
    goals[c] = {value, static_cast<double>(published[c].magnitude)};
  }
  // Denormal cosines are on the horizon by definition.
  if (std::min(pair.wi.z, pair.wo.z) <= BRDF_HORIZON) goals = {};
  return goals;
}

void expect_goals(const Walker& walker, const Material& material, const Pair& pair, const Rgb& f) {
  const std::array<Goal, 3> goals = goals_of(walker, material, pair);
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_TRUE(std::isfinite(f[c])) << testing_support::describe(material, pair);
    const double allowed = walker.allowed(material, goals[c].value, goals[c].magnitude);
    ASSERT_NEAR(f[c], goals[c].value, allowed) << testing_support::describe(material, pair);
    // The terminator takes away all but rounding.
    ASSERT_GE(f[c], -allowed) << testing_support::describe(material, pair);
  }
}

// f(wi, wo) = f(wo, wi), without the cosine.
void expect_reciprocal(const Walker& walker, const Material& material, const Pair& pair, const Rgb& there,
                       const Rgb& back) {
  const auto published = reference::eval_cos(material, pair.wi, pair.wo);
  const double ratio = pair.wi.z / pair.wo.z;
  for (std::size_t c = 0; c < 3; ++c) {
    const double allowed =
        2.0 * walker.allowed(material, there[c], static_cast<double>(published[c].magnitude)) +
        2.0 * ratio * walker.allowed(material, back[c], static_cast<double>(published[c].magnitude) / ratio);
    ASSERT_NEAR(there[c], back[c] * ratio, allowed) << testing_support::describe(material, pair);
  }
}

// Returns how many pairs were evaluated.
std::size_t walk(const Walker& walker, const KernelCase& one, Material material) {
  std::vector<Pair> pairs = one.pairs;
  if (walker.is_single) round_inputs(material, pairs);
  std::vector<Pair> swapped;
  for (const Pair& pair : pairs) swapped.push_back({pair.wo, pair.wi});
  std::vector<Rgb> there(pairs.size());
  std::vector<Rgb> back(pairs.size());
  walker.evaluate(material, pairs, there);
  walker.evaluate(material, swapped, back);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    expect_goals(walker, material, pairs[k], there[k]);
    expect_goals(walker, material, swapped[k], back[k]);
    if (one.dark) {
      EXPECT_EQ(there[k], (Rgb{0.0, 0.0, 0.0})) << testing_support::describe(material, pairs[k]);
    } else if (is_reciprocal(material) && std::min(pairs[k].wi.z, pairs[k].wo.z) > BRDF_HORIZON) {
      expect_reciprocal(walker, material, pairs[k], there[k], back[k]);
    }
    if (testing::Test::HasFatalFailure()) break;
  }
  return 2 * pairs.size();
}

Rgb at_step(const Walker& walker, const BranchCase& one, double t) {
  Material material = one.material;
  std::vector<Pair> pair = {one.pair};
  one.move(t, material, pair[0]);
  if (walker.is_single) round_inputs(material, pair);
  std::vector<Rgb> f(1);
  walker.evaluate(material, pair, f);
  expect_goals(walker, material, pair[0], f[0]);
  return f[0];
}

void expect_continuous(const Walker& walker, const BranchCase& one, double step) {
  const Rgb below = at_step(walker, one, -step);
  const Rgb at = at_step(walker, one, 0.0);
  const Rgb above = at_step(walker, one, step);
  // In single precision, at_step has seen that all three are what they are in double.
  const double rounding = walker.is_single ? 3e-5 : 1e-12;
  for (std::size_t c = 0; c < 3; ++c) {
    const double allowed = (one.slope * std::pow(step, one.power) + rounding) * (1.0 + std::abs(at[c]));
    EXPECT_NEAR(below[c], at[c], allowed) << "step " << step;
    EXPECT_NEAR(above[c], at[c], allowed) << "step " << step;
  }
}

void expect_jump(const Walker& walker, const BranchCase& one, double step) {
  const BranchCase::Limits& limits = *one.jump;
  const double rounding = walker.is_single ? 3e-5 : 1e-12;
  const double allowed = (one.slope * step + rounding) * std::max(limits.below, limits.above);
  EXPECT_NEAR(at_step(walker, one, -step)[0], limits.below, allowed) << "step " << step;
  EXPECT_NEAR(at_step(walker, one, step)[0], limits.above, allowed) << "step " << step;
  // A step that shows nothing of the jump would be no test of it.
  EXPECT_LT(3.0 * allowed, std::abs(limits.above - limits.below)) << "step " << step;
}

}  // namespace

void print_walked(std::string_view who, std::size_t cases, std::string_view of, std::size_t values) {
  std::cout << "stability, " << who << ": " << cases << " cases of " << of << " walked, " << values
            << " evaluations\n";
}

Walker double_walker() {
  return {"double", false, evaluate_in_double,
          [](const Material&, double, double magnitude) { return 1e-12 * magnitude; }};
}

Walker float_walker() {
  return {"float", true, evaluate_as<float, float>,
          [](const Material&, double, double magnitude) { return 1e-30 + 1e-5 * magnitude; }};
}

Walker jet_walker() {
  return {"Jet", false, evaluate_as<ceres::Jet<double, 1>, double>,
          [](const Material&, double, double magnitude) { return 1e-12 * magnitude; }};
}

void walk_kernel_cases(const Walker& walker) {
  std::size_t values = 0;
  for (const KernelCase& one : kernel_cases()) {
    SCOPED_TRACE(one.id);
    ASSERT_FALSE(one.materials.empty());
    ASSERT_FALSE(one.pairs.empty());
    for (const Material& material : one.materials) {
      values += walk(walker, one, material);
      if (testing::Test::HasFatalFailure()) break;
    }
  }
  print_walked(walker.name, kernel_cases().size(), "kernels", values);
}

void walk_branches(const Walker& walker) {
  std::size_t values = 0;
  for (const BranchCase& one : branch_cases()) {
    SCOPED_TRACE(one.id);
    for (const double step : one.steps) {
      if (one.jump) {
        expect_jump(walker, one, step);
      } else {
        expect_continuous(walker, one, step);
      }
      values += 3;
    }
  }
  print_walked(walker.name, branch_cases().size(), "branches", values);
}

}  // namespace brdfit::stability
