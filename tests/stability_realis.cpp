// Sets of lobes that are hard to tell apart, to sample or to store.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bake/code_ranges.h"
#include "bake/lobe_objective.h"
#include "bake/pack.h"
#include "bake/reconstruct.h"
#include "bake/ridge.h"
#include "bake/solve.h"
#include "tests/lobe_data.h"
#include "tests/stability_data.h"
#include "tests/stability_realis.h"
#include "tests/stability_walk.h"

namespace brdfit::stability {
namespace {

using bake::LobeMatrix;
using bake::LobeVector;
using bake::TexelEquations;
using bake::TexelProblem;

const std::vector<Vec3>& directions() {
  static const std::vector<Vec3> lights = bake_data::dome(40);
  return lights;
}

// Texels that odd lobes and noise lit, whatever lobes they are then solved with.
TexelProblem texels() {
  return bake_data::made_of(bake_data::odd_lobes(), directions(), 40, 0.1);
}

// Of every texel, as the packing takes them.
std::vector<TexelEquations> equations_of(const LobeSet& lobes, const TexelProblem& problem, double penalty) {
  const Eigen::MatrixXd basis = bake::lobe_values(lobes, directions());
  std::vector<TexelEquations> all;
  for (std::size_t i = 0; i < problem.texels; ++i) {
    Eigen::VectorXd modulation(basis.rows());
    Eigen::VectorXd residual(basis.rows());
    for (Eigen::Index l = 0; l < basis.rows(); ++l) {
      modulation[l] = problem.modulation[problem.at(static_cast<std::size_t>(l), i)];
      residual[l] = problem.residual[problem.at(static_cast<std::size_t>(l), i)];
    }
    const Eigen::MatrixXd x = modulation.asDiagonal() * basis;
    TexelEquations one = {LobeMatrix(x.transpose() * x), LobeVector(x.transpose() * residual)};
    one.a.diagonal().array() += penalty;
    all.push_back(one);
  }
  return all;
}

// Above the least that there is.
double excess(const TexelEquations& equations, const LobeVector& amplitudes) {
  const LobeVector off = amplitudes - bake::solve(equations);
  return off.dot(equations.a * off);
}

std::size_t values_walked = 0;

void expect_finite_values(const LobeSet& lobes) {
  for (const Lobe& lobe : lobes) {
    values_walked += directions().size();
    for (const Vec3& towards : directions()) {
      const double value = eval(lobe, towards);
      EXPECT_GE(value, 0.0);
      EXPECT_LE(value, 1.0);
    }
    EXPECT_EQ(eval(lobe, lobe.axis), 1.0);
  }
}

// Slopes by the distance from the axis, sharpness and cut-off.
void expect_finite_slopes(const Lobe& lobe) {
  using Jet = ceres::Jet<double, 3>;
  for (const double distance : {0.0, 1e-12, 1e-6, 0.5, 1.0 - lobe.cos_cut_off, 2.0}) {
    const Jet value =
        kernel::windowed_lobe(Jet(distance, 0), Jet(lobe.sharpness, 1), Jet(lobe.cos_cut_off, 2));
    EXPECT_TRUE(std::isfinite(value.a)) << distance;
    EXPECT_TRUE(value.v.allFinite()) << distance;
    const auto f = [](double x) { return static_cast<float>(x); };
    const float single = kernel::windowed_lobe(f(distance), f(lobe.sharpness), f(lobe.cos_cut_off));
    // The sharpness multiplies the rounding of the distance.
    const double rounding = 1e-7 * (1.0 + lobe.sharpness * distance);
    EXPECT_NEAR(static_cast<double>(single), value.a, 4.0 * value.a * rounding + 1e-12) << distance;
  }
}

// Amplitudes with every ridge and instruction set: finite, and never worse than none.
void expect_sound_amplitudes(const LobeSet& lobes) {
  const TexelProblem problem = texels();
  for (const double ridge : {0.0, 1e-6, 0.1}) {
    const bake::LobeSystem system(lobes, directions(), bake::mean_squared_modulation(problem), ridge);
    EXPECT_FALSE(std::isnan(system.condition()));
    for (const simd::Isa isa : simd::available_isas()) {
      bake::SolveOptions options;
      options.isa = isa;
      const bake::SolveResult result = bake::solve(system, problem, options);
      for (const float a : result.amplitudes) ASSERT_TRUE(std::isfinite(a)) << ridge;
      for (std::size_t i = 0; i < problem.texels; ++i) {
        ASSERT_TRUE(std::isfinite(result.error_with[i]));
        if (result.confidence[i] > 0.0F) {
          ASSERT_LT(result.error_with[i], result.error_without[i]);
        }
      }
    }
  }
  const bake::RidgeChoice choice = bake::choose_ridge(lobes, directions(), problem);
  EXPECT_TRUE(std::isfinite(choice.error));
}

// The search's objective and its slopes, where it may start.
void expect_sound_objective(const LobeSet& lobes) {
  const std::vector<bake::ResidualClass> classes = bake::residual_classes(texels(), directions());
  const bake::LobeObjective objective(classes, static_cast<int>(lobes.size()), bake::bounds_of(directions()));
  for (const double ridge : {1e-5, 1.0}) {
    EXPECT_TRUE(std::isfinite(objective.evaluate(lobes, ridge)));
    const std::vector<double> parameters = objective.pack(lobes, ridge);
    std::vector<double> gradient(parameters.size());
    EXPECT_TRUE(std::isfinite(objective.evaluate(parameters, gradient.data())));
    for (const double slope : gradient) EXPECT_TRUE(std::isfinite(slope));
  }
}

// Masks, ranges and codes of few bits: finite, in range, and no worse than no lobes at all.
void expect_sound_codes(const LobeSet& lobes, double penalty) {
  const std::vector<TexelEquations> equations = equations_of(lobes, texels(), penalty);
  const std::uint32_t all = (1U << lobes.size()) - 1U;
  for (const int kept : {1, static_cast<int>(lobes.size())}) {
    std::vector<bake::CodeSearch> searches;
    for (const TexelEquations& one : equations) {
      const std::uint32_t mask = bake::dominant_mask(std::span(&one, 1), kept);
      EXPECT_TRUE(bake::refit(one, mask).allFinite());
      EXPECT_TRUE(bake::refit(one, all).allFinite());
      searches.emplace_back(one, mask);
    }
    for (const int bits : {4, 8}) {
      const bake::Quantiser quantiser = {bits, bake::fitted_ranges(searches, lobes.size(), bits)};
      for (std::size_t i = 0; i < equations.size(); ++i) {
        std::vector<int> codes(lobes.size());
        EXPECT_TRUE(std::isfinite(searches[i].find(
            quantiser, LobeVector(), bake::search_steps(bits, searches[i].lobes().size()), codes)));
        LobeVector decoded(static_cast<Eigen::Index>(lobes.size()));
        for (std::size_t k = 0; k < lobes.size(); ++k) {
          EXPECT_GE(codes[k], quantiser.smallest_code(k));
          EXPECT_LE(codes[k], quantiser.largest_code(k));
          decoded[static_cast<Eigen::Index>(k)] = quantiser.amplitude(k, codes[k]);
        }
        const LobeVector none = LobeVector::Zero(decoded.size());
        EXPECT_LE(excess(equations[i], decoded), excess(equations[i], none) * (1.0 + 1e-9) + 1e-12);
      }
    }
  }
}

void expect_sound(const LobeSet& lobes) {
  expect_finite_values(lobes);
  for (const Lobe& lobe : lobes) expect_finite_slopes(lobe);
  expect_sound_amplitudes(lobes);
  expect_sound_objective(lobes);
  for (const double penalty : {0.0, 1e-6, 0.1}) expect_sound_codes(lobes, penalty);
}

void coinciding() {
  expect_sound(coinciding_lobes());
  const TexelProblem problem = texels();
  const bake::LobeSystem system(coinciding_lobes(), directions(), bake::mean_squared_modulation(problem),
                                0.0);
  EXPECT_GT(system.condition(), 1e12);
}

void blunt() {
  expect_sound(blunt_lobes());
}

void sharp() {
  expect_sound(sharp_lobes());
  // Lights that miss a lobe do not see it: no amplitude, rather than a large one.
  const TexelProblem problem = texels();
  const bake::LobeSystem system({{{0.0, 0.0, -1.0}, 1e6, -1.0}}, directions(),
                                bake::mean_squared_modulation(problem), 0.0);
  for (const float a : bake::solve(system, problem).amplitudes) EXPECT_EQ(a, 0.0F);
}

// What one lobe adds another takes away: small sums of large amplitudes.
void cancelling() {
  LobeSet twins = coinciding_lobes();
  for (std::size_t k = 1; k < twins.size(); k += 2) twins[k].sharpness *= 1.0 + 1e-4;
  expect_sound(twins);
  const RealisAsset asset = cancelling_asset();
  const bake::RunTimeTexels texels = cancelling_texels(asset);
  for (const Vec3& towards : directions()) {
    const bake::Relit relit = bake::relight(asset, texels, {towards, {1.0, 1.0, 1.0}});
    for (std::size_t k = 0; k < relit.corrected.size(); ++k) {
      ASSERT_TRUE(std::isfinite(relit.corrected[k]));
      // What is left of amplitudes of 1000 is the difference of the lobes.
      ASSERT_NEAR(relit.corrected[k], relit.render[k], 1.0);
    }
  }
}

}  // namespace

LobeSet coinciding_lobes() {
  LobeSet lobes;
  for (const Lobe& lobe : bake_data::odd_lobes()) {
    lobes.push_back(lobe);
    lobes.push_back(lobe);
  }
  return lobes;
}

LobeSet blunt_lobes() {
  LobeSet lobes = bake_data::odd_lobes();
  for (Lobe& lobe : lobes) lobe.sharpness = 0.0;
  return lobes;
}

LobeSet sharp_lobes() {
  LobeSet lobes = bake_data::odd_lobes();
  for (std::size_t k = 0; k < lobes.size(); ++k) {
    lobes[k].sharpness = 1e6;
    // One that lights hit, others that they miss.
    if (k == 0) lobes[k].axis = directions().front();
  }
  return lobes;
}

RealisAsset cancelling_asset() {
  RealisAsset asset;
  asset.name = "cancelling";
  asset.width = 8;
  asset.height = 8;
  asset.lobes = {{{0.0, 0.0, 1.0}, 4.0, -1.0}, {{0.0, 0.0, 1.0}, 4.0004, -1.0}};
  asset.packing.bits = 8;
  asset.packing.dominant = 2;
  asset.packing.ranges = {{1000.0 / 127.0, 128}, {1000.0 / 127.0, 128}};
  return asset;
}

// Amplitudes k steps and -k steps.
bake::RunTimeTexels cancelling_texels(const RealisAsset& asset) {
  const std::size_t count = asset.texel_count();
  bake::RunTimeTexels texels;
  texels.surface.normals.assign(3 * count, 0.0F);
  std::fill_n(texels.surface.normals.begin() + static_cast<std::ptrdiff_t>(2 * count), count, 1.0F);
  texels.surface.albedo.assign(3 * count, 0.5F);
  texels.surface.state.assign(count, bake::TexelState::kOk);
  texels.baked = texels.surface;
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t k = 0; k < count; ++k) {
      texels.amplitudes.push_back(static_cast<float>(sign * static_cast<double>(k) * 1000.0 / 127.0));
    }
  }
  return texels;
}

const std::vector<DataCase>& realis_cases() {
  static const std::vector<DataCase> all = {
      {"realis-coinciding-lobes", coinciding},
      {"realis-sharpness-0", blunt},
      {"realis-sharpness-1e6", sharp},
      {"realis-amplitudes-cancel", cancelling},
  };
  return all;
}

namespace {

TEST(Stability, Realis) {
  for (const DataCase& one : realis_cases()) {
    SCOPED_TRACE(one.id);
    one.run();
  }
  print_walked("double, float and Jet", realis_cases().size(), "Realis", values_walked);
}

}  // namespace
}  // namespace brdfit::stability
