// Names of effects.
#include "brdf/effects.h"

#include <algorithm>
#include <array>

namespace brdfit {
namespace {

constexpr std::array kEffects = {
    Effect::kSpecularFresnelFalloff,
    Effect::kDiffuseFresnel,
    Effect::kRetroreflection,
    Effect::kSmoothTerminator,
    Effect::kDualSpecular,
    Effect::kSubsurface,
    Effect::kSpecularTint,
    Effect::kAnisotropic,
    Effect::kSheen,
    Effect::kClearcoat,
};

}  // namespace

std::string_view effect_name(Effect effect) {
  switch (effect) {
    case Effect::kNone:
      return "none";
    case Effect::kSpecularFresnelFalloff:
      return "specular_fresnel_falloff";
    case Effect::kDiffuseFresnel:
      return "diffuse_fresnel";
    case Effect::kRetroreflection:
      return "retroreflection";
    case Effect::kSmoothTerminator:
      return "smooth_terminator";
    case Effect::kDualSpecular:
      return "dual_specular";
    case Effect::kSubsurface:
      return "subsurface";
    case Effect::kSpecularTint:
      return "specular_tint";
    case Effect::kAnisotropic:
      return "anisotropic";
    case Effect::kSheen:
      return "sheen";
    case Effect::kClearcoat:
      return "clearcoat";
  }
  return "none";
}

std::span<const Effect> all_effects() {
  return kEffects;
}

std::optional<Effect> effect_by_name(std::string_view name) {
  const auto found = std::ranges::find(kEffects, name, effect_name);
  if (found == kEffects.end()) return std::nullopt;
  return *found;
}

}  // namespace brdfit
