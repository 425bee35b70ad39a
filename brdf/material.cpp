// The parameter tables of the models, and the material that they describe.
#include "brdf/material.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace brdfit {
namespace {

using enum Effect;
using enum Kind;

// Offsets count components; check_offsets() below holds the tables to that at compile time.
// The metallic workflow that the models share.
constexpr std::array kLambertGgxTable = {
    ParameterInfo{"base_color", 3, 0, 1, 0.18, Tier::kBase, kNone, kColour, "", "colour at normal incidence",
                  0},
    ParameterInfo{"metallic", 1, 0, 1, 0, Tier::kBase, kNone, kNumber, "", "0 dielectric, 1 metal", 3},
    ParameterInfo{"specular", 1, 0, 1, 0.5, Tier::kBase, kNone, kNumber, "", "f0 = 0.08 specular", 4},
    ParameterInfo{"roughness", 1, 0.01, 1, 0.5, Tier::kBase, kNone, kNumber, "", "alpha = roughness^2", 5},
};

// The shared parameters, then a model's own.
template <std::size_t N>
constexpr auto after_shared(const std::array<ParameterInfo, N>& own) {
  std::array<ParameterInfo, kLambertGgxTable.size() + N> table{};
  std::copy(kLambertGgxTable.begin(), kLambertGgxTable.end(), table.begin());
  std::copy(own.begin(), own.end(), table.begin() + kLambertGgxTable.size());
  return table;
}

constexpr auto kBurleyTable = after_shared(std::array{
    ParameterInfo{"subsurface", 1, 0, 1, 0, Tier::kBase, kSubsurface, kNumber, "",
                  "blend from diffuse to Hanrahan-Krueger", 6},
    ParameterInfo{"specular_tint", 1, 0, 1, 0, Tier::kBase, kSpecularTint, kNumber, "",
                  "tints f0 towards the base colour", 7},
    ParameterInfo{"anisotropic", 1, 0, 1, 0, Tier::kBase, kAnisotropic, kNumber, "",
                  "stretch of the highlight; fixed at 0 for isotropic data", 8},
    ParameterInfo{"sheen", 1, 0, 1, 0, Tier::kBase, kSheen, kNumber, "", "grazing component of cloth", 9},
    ParameterInfo{"sheen_tint", 1, 0, 1, 0.5, Tier::kBase, kSheen, kNumber, "",
                  "tints sheen towards the base colour", 10},
    ParameterInfo{"clearcoat", 1, 0, 4, 0, Tier::kBase, kClearcoat, kNumber, "",
                  "strength of a second, white lobe", 11},
    ParameterInfo{"clearcoat_gloss", 1, 0, 1, 1, Tier::kBase, kClearcoat, kNumber, "", "0 satin, 1 gloss",
                  12},
});

constexpr auto kCallistoTable = after_shared(std::array{
    ParameterInfo{"diffuse_fresnel", 1, 0, 256, 1, Tier::kBase, kDiffuseFresnel, kIntensity,
                  "diffuse_fresnel_tint", "diffuse gain at grazing difference angles", 6},
    ParameterInfo{"diffuse_fresnel_falloff", 1, 0, 1, 0.75, Tier::kBase, kDiffuseFresnel, kNumber, "",
                  "how early the gain sets in", 7},
    ParameterInfo{"diffuse_fresnel_tint", 3, 0, 1, 1, Tier::kAdvanced, kDiffuseFresnel, kTint,
                  "diffuse_fresnel", "colour of the gain", 8},
    ParameterInfo{"diffuse_fresnel_tangent_falloff", 1, 0, 1, 0.75, Tier::kFull, kDiffuseFresnel, kNumber, "",
                  "how wide the gain is in theta_h", 11},
    ParameterInfo{"retroreflection", 1, 0, 256, 1, Tier::kBase, kRetroreflection, kIntensity,
                  "retroreflection_tint", "diffuse gain at grazing half angles", 12},
    ParameterInfo{"retroreflection_falloff", 1, 0, 1, 0.75, Tier::kBase, kRetroreflection, kNumber, "",
                  "how early the gain sets in", 13},
    ParameterInfo{"retroreflection_tint", 3, 0, 1, 1, Tier::kAdvanced, kRetroreflection, kTint,
                  "retroreflection", "colour of the gain", 14},
    ParameterInfo{"retroreflection_tangent_falloff", 1, 0, 1, 0.75, Tier::kFull, kRetroreflection, kNumber,
                  "", "how wide the gain is in theta_d", 17},
    ParameterInfo{"smooth_terminator", 1, -1, 1, 0, Tier::kBase, kSmoothTerminator, kIntensity,
                  "smooth_terminator_tint", "softens (> 0) or hardens (< 0) the terminator", 18},
    ParameterInfo{"smooth_terminator_tint", 3, 0, 1, 1, Tier::kAdvanced, kSmoothTerminator, kTint,
                  "smooth_terminator", "colour of the softening", 19},
    ParameterInfo{"smooth_terminator_length", 1, 0, 1, 0.5, Tier::kFull, kSmoothTerminator, kNumber, "",
                  "largest cos_i that it reaches", 22},
    ParameterInfo{"specular_fresnel_falloff", 1, 0, 1, 0.5, Tier::kAdvanced, kSpecularFresnelFalloff, kNumber,
                  "", "0 none, 0.5 Schlick, 1 white", 23},
    ParameterInfo{"dual_specular_roughness_scale", 1, 1, 16, 2, Tier::kAdvanced, kDualSpecular, kNumber, "",
                  "roughness of the second lobe over that of the first", 24},
    ParameterInfo{"dual_specular_opacity", 1, 0, 1, 0, Tier::kAdvanced, kDualSpecular, kNumber, "",
                  "blend towards the second lobe", 25},
});

template <class Table>
constexpr bool offsets_count_components(const Table& table) {
  int next = 0;
  for (const ParameterInfo& info : table) {
    if (info.offset != next) return false;
    next += info.components;
  }
  return true;
}
static_assert(offsets_count_components(kLambertGgxTable));
static_assert(offsets_count_components(kBurleyTable));
static_assert(offsets_count_components(kCallistoTable));

constexpr std::array kModels = {Model::kLambertGgx, Model::kBurley, Model::kCallisto};

// Finds the enumerator whose name_of is the given name.
template <class Enum, std::size_t N>
std::optional<Enum> by_name(const std::array<Enum, N>& candidates, std::string_view name) {
  for (const Enum candidate : candidates) {
    if (name_of(candidate) == name) return candidate;
  }
  return std::nullopt;
}

// The fewest digits that read back as the same number.
std::string shortest(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

const ParameterInfo& require_parameter(Model model, std::string_view name) {
  const ParameterInfo* info = find_parameter(model, name);
  if (info == nullptr) {
    throw std::invalid_argument(std::string(title_of(model)) + " has no parameter \"" + std::string(name) +
                                "\"");
  }
  return *info;
}

}  // namespace

std::string_view name_of(Model model) {
  switch (model) {
    case Model::kLambertGgx:
      return "lambert-ggx";
    case Model::kBurley:
      return "burley";
    case Model::kCallisto:
      return "callisto";
  }
  return "";
}

std::string_view title_of(Model model) {
  switch (model) {
    case Model::kLambertGgx:
      return "Lambert + GGX";
    case Model::kBurley:
      return "Burley";
    case Model::kCallisto:
      return "Callisto";
  }
  return "";
}

std::string_view name_of(Tier tier) {
  switch (tier) {
    case Tier::kBase:
      return "base";
    case Tier::kAdvanced:
      return "advanced";
    case Tier::kFull:
      return "full";
  }
  return "";
}

std::string_view name_of(Masking masking) {
  return masking == Masking::kSeparable ? "separable" : "correlated";
}

std::string_view name_of(BurleyG burley_g) {
  return burley_g == BurleyG::k2012 ? "2012" : "2017";
}

std::string_view name_of(Diffuse diffuse) {
  return diffuse == Diffuse::kLambert ? "lambert" : "proxima";
}

std::optional<Model> model_by_name(std::string_view name) {
  return by_name(kModels, name);
}

std::optional<Tier> tier_by_name(std::string_view name) {
  return by_name(std::array{Tier::kBase, Tier::kAdvanced, Tier::kFull}, name);
}

std::optional<Masking> masking_by_name(std::string_view name) {
  return by_name(std::array{Masking::kSeparable, Masking::kCorrelated}, name);
}

std::optional<BurleyG> burley_g_by_name(std::string_view name) {
  return by_name(std::array{BurleyG::k2012, BurleyG::k2017}, name);
}

std::optional<Diffuse> diffuse_by_name(std::string_view name) {
  return by_name(std::array{Diffuse::kLambert, Diffuse::kProxima}, name);
}

std::span<const Model> all_models() {
  return kModels;
}

std::span<const ParameterInfo> parameters_of(Model model) {
  switch (model) {
    case Model::kLambertGgx:
      return kLambertGgxTable;
    case Model::kBurley:
      return kBurleyTable;
    case Model::kCallisto:
      return kCallistoTable;
  }
  return {};
}

const ParameterInfo* find_parameter(Model model, std::string_view name) {
  const auto table = parameters_of(model);
  const auto found = std::ranges::find(table, name, &ParameterInfo::name);
  return found == table.end() ? nullptr : &*found;
}

Effects effects_of(Model model) {
  Effects effects;
  for (const ParameterInfo& info : parameters_of(model)) effects = effects.with(info.effect);
  return effects;
}

Material::Material(Model model) : model_(model) {
  for (const ParameterInfo& info : parameters_of(model)) {
    values_.insert(values_.end(), static_cast<std::size_t>(info.components), info.default_value);
  }
}

void Material::set_effects(Effects effects) {
  if ((effects.bits() & ~effects_of(model_).bits()) != 0) {
    throw std::invalid_argument(std::string(title_of(model_)) + " does not have all of the given effects");
  }
  effects_ = effects;
}

double Material::number(std::string_view name) const {
  return values_[static_cast<std::size_t>(require_parameter(model_, name).offset)];
}

Rgb Material::colour(std::string_view name) const {
  const ParameterInfo& info = require_parameter(model_, name);
  const auto first = static_cast<std::size_t>(info.offset);
  if (info.components == 1) return {values_[first], values_[first], values_[first]};
  return {values_[first], values_[first + 1], values_[first + 2]};
}

void Material::set(std::string_view name, double value) {
  const ParameterInfo& info = require_parameter(model_, name);
  std::fill_n(values_.begin() + info.offset, info.components, value);
}

void Material::set(std::string_view name, const Rgb& value) {
  const ParameterInfo& info = require_parameter(model_, name);
  if (info.components != 3) {
    throw std::invalid_argument("\"" + std::string(name) + "\" is one number, not a colour");
  }
  std::copy(value.begin(), value.end(), values_.begin() + info.offset);
}

bool Material::is_valid(std::string* why) const {
  for (const ParameterInfo& info : parameters_of(model_)) {
    for (int c = 0; c < info.components; ++c) {
      const double value = values_[static_cast<std::size_t>(info.offset + c)];
      if (std::isfinite(value) && value >= info.lower && value <= info.upper) continue;
      if (why != nullptr) {
        *why = std::string(info.name) + " is " + shortest(value) + ", not in [" + shortest(info.lower) +
               ", " + shortest(info.upper) + "]";
      }
      return false;
    }
  }
  return true;
}

Effects effects_in_use(const Material& material) {
  Effects effects;
  // A falloff without its intensity, or a clearcoat gloss without a clearcoat, changes nothing: what counts
  // is whether the number that switches the effect is away from where the effect vanishes.
  for (const ParameterInfo& info : parameters_of(material.model())) {
    const bool switches = info.kind == Kind::kIntensity || info.name == effect_name(info.effect) ||
                          info.name == "dual_specular_opacity";
    const bool tints = info.kind == Kind::kTint && info.effect != Effect::kSmoothTerminator;
    for (int c = 0; c < info.components && (switches || tints); ++c) {
      const double value = material.values()[static_cast<std::size_t>(info.offset + c)];
      if (value != info.default_value) effects = effects.with(info.effect);
    }
  }
  return Effects(effects.bits() & effects_of(material.model()).bits());
}

}  // namespace brdfit
