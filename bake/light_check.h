// Whether a stack's lights are where its file says: what a Lambert surface and an integrable one would show.
#ifndef BRDFIT_BAKE_LIGHT_CHECK_H_
#define BRDFIT_BAKE_LIGHT_CHECK_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "measured/image_stack.h"

namespace brdfit::bake {

// Something that would explain the pictures clearly better than what the file says.
struct LightSuspicion {
  // "same direction", "same picture", "swapped lights", "wrong order", "misplaced light",
  // "other strength", "mirrored",
  // "transposed", "turned by 90 deg", "opposite side"
  std::string kind;
  std::string text;                 // for people, on one line
  std::vector<std::size_t> lights;  // those concerned; empty: all
};

struct LightCheck {
  std::size_t texels = 0;  // that took part
  double lambert_residual =
      0.0;                       // root of the share of the pictures' energy that no Lambert surface explains
  std::vector<double> of_light;  // the same for each light
  std::vector<LightSuspicion> suspicions;
};

// Texels for check_lights: about that many triples of neighbours, spread evenly.
std::vector<std::uint32_t> light_check_texels(const StackInfo& info, std::size_t triples);

// Tries other orders and pairs of swapped lights against the residual of Lambert's law, with an albedo and a
// normal of each texel free. Linear maps of all directions leave that residual as it is, so mirrored and
// turned pictures are told by the normals that follow: slopes of a surface are integrable (dp/dy = dq/dx;
// Belhumeur et al. 1999), and those of a hump face outwards. A hypothesis is told only where it is better by
// a third or more. Values above the 90th percentile of their texel count as that (highlights). block: of
// light_check_texels; needs 4 lights and 30 triples, and says nothing with fewer.
LightCheck check_lights(const StackInfo& info, const TexelBlock& block);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LIGHT_CHECK_H_
