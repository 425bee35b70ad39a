// Draws random materials with arithmetic that rounds the same everywhere.
#include "data/synthetic/random_material.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace brdfit::synthetic {
namespace {

// Largest product of roughness and scale: the second lobe's roughness.
constexpr double kMaxSecondRoughness = 0.94;
constexpr double kMinScale = 1.5;
constexpr double kMaxScale = 4.0;

// Draws from std::mt19937_64, whose sequence the standard fixes. The distributions of the standard library
// are not fixed, nor is the rounding of exp and pow: here are only +, *, sqrt and explicit fma, which round
// exactly.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  // Evenly in (0, 1).
  double unit() { return (static_cast<double>(engine_() >> 12) + 0.5) * 0x1p-52; }

  double between(double lower, double upper) { return std::fma(upper - lower, unit(), lower); }

  // lower * ratio^u, u even in [0, 1), from square roots of ratio.
  double log_between(double lower, double ratio) {
    const std::uint64_t bits = engine_();
    double value = lower;
    double root = ratio;
    for (int bit = 63; bit >= 12; --bit) {
      root = std::sqrt(root);
      if ((bits >> bit & 1U) != 0) value *= root;
    }
    return value;
  }

  bool coin() { return (engine_() >> 63) != 0; }

  std::size_t one_of(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

 private:
  std::mt19937_64 engine_;
};

bool is_drawn(const ParameterInfo& info, Tier tier, Effects effects) {
  return info.tier <= tier && effects.has(info.effect) && info.effect != Effect::kAnisotropic;
}

Rgb draw_colour(Draw& draw) {
  Rgb colour;
  for (double& channel : colour) channel = draw.between(0.05, 0.95);
  return colour;
}

Rgb draw_tint(Draw& draw) {
  Rgb tint;
  for (double& channel : tint) channel = draw.between(0.2, 0.95);
  tint[draw.one_of(3)] = 1.0;
  return tint;
}

double draw_intensity(Draw& draw) {
  double value = 1.0;
  while (std::abs(value - 1.0) <= 0.2) value = draw.log_between(0.2, 100.0);
  return value;
}

double draw_number(Draw& draw, const ParameterInfo& info) {
  if (info.name == "smooth_terminator") {
    const double size = draw.between(0.1, 0.9);
    return draw.coin() ? size : -size;
  }
  if (info.kind == Kind::kIntensity) return draw_intensity(draw);
  if (info.name == "specular_fresnel_falloff") {
    return draw.coin() ? draw.between(0.1, 0.45) : draw.between(0.55, 0.9);
  }
  if (info.name == "clearcoat") return draw.between(0.2, 2.0);
  return draw.between(0.1, 0.9);
}

// Draws the scale, and the roughness anew where no scale would fit it.
void draw_dual_scale(Draw& draw, Material& material) {
  const double max_roughness = kMaxSecondRoughness / kMinScale;
  if (material.number("roughness") > max_roughness)
    material.set("roughness", draw.between(0.1, max_roughness));
  const double upper = std::min(kMaxScale, kMaxSecondRoughness / material.number("roughness"));
  material.set("dual_specular_roughness_scale", draw.between(kMinScale, upper));
}

void draw_parameter(Draw& draw, const ParameterInfo& info, Material& material) {
  if (info.kind == Kind::kColour) {
    material.set(info.name, draw_colour(draw));
  } else if (info.kind == Kind::kTint) {
    material.set(info.name, draw_tint(draw));
  } else if (info.name == "dual_specular_roughness_scale") {
    draw_dual_scale(draw, material);
  } else {
    material.set(info.name, draw_number(draw, info));
  }
}

}  // namespace

Material random_material(Model model, Tier tier, Effects effects, MaterialOptions options,
                         std::uint64_t seed) {
  Material material(model);
  material.set_effects(effects);
  material.options() = options;
  Draw draw(seed);
  Effects used;
  for (const ParameterInfo& info : parameters_of(model)) {
    if (!is_drawn(info, tier, effects)) continue;
    draw_parameter(draw, info, material);
    used = used.with(info.effect);
  }
  material.set_effects(used);
  return material;
}

}  // namespace brdfit::synthetic
