// Lobes of Realis: spherical Gaussians over light directions that an asset's texels share.
#ifndef BRDFIT_BRDF_REALIS_H_
#define BRDFIT_BRDF_REALIS_H_

#include <vector>

#include "brdf/kernel/spherical_gaussian.h"
#include "brdf/vec3.h"

namespace brdfit {

// One lobe: exp(sharpness (axis . direction - 1)), times a window that ends, with slope 0, at the cut-off.
// axis: unit, in the frame of the light directions (model space). sharpness >= 0. cos_cut_off in [-1, 1).
// Jimenez et al. 2023.
struct Lobe {
  Vec3 axis;
  double sharpness = 1.0;
  double cos_cut_off = -1.0;
  friend bool operator==(const Lobe& a, const Lobe& b) {
    return a.axis.x == b.axis.x && a.axis.y == b.axis.y && a.axis.z == b.axis.z &&
           a.sharpness == b.sharpness && a.cos_cut_off == b.cos_cut_off;
  }
};

using LobeSet = std::vector<Lobe>;

// Of an asset's lobes, so that the exponent is a number in single precision too.
inline constexpr double kLargestSharpness = 1e30;

// How amplitudes of one lobe are stored, as whole numbers in [0, realis_top_code(bits)]: an amplitude is
// (stored - zero) x step. step >= 0; 0 where the lobe is not used. zero, itself such a number, stands for 0.
struct RealisRange {
  double step = 0.0;
  int zero = 0;
  friend bool operator==(const RealisRange&, const RealisRange&) = default;
};

constexpr int realis_top_code(int bits) {
  return (1 << bits) - 1;
}

// Amplitudes in one RGBA texture of 8 bits: one or two to a byte. And textures for that many per texel.
constexpr int realis_slots_per_texture(int bits) {
  return bits == 4 ? 8 : 4;
}
constexpr int realis_textures(int slots, int bits) {
  return (slots + realis_slots_per_texture(bits) - 1) / realis_slots_per_texture(bits);
}

// The lobe's value for a light in that direction (unit, towards the light), in [0, 1].
inline double eval(const Lobe& lobe, const Vec3& direction) {
  const double one_minus_cos = kernel::one_minus_cos_between(lobe.axis.x, lobe.axis.y, lobe.axis.z,
                                                             direction.x, direction.y, direction.z);
  return kernel::windowed_lobe(one_minus_cos, lobe.sharpness, lobe.cos_cut_off);
}

}  // namespace brdfit

#endif  // BRDFIT_BRDF_REALIS_H_
