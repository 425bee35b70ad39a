// Energy by quadrature, and reciprocity.
#include "tests/stability_energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <numbers>

#include "brdf/albedo.h"
#include "brdf/models.h"
#include "tests/direction_pairs.h"
#include "tests/stability_walk.h"

namespace brdfit::stability {
namespace {

// The quadrature is good to about 1%.
constexpr double kQuadrature = 0.01;

struct Value {
  std::string_view name;
  double value;
};

// For some of the roughnesses that there are.
std::vector<Material> over_roughness(Model model, const MaterialOptions& options, Effects effects,
                                     std::initializer_list<Value> values) {
  std::vector<Material> all;
  for (const double roughness : {0.01, 0.1, 0.3, 0.6, 1.0}) {
    Material material(model);
    material.options() = options;
    material.set_effects(effects);
    material.set("roughness", roughness);
    for (const Value& v : values) material.set(v.name, v.value);
    all.push_back(material);
  }
  return all;
}

constexpr MaterialOptions kSeparable = {.masking = Masking::kSeparable};
constexpr MaterialOptions kCorrelated = {.masking = Masking::kCorrelated};
constexpr MaterialOptions kProxima = {.diffuse = Diffuse::kProxima};
constexpr MaterialOptions kBurley2012 = {.burley_g = BurleyG::k2012};
constexpr MaterialOptions kBurley2017 = {.burley_g = BurleyG::k2017};
const std::initializer_list<Value> kWhiteMetal = {{"base_color", 1.0}, {"metallic", 1.0}};
const std::initializer_list<Value> kBlack = {{"base_color", 0.0}, {"specular", 1.0}};
const std::initializer_list<Value> kWhite = {{"base_color", 1.0}};

std::vector<EnergyCase> promising() {
  const Effects dual = Effects().with(Effect::kDualSpecular);
  const Effects retro = Effects().with(Effect::kRetroreflection).with(Effect::kDiffuseFresnel);
  return {
      {"metal-separable", over_roughness(Model::kLambertGgx, kSeparable, {}, kWhiteMetal), true},
      {"metal-correlated", over_roughness(Model::kLambertGgx, kCorrelated, {}, kWhiteMetal), true},
      {"metal-burley-2012", over_roughness(Model::kBurley, kBurley2012, {}, kWhiteMetal), true},
      {"metal-burley-2017", over_roughness(Model::kBurley, kBurley2017, {}, kWhiteMetal), true},
      {"metal-dual",
       over_roughness(Model::kCallisto, kSeparable, dual,
                      {{"base_color", 1.0},
                       {"metallic", 1.0},
                       {"dual_specular_opacity", 0.5},
                       {"dual_specular_roughness_scale", 4.0}}),
       true},
      {"metal-terminator",
       over_roughness(Model::kCallisto, kSeparable, Effects().with(Effect::kSmoothTerminator),
                      {{"base_color", 1.0}, {"metallic", 1.0}, {"smooth_terminator", 1.0}}),
       true},
      {"black-dielectric", over_roughness(Model::kLambertGgx, kSeparable, {}, kBlack), true},
      {"black-dielectric-correlated", over_roughness(Model::kLambertGgx, kCorrelated, {}, kBlack), true},
      {"black-burley", over_roughness(Model::kBurley, kBurley2012, {}, kBlack), true},
      {"matte-white",
       over_roughness(Model::kCallisto, kSeparable, Effects().with(Effect::kSpecularFresnelFalloff),
                      {{"base_color", 1.0}, {"specular", 0.0}, {"specular_fresnel_falloff", 0.0}}),
       true},
      {"matte-white-intensities-below-1",
       over_roughness(Model::kCallisto, kSeparable, retro.with(Effect::kSpecularFresnelFalloff),
                      {{"base_color", 1.0},
                       {"specular", 0.0},
                       {"specular_fresnel_falloff", 0.0},
                       {"retroreflection", 0.5},
                       {"diffuse_fresnel", 0.0}}),
       true},
  };
}

std::vector<EnergyCase> unbounded() {
  const auto one = [](Effect effect) { return Effects().with(effect); };
  return {
      {"white-plastic", over_roughness(Model::kLambertGgx, kSeparable, {}, kWhite)},
      {"white-plastic-correlated", over_roughness(Model::kLambertGgx, kCorrelated, {}, kWhite)},
      {"white-proxima", over_roughness(Model::kLambertGgx, kProxima, {}, kWhite)},
      {"white-burley", over_roughness(Model::kBurley, kBurley2012, {}, kWhite)},
      {"white-sheen", over_roughness(Model::kBurley, kBurley2012, one(Effect::kSheen),
                                     {{"base_color", 1.0}, {"sheen", 1.0}})},
      {"white-subsurface", over_roughness(Model::kBurley, kBurley2012, one(Effect::kSubsurface),
                                          {{"base_color", 1.0}, {"subsurface", 1.0}})},
      {"black-clearcoat-4", over_roughness(Model::kBurley, kBurley2012, one(Effect::kClearcoat),
                                           {{"base_color", 0.0}, {"clearcoat", 4.0}})},
      {"white-terminator-minus-1",
       over_roughness(Model::kCallisto, kSeparable, one(Effect::kSmoothTerminator),
                      {{"base_color", 1.0}, {"smooth_terminator", -1.0}})},
      {"retroreflection-256", over_roughness(Model::kCallisto, kSeparable, one(Effect::kRetroreflection),
                                             {{"base_color", 1.0}, {"retroreflection", 256.0}})},
      {"diffuse-fresnel-256", over_roughness(Model::kCallisto, kSeparable, one(Effect::kDiffuseFresnel),
                                             {{"base_color", 1.0}, {"diffuse_fresnel", 256.0}})},
  };
}

}  // namespace

const std::vector<EnergyCase>& energy_cases() {
  static const std::vector<EnergyCase> all = [] {
    std::vector<EnergyCase> cases = promising();
    for (EnergyCase& one : unbounded()) cases.push_back(std::move(one));
    return cases;
  }();
  return all;
}

std::array<double, kEnergyAnglesDeg.size()> albedos_of(const EnergyCase& one) {
  std::array<double, kEnergyAnglesDeg.size()> largest = {};
  for (std::size_t k = 0; k < largest.size(); ++k) {
    for (const Material& material : one.materials) {
      const Rgb albedo = directional_albedo(material, kEnergyAnglesDeg[k] * std::numbers::pi / 180.0);
      largest[k] = std::max(largest[k], std::ranges::max(albedo));
    }
  }
  return largest;
}

namespace {

TEST(Stability, EnergyIsBoundedWhereItIsPromised) {
  for (const EnergyCase& one : energy_cases()) {
    SCOPED_TRACE(one.id);
    std::cout << std::fixed << std::setprecision(2) << std::setw(34) << one.id;
    for (const double albedo : albedos_of(one)) {
      std::cout << std::setw(8) << albedo;
      EXPECT_TRUE(std::isfinite(albedo));
      if (one.promises) {
        EXPECT_LE(albedo, 1.0 + kQuadrature);
      }
    }
    std::cout << (one.promises ? "   at most 1" : "") << "\n";
  }
  print_walked("double", energy_cases().size(), "energy", energy_cases().size() * kEnergyAnglesDeg.size());
}

// Those that break reciprocity do so by more than rounding: what is_reciprocal() says is needed.
TEST(Stability, ReciprocityIsBrokenWhereItIsSaidToBe) {
  const testing_support::Pair pair = testing_support::pair_at(0.6, 0.7, 0.2);
  std::size_t broken = 0;
  for (const Model model : all_models()) {
    Material material(model);
    EXPECT_TRUE(is_reciprocal(material));
    if (model == Model::kBurley) continue;
    material.options().diffuse = Diffuse::kProxima;
    EXPECT_FALSE(is_reciprocal(material));
    EXPECT_GT(std::abs(eval(material, pair.wi, pair.wo)[0] - eval(material, pair.wo, pair.wi)[0]), 1e-3);
    ++broken;
  }
  for (const double strength : {-1.0, 0.5, 1.0}) {
    Material material(Model::kCallisto);
    material.set_effects(Effects().with(Effect::kSmoothTerminator));
    material.set("smooth_terminator", strength);
    EXPECT_FALSE(is_reciprocal(material));
    EXPECT_GT(std::abs(eval(material, pair.wi, pair.wo)[0] - eval(material, pair.wo, pair.wi)[0]), 1e-3);
    ++broken;
  }
  print_walked("double", broken, "broken reciprocity", 2 * broken);
}

}  // namespace
}  // namespace brdfit::stability
