// The hard cases of the kernels, one line each.
#include "tests/stability_cases.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "tests/random_parameters.h"

namespace brdfit::stability {
namespace {

using testing_support::direction;
using testing_support::exact_geometry;
using testing_support::Pair;
using testing_support::pair_at;
using testing_support::Random;

using Materials = std::vector<Material>;
using Pairs = std::vector<Pair>;
using Geometries = std::vector<kernel::Geometry<double>>;

constexpr double kRight = std::numbers::pi / 2;

std::vector<MaterialOptions> options_of(Model model) {
  if (model == Model::kBurley) return {{.burley_g = BurleyG::k2012}, {.burley_g = BurleyG::k2017}};
  std::vector<MaterialOptions> all;
  for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
    for (const Diffuse diffuse : {Diffuse::kLambert, Diffuse::kProxima}) {
      all.push_back({.masking = masking, .diffuse = diffuse});
    }
  }
  return all;
}

// Every model with every option and all of its effects, parameters inside their ranges.
Materials all_materials() {
  Random random(71);
  Materials all;
  for (const Model model : all_models()) {
    for (const MaterialOptions& options : options_of(model)) {
      Material material = testing_support::interior_material(model, effects_of(model), random);
      material.options() = options;
      all.push_back(material);
    }
  }
  return all;
}

struct Value {
  std::string_view name;
  double value;
};

// The materials whose model has all of the parameters, set to the values.
Materials with(const Materials& materials, std::initializer_list<Value> values) {
  Materials result;
  for (Material material : materials) {
    const bool has_all = std::ranges::all_of(
        values, [&](const Value& v) { return find_parameter(material.model(), v.name) != nullptr; });
    if (!has_all) continue;
    for (const Value& v : values) material.set(v.name, v.value);
    result.push_back(std::move(material));
  }
  return result;
}

Materials with(std::initializer_list<Value> values) {
  return with(all_materials(), values);
}

Materials operator+(Materials a, const Materials& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Pairs operator+(Pairs a, const Pairs& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Unit to the last digits, of the cosine exactly.
Vec3 at_cosine(double cosine, double phi) {
  const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

Pairs above_horizon(Pairs pairs) {
  std::erase_if(pairs, [](const Pair& pair) { return !(pair.wi.z > 0.0 && pair.wo.z > 0.0); });
  return pairs;
}

Pairs at_angles(std::initializer_list<double> theta_h, std::initializer_list<double> theta_d) {
  Pairs pairs;
  for (const double h : theta_h) {
    for (const double d : theta_d) {
      for (const double phi_d : {0.0, 0.7, kRight, 2.6}) pairs.push_back(pair_at(h, d, phi_d, 0.4));
    }
  }
  return above_horizon(std::move(pairs));
}

// Where nothing about the directions is special, and where they are: what a hard parameter meets.
Pairs ordinary_pairs() {
  return at_angles({0.0, 0.02, 0.6, 1.3}, {0.0, 0.3, 0.9, 1.5}) +
         Pairs{{at_cosine(1e-4, 0.0), at_cosine(0.5, 2.0)}, {at_cosine(0.5, 0.0), at_cosine(1e-4, 3.0)}};
}

Pairs with_cosines(std::initializer_list<double> cos_i, std::initializer_list<double> cos_o) {
  Pairs pairs;
  for (const double i : cos_i) {
    for (const double o : cos_o) {
      for (const double phi : {0.0, 1.0, kRight, 3.0, std::numbers::pi}) {
        pairs.push_back({at_cosine(i, 0.2), at_cosine(o, 0.2 + phi)});
      }
    }
  }
  return pairs;
}

// cos_h and cos_d at their ends, and between.
Geometries at_ends(std::initializer_list<double> cos_h, std::initializer_list<double> cos_d) {
  Geometries geometries;
  for (const double h : cos_h) {
    for (const double d : cos_d) {
      for (const double cosine : {1e-12, 0.3, 1.0})
        geometries.push_back(exact_geometry(h, d, cosine, cosine));
    }
  }
  return geometries;
}

// Directions at which a base of a falloff is 0, or nearly: theta_d and theta_h at 0 and 90 deg.
Pairs vanishing_bases() {
  return Pairs{{{0, 0, 1}, {0, 0, 1}}} + at_angles({0.0, 1e-8, 0.5, 1.5}, {0.0, 1e-8, 0.5, 1.5}) +
         Pairs{{at_cosine(1e-12, 0.0), at_cosine(1e-12, std::numbers::pi)},
               {at_cosine(1e-12, 0.5), at_cosine(1e-12, 0.5)}};
}

Geometries vanishing_base_geometries() {
  return at_ends({0.0, 0.5, 1.0}, {0.0, 0.5, 1.0});
}

void add_directions(std::vector<KernelCase>& cases) {
  const Materials all = all_materials();
  const std::initializer_list<double> some = {1e-3, 0.4, 1.0};
  const std::initializer_list<double> any = {0.0, -0.0, 1e-12, 0.4, 1.0};
  cases.push_back({"cos-i-tiny", all, with_cosines({1e-12}, some)});
  cases.push_back({"cos-o-tiny", all, with_cosines(some, {1e-12})});
  cases.push_back({"both-cosines-tiny", all, with_cosines({1e-12, 3e-9}, {1e-12, 7e-7})});
  cases.push_back({"cos-i-zero", all, with_cosines({0.0, -0.0, -1e-12}, any), {}, true});
  cases.push_back({"cos-o-zero", all, with_cosines(any, {0.0, -0.0, -1e-12}), {}, true});
  cases.push_back({"theta-h-0", all, at_angles({0.0}, {0.0, 1e-8, 1e-3, 0.4, 0.9, 1.5}),
                   at_ends({1.0}, {0.0, 0.5, 1.0})});
  cases.push_back({"theta-h-90", all,
                   at_angles({kRight - 1e-12, kRight - 1e-4}, {0.0, 1e-8, 1e-3, 0.4, 0.9, 1.5}) +
                       with_cosines({1e-12}, {1e-12}),
                   at_ends({0.0}, {0.0, 0.5, 1.0})});
  cases.push_back({"theta-d-0", all, at_angles({0.0, 1e-8, 1e-3, 0.4, 0.9, 1.5, kRight - 1e-9}, {0.0}),
                   at_ends({0.0, 0.5, 1.0}, {1.0})});
  cases.push_back({"theta-d-90", all,
                   at_angles({0.0, 1e-8, 1e-3, 0.4}, {kRight - 1e-12, kRight - 1e-4}) +
                       Pairs{{at_cosine(1e-12, 0.0), at_cosine(1e-12, std::numbers::pi)},
                             {at_cosine(1e-12, 0.0), at_cosine(3e-12, std::numbers::pi)}},
                   at_ends({0.0, 0.5, 1.0}, {0.0})});
  Pairs same;
  for (const double cosine : {1.0, 0.999999, 0.5, 1e-3, 1e-12}) {
    same.push_back({at_cosine(cosine, 0.3), at_cosine(cosine, 0.3)});
  }
  cases.push_back({"wi-equals-wo", all, same});
  Pairs opposite;
  for (const double cosine : {1.0, 0.5, 1e-3, 1e-12, 0.0}) {
    const Vec3 w = at_cosine(cosine, 0.3);
    opposite.push_back({w, {-w.x, -w.y, -w.z}});
    opposite.push_back({{-w.x, -w.y, -w.z}, w});
  }
  cases.push_back({"wi-opposite-wo", all, opposite, {}, true});
  // |wi + wo| from what vanishes when squared to what does not.
  Pairs undefined;
  for (const double cosine : {1e-6, 1e-9, 3e-16, 1e-18, 1e-22, 1e-30, 1e-36}) {
    undefined.push_back({{1, 0, cosine}, {-1, 0, cosine}});
    undefined.push_back({{0.6, 0.8, cosine}, {-0.6, -0.8, 2 * cosine}});
  }
  cases.push_back({"half-vector-undefined", all, undefined});
  Pairs denormal;
  for (const double cosine : {1.1e-38, 1e-40, 1e-45, 1e-310, 5e-324}) {
    for (const double other : {cosine, 0.5}) {
      denormal.push_back({{1, 0, cosine}, at_cosine(other, 0.0)});
      denormal.push_back({at_cosine(other, 2.0), {0, -1, cosine}});
    }
  }
  cases.push_back({"denormal-cosines", all, denormal, {}, true});
  cases.push_back({"right-angles", all,
                   at_angles({0.0, 0.2, 0.7}, {kRight / 2, kRight / 2 - 1e-4, kRight / 2 + 1e-4}) +
                       Pairs{{{0.6, 0, 0.8}, {-0.8, 0, 0.6}}, {{0, 0, 1}, at_cosine(1e-4, 0.0)}}});
}

// Every parameter of a model at both of its ends, by the names of the cases.
void add_ends(std::vector<KernelCase>& cases) {
  const Pairs pairs = ordinary_pairs();
  const auto add = [&](const char* id, const Materials& materials) {
    cases.push_back({id, materials, pairs, {}});
  };
  const Materials sharpest = with({{"roughness", 0.01}});
  Pairs highlight = ordinary_pairs();
  for (const double theta_h : {1e-6, 1e-5, 1e-4, 1e-3})
    highlight = highlight + at_angles({theta_h}, {0.3, 1.2});
  cases.push_back({"alpha-smallest", sharpest, highlight});
  add("alpha-largest", with({{"roughness", 1.0}}));
  cases.push_back({"alpha-between",
                   with({{"roughness", 0.0178}}) + with({{"roughness", 0.0316}}) +
                       with({{"roughness", 0.1}}) + with({{"roughness", 0.316}}) + with({{"roughness", 0.7}}),
                   highlight});
  add("dual-scale-clamps", with({{"roughness", 0.3}, {"dual_specular_roughness_scale", 16.0}}) +
                               with({{"roughness", 1.0}, {"dual_specular_roughness_scale", 1.5}}) +
                               with({{"roughness", 0.25}, {"dual_specular_roughness_scale", 4.0}}));
  add("dual-scale-1", with({{"dual_specular_roughness_scale", 1.0}}));
  add("dual-opacity-0", with({{"dual_specular_opacity", 0.0}}));
  cases.push_back({"dual-opacity-1",
                   with({{"dual_specular_opacity", 1.0}}) + with({{"dual_specular_opacity", 1.0},
                                                                  {"roughness", 0.01},
                                                                  {"dual_specular_roughness_scale", 16.0}}),
                   highlight});
  add("f0-0", with({{"specular", 0.0}, {"metallic", 0.0}}) + with({{"base_color", 0.0}, {"metallic", 1.0}}));
  add("f0-1", with({{"base_color", 1.0}, {"metallic", 1.0}}));
  add("base-black", with({{"base_color", 0.0}}));
  add("base-white", with({{"base_color", 1.0}}));
  add("metallic-0", with({{"metallic", 0.0}}));
  add("metallic-1", with({{"metallic", 1.0}}));
  add("intensities-0", with({{"diffuse_fresnel", 0.0}, {"retroreflection", 0.0}}) +
                           with({{"diffuse_fresnel_tint", 0.0}, {"retroreflection_tint", 0.0}}));
  add("intensities-256",
      with({{"diffuse_fresnel", 256.0}, {"retroreflection", 256.0}}) + with({{"diffuse_fresnel", 256.0},
                                                                             {"retroreflection", 256.0},
                                                                             {"diffuse_fresnel_tint", 1.0},
                                                                             {"retroreflection_tint", 1.0},
                                                                             {"base_color", 1.0},
                                                                             {"metallic", 0.0}}));
  add("denormal-parameters",
      with({{"base_color", 1e-310}}) + with({{"base_color", 1e-40}}) + with({{"base_color", 1e-32}}) +
          with({{"specular", 1e-310}, {"metallic", 1e-40}}) +
          with({{"diffuse_fresnel", 1e-310}, {"retroreflection", 1e-40}}) +
          with({{"diffuse_fresnel_falloff", 1e-310}, {"retroreflection_falloff", 1e-40}}) +
          with({{"smooth_terminator", 1e-40}, {"smooth_terminator_length", 1e-40}}) +
          with({{"smooth_terminator_length", 1e-310}}) + with({{"specular_fresnel_falloff", 1e-40}}) +
          with({{"dual_specular_opacity", 1e-310}}) + with({{"sheen", 1e-40}, {"clearcoat", 1e-310}}));
  add("subsurface-ends", with({{"subsurface", 0.0}}) + with({{"subsurface", 1.0}}));
  add("specular-tint-ends", with({{"specular_tint", 0.0}}) + with({{"specular_tint", 1.0}}));
  add("anisotropic-ends", with({{"anisotropic", 0.0}}) + with({{"anisotropic", 1.0}}) +
                              with({{"anisotropic", 0.0}, {"roughness", 0.01}}) +
                              with({{"anisotropic", 1.0}, {"roughness", 0.01}}));
  add("sheen-ends", with({{"sheen", 0.0}}) + with({{"sheen", 1.0}, {"sheen_tint", 0.0}}) +
                        with({{"sheen", 1.0}, {"sheen_tint", 1.0}}));
  cases.push_back({"clearcoat-ends",
                   with({{"clearcoat", 0.0}}) + with({{"clearcoat", 4.0}, {"clearcoat_gloss", 0.0}}) +
                       with({{"clearcoat", 4.0}, {"clearcoat_gloss", 1.0}}),
                   highlight});
}

void add_falloffs(std::vector<KernelCase>& cases) {
  const auto add = [&](std::string id, std::string_view name, double value) {
    cases.push_back({std::move(id), with({{name, value}}), ordinary_pairs() + vanishing_bases(),
                     vanishing_base_geometries()});
  };
  add("n-s-0", "specular_fresnel_falloff", 0.0);
  add("n-s-half", "specular_fresnel_falloff", 0.5);
  add("n-s-1", "specular_fresnel_falloff", 1.0);
  add("diffuse-fresnel-falloff-0", "diffuse_fresnel_falloff", 0.0);
  add("diffuse-fresnel-falloff-1", "diffuse_fresnel_falloff", 1.0);
  add("diffuse-fresnel-tangent-falloff-0", "diffuse_fresnel_tangent_falloff", 0.0);
  add("diffuse-fresnel-tangent-falloff-1", "diffuse_fresnel_tangent_falloff", 1.0);
  add("retroreflection-falloff-0", "retroreflection_falloff", 0.0);
  add("retroreflection-falloff-1", "retroreflection_falloff", 1.0);
  add("retroreflection-tangent-falloff-0", "retroreflection_tangent_falloff", 0.0);
  add("retroreflection-tangent-falloff-1", "retroreflection_tangent_falloff", 1.0);
  const Materials zero_exponents = with({{"specular_fresnel_falloff", 1.0},
                                         {"diffuse_fresnel_falloff", 1.0},
                                         {"diffuse_fresnel_tangent_falloff", 1.0},
                                         {"retroreflection_falloff", 1.0},
                                         {"retroreflection_tangent_falloff", 1.0}});
  cases.push_back({"zero-to-the-zero", zero_exponents, vanishing_bases(), vanishing_base_geometries()});
}

void add_terminators(std::vector<KernelCase>& cases) {
  const auto add = [&](const char* id, std::initializer_list<double> strengths, double length) {
    Materials materials;
    for (const double strength : strengths) {
      materials = materials + with({{"smooth_terminator", strength}, {"smooth_terminator_length", length}});
    }
    cases.push_back({id, materials, ordinary_pairs() + with_cosines({1e-12, 1e-3, 0.2}, {0.3, 1.0}),
                     vanishing_base_geometries()});
  };
  add("terminator-minus-1", {-1.0}, 0.5);
  add("terminator-1", {1.0}, 0.5);
  add("terminator-length-0", {-1.0, 1.0}, 0.0);
  add("terminator-length-1", {-1.0, 1.0}, 1.0);
}

// Every parameter at one of its ends, many choices of ends.
void add_corners(std::vector<KernelCase>& cases) {
  Random random(72);
  Materials corners;
  for (int repeat = 0; repeat < 12; ++repeat) {
    for (Material material : all_materials()) {
      for (const ParameterInfo& info : parameters_of(material.model())) {
        for (int c = 0; c < info.components; ++c) {
          material.values()[static_cast<std::size_t>(info.offset + c)] =
              random() % 2 == 0 ? info.lower : info.upper;
        }
      }
      corners.push_back(material);
    }
  }
  cases.push_back({"corners", corners, vanishing_bases(), vanishing_base_geometries()});
}

}  // namespace

const std::vector<KernelCase>& kernel_cases() {
  static const std::vector<KernelCase> all = [] {
    std::vector<KernelCase> cases;
    add_directions(cases);
    add_ends(cases);
    add_falloffs(cases);
    add_terminators(cases);
    add_corners(cases);
    return cases;
  }();
  return all;
}

}  // namespace brdfit::stability
