// The kernels on a Vulkan device against the kernels in double on the processor. The program says on which
// device it ran: where there is no GPU, that is lavapipe, on the processor.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "data/synthetic/random_material.h"
#include "gpu/material_pass.h"
#include "gpu/parity.h"
#include "gpu/parity_pairs.h"
#include "tests/gpu_device.h"
#include "tests/random_parameters.h"

namespace brdfit {
namespace {

using testing_support::Random;

MaterialPass& pass() {
  static auto* const made = new MaterialPass(tests::test_device());
  return *made;
}

std::vector<MaterialOptions> all_options(Model model) {
  std::vector<MaterialOptions> all;
  if (model == Model::kBurley) {
    for (const BurleyG g : {BurleyG::k2012, BurleyG::k2017}) all.push_back({.burley_g = g});
    return all;
  }
  for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
    for (const Diffuse diffuse : {Diffuse::kLambert, Diffuse::kProxima}) {
      all.push_back({.masking = masking, .diffuse = diffuse});
    }
  }
  return all;
}

ParityReport parity_of(const Material& material, std::uint64_t pairs, std::uint64_t seed) {
  return check_parity(
      material,
      [&](std::span<const FloatPair> in, std::span<FloatRgb> out) { pass().eval_cos(material, in, out); },
      {pairs, seed});
}

// The largest shares of what is allowed, over many materials.
struct Worst {
  double device = 0.0;
  double processor = 0.0;
};

void expect_parity(const Material& material, std::uint64_t pairs, std::uint64_t seed, Worst& worst) {
  const ParityReport report = parity_of(material, pairs, seed);
  EXPECT_TRUE(report.passed()) << testing_support::describe(
      material,
      {{report.device.worst.pair.wi[0], report.device.worst.pair.wi[1], report.device.worst.pair.wi[2]},
       {report.device.worst.pair.wo[0], report.device.worst.pair.wo[1], report.device.worst.pair.wo[2]}});
  EXPECT_EQ(report.processor.errors.over(), 0U);
  worst.device = std::max(worst.device, report.device.errors.worst_share());
  worst.processor = std::max(worst.processor, report.processor.errors.worst_share());
}

void print(const char* what, const Worst& worst) {
  std::cout << what << ": the largest error is " << worst.device << " of what is allowed on the device, "
            << worst.processor << " in float on the processor\n";
}

TEST(GpuMaterial, AgreesWithDoubleForRandomMaterialsOfEveryModelAndOption) {
  Worst worst;
  std::uint64_t count = 0;
  for (std::uint64_t round = 0; count < 200; ++round) {
    for (const Model model : all_models()) {
      for (const MaterialOptions& options : all_options(model)) {
        const std::uint64_t seed = ++count;
        Material material = synthetic::random_material(model, Tier::kFull, effects_of(model), options, seed);
        // Down to alpha = 1e-3, and once a round the sharpest that there is.
        const double steps[] = {0.0, 0.0316228, 0.01, 0.1};
        if (const double roughness = steps[round % 4]; roughness > 0.0) material.set("roughness", roughness);
        expect_parity(material, 18000, seed, worst);
      }
    }
  }
  std::cout << count << " materials\n";
  print("random materials", worst);
}

TEST(GpuMaterial, AgreesWithDoubleWithParametersAtTheEndsOfTheirRanges) {
  Worst worst;
  Random random(61);
  for (int round = 0; round < 8; ++round) {
    for (const Model model : all_models()) {
      for (const MaterialOptions& options : all_options(model)) {
        Material material = testing_support::random_material(model, effects_of(model), random);
        material.options() = options;
        expect_parity(material, 9000, 62, worst);
      }
    }
  }
  print("parameters at their ends", worst);
}

TEST(GpuMaterial, AgreesWithDoubleForEveryEffectAlone) {
  Worst worst;
  Random random(63);
  for (const Model model : all_models()) {
    std::vector<Effects> sets = {Effects()};
    for (const Effect effect : all_effects()) {
      if (effects_of(model).has(effect)) sets.push_back(Effects().with(effect));
    }
    for (const Effects effects : sets) {
      expect_parity(testing_support::random_material(model, effects, random), 9000, 64, worst);
    }
  }
  print("effects alone", worst);
}

TEST(GpuMaterial, KeepsOnePipelineForEachEffectSet) {
  MaterialPass fresh(tests::test_device());
  const std::vector<FloatPair> pairs(3);
  std::vector<FloatRgb> out(3);
  Material material(Model::kCallisto);
  fresh.eval_cos(material, pairs, out);
  material.set("roughness", 0.2);
  material.options().burley_g = BurleyG::k2017;  // not an option of Callisto
  fresh.eval_cos(material, pairs, out);
  EXPECT_EQ(fresh.pipeline_count(), 1U);
  material.set_effects(Effects().with(Effect::kDualSpecular));
  fresh.eval_cos(material, pairs, out);
  material.options().masking = Masking::kCorrelated;
  fresh.eval_cos(material, pairs, out);
  EXPECT_EQ(fresh.pipeline_count(), 3U);
}

TEST(GpuMaterial, SplitsBatchesWithoutChangingAnything) {
  std::vector<FloatPair> pairs(10007);
  fill_parity_pairs(5, 0, pairs);
  std::vector<FloatRgb> whole(pairs.size());
  std::vector<FloatRgb> split(pairs.size());
  Random random(65);
  const Material material =
      testing_support::random_material(Model::kCallisto, effects_of(Model::kCallisto), random);
  pass().eval_cos(material, pairs, whole);
  MaterialPassOptions options;
  options.largest_batch = 1000;
  MaterialPass(tests::test_device(), options).eval_cos(material, pairs, split);
  EXPECT_EQ(whole, split);
}

TEST(GpuMaterial, IsDarkBelowTheHorizonAndFiniteEverywhere) {
  std::vector<FloatPair> pairs(9 * 4096);
  fill_parity_pairs(6, 0, pairs);
  std::vector<FloatRgb> out(pairs.size());
  Random random(66);
  for (const Model model : all_models()) {
    pass().eval_cos(testing_support::random_material(model, effects_of(model), random), pairs, out);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      for (const float f : out[k]) {
        ASSERT_TRUE(std::isfinite(f)) << k;
        if (kind_of_parity_pair(k) == PairKind::kBelow) {
          ASSERT_EQ(f, 0.0F) << k;
        }
      }
    }
  }
}

TEST(GpuMaterial, TakesNoPairsAndRefusesSizesThatDiffer) {
  const Material material;
  std::vector<FloatRgb> out;
  EXPECT_EQ(pass().eval_cos(material, {}, out), 0.0);
  const std::vector<FloatPair> pairs(2);
  EXPECT_THROW(pass().eval_cos(material, pairs, out), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit
