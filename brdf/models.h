// Evaluation of a material: one pair of directions, or spans of pairs.
#ifndef BRDFIT_BRDF_MODELS_H_
#define BRDFIT_BRDF_MODELS_H_

#include <span>

#include "brdf/material.h"
#include "brdf/vec3.h"

namespace brdfit {

// f(wi, wo) in sr^-1, without the cosine, per linear RGB channel; 0 where a direction is not above the
// horizon. wi, wo: unit, local frame, z = normal, pointing away from the surface. Never NaN. With `diffuse:
// proxima` unbounded as cos_i goes to 0: use eval_cos there.
Rgb eval(const Material& material, const Vec3& wi, const Vec3& wo);

// f(wi, wo) cos_i in sr^-1.
Rgb eval_cos(const Material& material, const Vec3& wi, const Vec3& wo);

// As eval_cos, for wi.size() pairs: out[k] belongs to (wi[k], wo[k]). Vectorised: agrees with the scalar form
// to about 1e-14 relative. Throws std::invalid_argument if the sizes differ.
void eval_cos(const Material& material, std::span<const Vec3> wi, std::span<const Vec3> wo,
              std::span<Rgb> out);

// As eval, for spans.
void eval(const Material& material, std::span<const Vec3> wi, std::span<const Vec3> wo, std::span<Rgb> out);

// Whether f(wi, wo) = f(wo, wi) holds for the material: the smooth terminator and Proxima break it.
bool is_reciprocal(const Material& material);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_MODELS_H_
