// The hard cases of docs/stability.md, walked with every scalar type.
#include <gtest/gtest.h>

#include "tests/random_parameters.h"
#include "tests/stability_walk.h"

namespace brdfit::stability {
namespace {

using testing_support::exact_geometry;
using testing_support::Setting;

TEST(Stability, KernelsInDouble) {
  walk_kernel_cases(double_walker());
}

TEST(Stability, KernelsInFloat) {
  walk_kernel_cases(float_walker());
}

TEST(Stability, KernelsInJets) {
  walk_kernel_cases(jet_walker());
}

TEST(Stability, BranchesInDouble) {
  walk_branches(double_walker());
}

TEST(Stability, BranchesInFloat) {
  walk_branches(float_walker());
}

TEST(Stability, BranchesInJets) {
  walk_branches(jet_walker());
}

// Both cosines of exact geometries, in single precision.
kernel::Geometry<float> in_float(const kernel::Geometry<double>& g) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {f(g.wi_x),           f(g.wi_y),  f(g.cos_i), f(g.wo_x),
          f(g.wo_y),           f(g.cos_o), f(g.h_x),   f(g.h_y),
          f(g.cos_h),          f(g.cos_d), f(g.cos_k), f(g.one_minus_cos_h),
          f(g.one_minus_cos_d)};
}

TEST(Stability, ExactGeometriesInDoubleAndFloat) {
  std::size_t values = 0;
  std::size_t cases = 0;
  for (const KernelCase& one : kernel_cases()) {
    SCOPED_TRACE(one.id);
    if (!one.geometries.empty()) ++cases;
    for (const Material& material : one.materials) {
      const std::vector<double> q = product_form(material);
      const std::vector<float> q_float(q.begin(), q.end());
      for (const kernel::Geometry<double>& g : one.geometries) {
        const Setting s = {material.model(), material.options(), material.effects(), g};
        const auto in_double = testing_support::evaluate(s, q);
        const auto single = eval_product(material.model(), material.options(), material.effects(),
                                         q_float.data(), in_float(g));
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_TRUE(std::isfinite(in_double[c]));
          ASSERT_TRUE(std::isfinite(single[c]));
          ASSERT_GE(in_double[c], 0.0);
          ASSERT_NEAR(static_cast<double>(single[c]), in_double[c], 1e-30 + 1e-4 * in_double[c])
              << testing_support::describe(material, {});
        }
        ++values;
      }
    }
  }
  print_walked("double and float", cases, "exact geometries", values);
}

// Which way inside lies for an entry that stands at an end of its range; 0 where it does not.
int side_of(const ProductEntry& entry, Model model, double value) {
  const ParameterInfo& info = *find_parameter(model, entry.parameter);
  const double margin = 3e-5 * std::max(1.0, std::abs(value));
  if (value < info.lower + margin) return 1;
  if (value > info.upper - margin) return -1;
  return 0;
}

// All derivatives are finite; those of one pair in a few are compared with differences.
template <int N>
std::size_t walk_slopes(const Material& material, const std::vector<kernel::Geometry<double>>& geometries,
                        std::size_t first, std::size_t stride) {
  const auto layout = product_layout(material.model());
  const std::vector<double> q = product_form(material);
  std::size_t compared = 0;
  for (std::size_t n = 0; n < geometries.size(); ++n) {
    const Setting s = {material.model(), material.options(), material.effects(), geometries[n]};
    const auto jets = testing_support::jets_of<N>(s, q);
    for (const auto& channel : jets) {
      EXPECT_TRUE(std::isfinite(channel.a));
      for (int k = 0; k < N; ++k) {
        EXPECT_TRUE(std::isfinite(channel.v[k])) << testing_support::describe_slope(s, std::size_t(k));
      }
    }
    if (testing::Test::HasFailure()) return compared;
    if (n % stride != first % stride) continue;
    for (std::size_t k = 0; k < N; ++k) {
      if (is_at_kink(material, layout[k], geometries[n])) continue;
      // Of a diffuse part that is multiplied by two intensities of 256, or of which falloffs leave nothing.
      const double diffuse =
          material.options().diffuse == Diffuse::kProxima ? 1.0 : std::abs(geometries[n].cos_i);
      const double rounding = 1e-13 * diffuse;
      testing_support::expect_slope<N>(s, q, jets, k, side_of(layout[k], material.model(), q[k]), rounding);
      ++compared;
      if (testing::Test::HasFatalFailure()) return compared;
    }
  }
  return compared;
}

