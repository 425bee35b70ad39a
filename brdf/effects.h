// The set of effects that a material uses, and what each one switches.
#ifndef BRDFIT_BRDF_EFFECTS_H_
#define BRDFIT_BRDF_EFFECTS_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "brdf/kernel/burley.h"
#include "brdf/kernel/callisto.h"

namespace brdfit {

// Bits; kernels receive the same values as ints.
enum class Effect : std::uint32_t {
  kNone = 0,
  kSpecularFresnelFalloff = BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF,
  kDiffuseFresnel = BRDF_EFFECT_DIFFUSE_FRESNEL,
  kRetroreflection = BRDF_EFFECT_RETROREFLECTION,
  kSmoothTerminator = BRDF_EFFECT_SMOOTH_TERMINATOR,
  kDualSpecular = BRDF_EFFECT_DUAL_SPECULAR,
  kSubsurface = BRDF_EFFECT_SUBSURFACE,
  kSpecularTint = BRDF_EFFECT_SPECULAR_TINT,
  kAnisotropic = BRDF_EFFECT_ANISOTROPIC,
  kSheen = BRDF_EFFECT_SHEEN,
  kClearcoat = BRDF_EFFECT_CLEARCOAT,
};

// A set of effects.
class Effects {
 public:
  constexpr Effects() = default;
  constexpr explicit Effects(std::uint32_t bits) : bits_(bits) {}

  // An effect of kNone counts as always present: parameters without an effect are part of the model itself.
  constexpr bool has(Effect effect) const {
    return effect == Effect::kNone || (bits_ & static_cast<std::uint32_t>(effect)) != 0;
  }
  constexpr Effects with(Effect effect) const { return Effects(bits_ | static_cast<std::uint32_t>(effect)); }
  constexpr Effects without(Effect effect) const {
    return Effects(bits_ & ~static_cast<std::uint32_t>(effect));
  }
  constexpr std::uint32_t bits() const { return bits_; }
  friend constexpr bool operator==(Effects a, Effects b) = default;

 private:
  std::uint32_t bits_ = 0;
};

// The JSON name of an effect ("dual_specular"); "none" for kNone.
std::string_view effect_name(Effect effect);

// Every effect but kNone, in the order in which they are listed everywhere.
std::span<const Effect> all_effects();

// The effect of that name, if there is one.
std::optional<Effect> effect_by_name(std::string_view name);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_EFFECTS_H_
