// Random materials with parameters in the interior of their ranges, for round trips.
#ifndef BRDFIT_DATA_SYNTHETIC_RANDOM_MATERIAL_H_
#define BRDFIT_DATA_SYNTHETIC_RANDOM_MATERIAL_H_

#include <cstdint>

#include "brdf/material.h"

namespace brdfit::synthetic {

// A material whose parameters are drawn away from bounds, from kinks and from values at which an effect
// vanishes:
//   base colour             each channel in [0.05, 0.95]
//   numbers of range [0, 1] [0.1, 0.9] (roughness too)
//   diffuse_fresnel, retroreflection   log-uniform in [0.2, 20], not within 20% of 1
//   smooth_terminator       +-[0.1, 0.9]
//   tints                   one channel 1, the others in [0.2, 0.95]
//   specular_fresnel_falloff   [0.1, 0.45] or [0.55, 0.9]
//   dual_specular_roughness_scale   [1.5, 4], so that roughness times scale stays below 0.95
//   clearcoat               [0.2, 2]
//
// Parameters beyond the tier, of effects that are not given, and `anisotropic` (tables are isotropic) stay at
// their defaults; the material's effects are those of the given ones that have a drawn parameter. The same
// seed gives the same bits on every machine. Throws std::invalid_argument for effects that the model does not
// have.
Material random_material(Model model, Tier tier, Effects effects, MaterialOptions options,
                         std::uint64_t seed);

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_RANDOM_MATERIAL_H_
