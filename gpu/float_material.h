// A material and pairs of directions in single precision, as a device takes them.
#ifndef BRDFIT_GPU_FLOAT_MATERIAL_H_
#define BRDFIT_GPU_FLOAT_MATERIAL_H_

#include <array>
#include <span>
#include <vector>

#include "brdf/material.h"

namespace brdfit {

// wi and wo: unit, local frame, z = normal, pointing away from the surface. The layout is that of `Pair` in
// gpu/shaders/material.glsl.
struct FloatPair {
  std::array<float, 3> wi{0.0F, 0.0F, 1.0F};
  std::array<float, 3> wo{0.0F, 0.0F, 1.0F};
  friend bool operator==(const FloatPair&, const FloatPair&) = default;
};

// Red, green, blue.
using FloatRgb = std::array<float, 3>;

// The parameters of a material, each rounded to the nearest float, in the order of Material::values().
std::vector<float> float_values(const Material& material);

// The material whose parameters are those of another one after rounding to float: what a device evaluates.
Material rounded_to_float(const Material& material);

// f cos_i of pairs in single precision on the processor, through the same kernels. Sizes must be equal
// (std::invalid_argument).
void eval_cos_float(const Material& material, std::span<const FloatPair> pairs, std::span<FloatRgb> out);

// f cos_i of pairs in double: the pairs and the rounded parameters are taken as exact. Sizes must be equal
// (std::invalid_argument).
void eval_cos_reference(const Material& material, std::span<const FloatPair> pairs, std::span<Rgb> out);

}  // namespace brdfit

#endif  // BRDFIT_GPU_FLOAT_MATERIAL_H_
