// Where kernels switch from one formula to another, and where models bend or jump.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/random_parameters.h"
#include "tests/reference_callisto.h"
#include "tests/stability_cases.h"

namespace brdfit::stability {
namespace {

using testing_support::Pair;
using testing_support::pair_at;

constexpr double kPi = std::numbers::pi;

Material plain(Model model, Effects effects = {}) {
  Material material(model);
  material.set_effects(effects);
  material.set("base_color", Rgb{0.6, 0.3, 0.1});
  return material;
}

// One effect of Callisto, its parameters inside their ranges.
Material callisto(Effects effects) {
  Material material = plain(Model::kCallisto, effects);
  material.set("diffuse_fresnel", 4.0);
  material.set("retroreflection", 3.0);
  material.set("smooth_terminator", 0.8);
  material.set("dual_specular_opacity", 0.5);
  return material;
}

// A dielectric whose highlight is dark but for Schlick's rise.
Material without_highlight(Material material) {
  material.set("specular", 0.0);
  return material;
}

const std::vector<double> kSteps = {1e-3, 1e-5, 1e-7, 1e-9};
// Distances from the horizon.
const std::vector<double> kCosines = {1e-9, 1e-15, 1e-24};

Pair normal_pair() {
  return {{0, 0, 1}, {0, 0, 1}};
}

void move_both_cosines(double t, Material&, Pair& pair) {
  pair.wi.z = t;
  pair.wo.z = t;
}

std::vector<BranchCase> continuous_branches() {
  std::vector<BranchCase> cases;
  const Effects retro = Effects().with(Effect::kRetroreflection);
  const Effects powers = retro.with(Effect::kDiffuseFresnel).with(Effect::kSpecularFresnelFalloff);

  const Pair grazing = pair_at(0.6, 0.7, 0.4);
  const kernel::Geometry<double> g = testing_support::kernel_geometry(grazing);
  const double edge = g.cos_i / kernel::callisto_terminator_mask(g);
  cases.push_back({"terminator-edge", callisto(Effects().with(Effect::kSmoothTerminator)), grazing,
                   [edge](double t, Material& m, Pair&) { m.set("smooth_terminator_length", edge + t); },
                   kSteps});
  // Single precision takes logarithms near 1 another way: below 1/4 on a device, below 1/2 on the processor.
  for (const double cosine : {0.25, 0.5, 0.75}) {
    const double angle = std::acos(cosine);
    std::string id = "log-branch-0.00";
    id.replace(id.size() - 2, 2, std::to_string(static_cast<int>(100 * cosine)));
    cases.push_back({id,
                     callisto(powers),
                     {},
                     [angle](double t, Material&, Pair& pair) {
                       pair = pair_at(std::min(angle + t, 1.2), angle + t, kPi / 2);
                     },
                     kSteps,
                     100.0});
    cases.push_back({id + "-of-theta-h",
                     callisto(powers),
                     {},
                     [angle](double t, Material&, Pair& pair) { pair = pair_at(angle + t, 0.3, kPi / 2); },
                     kSteps,
                     100.0});
  }
  // 1 - a power, from its exponent where that is above -1/2 on a device.
  const double exponent = 0.5 / -std::log(1.0 - std::cos(1.0));
  cases.push_back({"power-near-one", callisto(retro), pair_at(1.0, 0.3, kPi / 2),
                   [exponent](double t, Material& m, Pair&) {
                     m.set("retroreflection_tangent_falloff", 1.0);
                     m.set("retroreflection_falloff", 1.0 - (exponent + t) / 10.0);
                   },
                   kSteps});
  cases.push_back({"near-opposite",
                   plain(Model::kLambertGgx),
                   {},
                   [](double t, Material&, Pair& pair) {
                     const double z = 5e-16 * (1.0 + t);
                     pair = {{1, 0, z}, {-1, 0, z}};
                   },
                   kSteps});
  cases.push_back({"tiny-base",
                   callisto(powers),
                   {},
                   [](double t, Material&, Pair& pair) {
                     const double x = std::sqrt(2e-30) * (1.0 + t);
                     pair = {{x, 0, 1}, {x, 0, 1}};
                   },
                   kSteps});
  cases.push_back({"horizon-separable",
                   plain(Model::kLambertGgx),
                   {{1, 0, 0}, {-1, 0, 0}},
                   move_both_cosines,
                   kCosines,
                   1e3});
  Material proxima = plain(Model::kLambertGgx);
  proxima.options().diffuse = Diffuse::kProxima;
  cases.push_back({"proxima-right-angle",
                   proxima,
                   {},
                   [](double t, Material&, Pair& pair) { pair = pair_at(0.3, kPi / 4 + t, 0.5); },
                   kSteps,
                   10.0,
                   0.5});
  cases.push_back({"zero-to-the-zero-by-base",
                   callisto(retro),
                   {},
                   [](double t, Material& m, Pair& pair) {
                     m.set("retroreflection_falloff", 1.0);
                     m.set("retroreflection_tangent_falloff", 1.0);
                     pair = pair_at(std::max(t, 0.0), 0.0, 0.0);
                   },
                   kSteps});
  Material sheen = plain(Model::kBurley, effects_of(Model::kBurley));
  sheen.set("sheen", 1.0);
  sheen.set("sheen_tint", 1.0);
  cases.push_back({"tint-of-grey-to-black", sheen, pair_at(0.3, 1.2, 0.5),
                   [](double t, Material& m, Pair&) { m.set("base_color", std::max(t, 0.0)); }, kSteps});
  return cases;
}

std::vector<BranchCase> jumps() {
  std::vector<BranchCase> cases;
  const Pair retro = {{1, 0, 0}, {1, 0, 0}};
  const Pair mirror = {{1, 0, 0}, {-1, 0, 0}};
  // alpha = 0.25. D = alpha^2 / pi at the horizon, 1 / (pi alpha^2) at the pole; V cos_i is 1 / (4 alpha).
  Material correlated = plain(Model::kLambertGgx);
  correlated.options().masking = Masking::kCorrelated;
  cases.push_back({"horizon-correlated-retro", correlated, retro, move_both_cosines, kCosines, 1e3, 1.0,
                   BranchCase::Limits{0.0, 0.04 * 0.25 / (4 * kPi)}});
  cases.push_back({"horizon-correlated-mirror", correlated, mirror, move_both_cosines, kCosines, 1e3, 1.0,
                   BranchCase::Limits{0.0, 1.0 / (4 * kPi * 0.25 * 0.25 * 0.25)}});
  Material proxima = plain(Model::kLambertGgx);
  proxima.options().diffuse = Diffuse::kProxima;
  cases.push_back({"horizon-proxima", proxima, retro, move_both_cosines, kCosines, 1e3, 1.0,
                   BranchCase::Limits{0.0, 0.6 / kPi * 0.25 * 0.19}});
  Material subsurface = plain(Model::kBurley, Effects().with(Effect::kSubsurface));
  subsurface.set("subsurface", 1.0);
  cases.push_back({"horizon-subsurface", subsurface, retro, move_both_cosines, kCosines, 1e3, 1.0,
                   BranchCase::Limits{0.0, 0.6 / kPi * 1.25 * 0.5 * 0.5 * 0.5}});
  // 0^positive is 0, 0^0 is 1: the retroreflection of 3 acts on all of the diffuse part, or not at all.
  Material power = without_highlight(callisto(Effects().with(Effect::kRetroreflection)));
  power.set("retroreflection_tangent_falloff", 1.0);
  cases.push_back(
      {"zero-to-the-zero-by-exponent",
       power,
       normal_pair(),
       [](double t, Material& m, Pair&) { m.set("retroreflection_falloff", std::min(1.0 + t, 1.0)); },
       {1e-2, 1e-3, 1e-6},
       10.0,
       1.0,
       BranchCase::Limits{0.6 / kPi, 3 * 0.6 / kPi}});
  Material tint = without_highlight(plain(Model::kBurley, Effects().with(Effect::kSheen)));
  tint.set("sheen", 1.0);
  tint.set("sheen_tint", 1.0);
  const Pair pair = pair_at(0.3, 1.2, 0.5);
  const reference::Geometry g = reference::geometry(pair.wi, pair.wo);
  const auto falloff = static_cast<double>(reference::schlick(g));
  const auto lobe = static_cast<double>(reference::burley_specular_d_v(tint, pair.wi, pair.wo, g));
  cases.push_back(
      {"tint-of-red-to-black",
       tint,
       pair,
       [](double t, Material& m, Pair&) {
         m.set("base_color", Rgb{std::max(t, 0.0), 0.0, 0.0});
       },
       {1e-3, 1e-6, 1e-12},
       10.0,
       1.0,
       BranchCase::Limits{pair.wi.z * falloff * (1.0 + lobe), pair.wi.z * falloff * (1.0 / 0.3 + lobe)}});
  return cases;
}

bool near(double a, double b) {
  return std::abs(a - b) < 1e-3 * std::abs(b);
}

}  // namespace

const std::vector<BranchCase>& branch_cases() {
  static const std::vector<BranchCase> all = [] {
    std::vector<BranchCase> cases = continuous_branches();
    for (BranchCase& jump : jumps()) cases.push_back(std::move(jump));
    return cases;
  }();
  return all;
}

const std::vector<KinkCase>& kink_cases() {
  static const std::vector<KinkCase> all = [] {
    const Pair pair = pair_at(0.3, 1.1, 0.5);
    const Pair highlight = pair_at(0.02, 0.5, 0.5, 0.6);
    Material falloff = callisto(Effects().with(Effect::kSpecularFresnelFalloff));
    falloff.set("specular_fresnel_falloff", 0.5);
    Material dual = callisto(Effects().with(Effect::kDualSpecular));
    dual.set("roughness", 0.25);
    dual.set("dual_specular_roughness_scale", 4.0);
    Material stretched = plain(Model::kBurley, Effects().with(Effect::kAnisotropic));
    stretched.options().burley_g = BurleyG::k2017;
    stretched.set("anisotropic", 0.5);
    stretched.set("roughness", std::sqrt(0.001 / std::sqrt(1.0 - 0.9 * 0.5)));
    return std::vector<KinkCase>{
        {"n-s-half-kink", falloff, pair, "specular_fresnel_falloff"},
        {"dual-scale-kink", dual, pair, "dual_specular_roughness_scale"},
        {"dual-roughness-kink", dual, pair, "roughness"},
        {"aspect-roughness-kink", stretched, highlight, "roughness"},
        {"aspect-anisotropic-kink", stretched, highlight, "anisotropic"},
    };
  }();
  return all;
}

namespace {

// Whether a falloff's exponent is 0 where its base is: a jump.
bool is_zero_to_the_zero(const Material& material, std::string_view falloff,
                         const kernel::Geometry<double>& g) {
  const auto is_base_zero = [&]() {
    if (falloff == "diffuse_fresnel_tangent_falloff") return g.cos_h <= BRDF_TINY;
    if (falloff == "retroreflection_tangent_falloff") return g.cos_d <= BRDF_TINY;
    if (falloff == "retroreflection_falloff") return g.one_minus_cos_h <= BRDF_TINY;
    return g.one_minus_cos_d <= BRDF_TINY;
  };
  return falloff.ends_with("falloff") && material.number(falloff) == 1.0 && is_base_zero();
}

}  // namespace

bool is_at_kink(const Material& material, const ProductEntry& entry, const kernel::Geometry<double>& g) {
  if (is_zero_to_the_zero(material, entry.parameter, g)) return true;
  if (entry.parameter == "smooth_terminator_length") {
    // The second derivative jumps at the terminator's edge, which differences must not step over.
    const double edge = material.number(entry.parameter) * kernel::callisto_terminator_mask(g);
    return std::abs(edge - g.cos_i) < 2e-4;
  }
  const double roughness = material.number("roughness");
  const Effects effects = material.effects();
  if (entry.parameter == "specular_fresnel_falloff") return near(material.number(entry.parameter), 0.5);
  if (entry.parameter == "roughness" || entry.parameter == "dual_specular_roughness_scale") {
    if (material.model() == Model::kCallisto && effects.has(Effect::kDualSpecular)) {
      return near(roughness * material.number("dual_specular_roughness_scale"), 1.0);
    }
  }
  if (material.model() != Model::kBurley) return false;
  if (entry.parameter == "base_color") {
    return (effects.has(Effect::kSheen) || effects.has(Effect::kSpecularTint)) &&
           std::ranges::max(material.colour("base_color")) < 1e-3;
  }
  if (entry.parameter == "roughness" || entry.parameter == "anisotropic") {
    const double aspect = std::sqrt(1.0 - 0.9 * material.number("anisotropic"));
    return effects.has(Effect::kAnisotropic) &&
           (near(roughness * roughness * aspect, 0.001) || near(roughness * roughness / aspect, 0.001));
  }
  return false;
}

}  // namespace brdfit::stability