std::size_t walk_slopes_of(const Material& material, const std::vector<kernel::Geometry<double>>& geometries,
                           std::size_t first, std::size_t stride) {
  switch (material.model()) {
    case Model::kLambertGgx:
      return walk_slopes<kLambertGgxProductSize>(material, geometries, first, stride);
    case Model::kBurley:
      return walk_slopes<kBurleyProductSize>(material, geometries, first, stride);
    case Model::kCallisto:
      break;
  }
  return walk_slopes<kCallistoProductSize>(material, geometries, first, stride);
}

TEST(Stability, DerivativesAreFiniteAndThoseOfDifferences) {
  constexpr std::size_t kStride = 7;
  std::size_t compared = 0;
  for (const KernelCase& one : kernel_cases()) {
    SCOPED_TRACE(one.id);
    std::vector<kernel::Geometry<double>> geometries = one.geometries;
    for (const auto& pair : one.pairs) geometries.push_back(testing_support::kernel_geometry(pair));
    for (std::size_t m = 0; m < one.materials.size(); ++m) {
      compared += walk_slopes_of(one.materials[m], geometries, m, kStride);
      if (HasFailure()) {
        FAIL() << testing_support::describe(one.materials[m], {});
      }
    }
  }
  print_walked("Jet", kernel_cases().size(), "derivatives", compared);
}

// The slope of a parameter just below and just above, by Jets, against one-sided differences at the kink.
template <int N>
void expect_kink(const KinkCase& one) {
  const auto layout = product_layout(one.material.model());
  const Setting s = {one.material.model(), one.material.options(), one.material.effects(),
                     testing_support::kernel_geometry(one.pair)};
  std::size_t k = 0;
  while (layout[k].parameter != one.parameter) ++k;
  const std::vector<double> q = product_form(one.material);
  double slopes[2];
  for (const int side : {-1, 1}) {
    std::vector<double> beside = q;
    beside[k] += side * 1e-9 * q[k];
    const auto jet = testing_support::jets_of<N>(s, beside)[0];
    const double by_jet = jet.v[static_cast<Eigen::Index>(k)];
    const auto by_difference =
        static_cast<double>(testing_support::difference(s, beside, k, 1e-6 * q[k], side)[0]);
    EXPECT_NEAR(by_jet, by_difference, 1e-7 * std::abs(by_difference) + 1e-10 * jet.a) << "side " << side;
    slopes[side < 0 ? 0 : 1] = by_jet;
  }
  EXPECT_GT(std::abs(slopes[1] - slopes[0]), 1e-2 * std::max(std::abs(slopes[0]), std::abs(slopes[1])));
  // At the kink itself it is one of the two.
  const double at = testing_support::jets_of<N>(s, q)[0].v[static_cast<Eigen::Index>(k)];
  EXPECT_LT(std::min(std::abs(at - slopes[0]), std::abs(at - slopes[1])), 1e-6 * std::abs(at) + 1e-12);
}

TEST(Stability, KinksHaveASlopeOnEitherSide) {
  for (const KinkCase& one : kink_cases()) {
    SCOPED_TRACE(one.id);
    if (one.material.model() == Model::kBurley) {
      expect_kink<kBurleyProductSize>(one);
    } else {
      expect_kink<kCallistoProductSize>(one);
    }
  }
  print_walked("Jet", kink_cases().size(), "kinks", 2 * kink_cases().size());
}

}  // namespace
}  // namespace brdfit::stability
