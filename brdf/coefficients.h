// From a model's parameters to the shape and the colours that its kernel takes, for double, float and Jets.
//
// Parameters come as a flat vector in *product form*: an intensity and its tint are one triple, their
// product. It is what the models depend on, so that a fit has no direction in which an intensity and a tint
// cancel out.
#ifndef BRDFIT_BRDF_COEFFICIENTS_H_
#define BRDFIT_BRDF_COEFFICIENTS_H_

#include <array>
#include <string_view>
#include <vector>

#include "brdf/kernel/burley.h"
#include "brdf/kernel/callisto.h"
#include "brdf/kernel/lambert_ggx.h"
#include "brdf/material.h"

namespace brdfit {

template <class T>
struct LambertGgxCoefficients {
  kernel::LambertGgxShape<T> shape;
  std::array<kernel::LambertGgxColour<T>, 3> colour;
};

template <class T>
struct BurleyCoefficients {
  kernel::BurleyShape<T> shape;
  std::array<kernel::BurleyColour<T>, 3> colour;
};

template <class T>
struct CallistoCoefficients {
  kernel::CallistoShape<T> shape;
  std::array<kernel::CallistoColour<T>, 3> colour;
};

// Lengths of the product forms.
inline constexpr int kLambertGgxProductSize = 6;
inline constexpr int kBurleyProductSize = 13;
inline constexpr int kCallistoProductSize = 23;

// One entry of a model's product form: the parameter, and the tint that multiplies it (empty for others).
struct ProductEntry {
  std::string_view parameter;
  std::string_view tint;
  int channel;  // of a colour or a tint; 0 for numbers
};

// What each entry of the product form of a model is, in order.
std::vector<ProductEntry> product_layout(Model model);

// The product form of a material. Parameters of effects that are off stand at their defaults.
std::vector<double> product_form(const Material& material);

// q: base_color[3], metallic, specular, roughness.
template <class T>
LambertGgxCoefficients<T> lambert_ggx_coefficients(const T* q) {
  LambertGgxCoefficients<T> result;
  result.shape = kernel::lambert_ggx_shape(q[5]);
  for (std::size_t c = 0; c < 3; ++c) result.colour[c] = kernel::lambert_ggx_colour(q[c], q[3], q[4]);
  return result;
}

// q: base_color[3], metallic, specular, roughness, then the other parameters in the order of the table.
template <class T>
BurleyCoefficients<T> burley_coefficients(const T* q, int effects) {
  BurleyCoefficients<T> result;
  result.shape = kernel::burley_shape(q[5], q[6], q[8], q[12], effects);
  const T luminance = q[0] * T(0.3) + q[1] * T(0.6) + q[2] * T(0.1);
  for (std::size_t c = 0; c < 3; ++c) {
    result.colour[c] = kernel::burley_colour(q[c], luminance, q[3], q[4], q[7], q[9], q[10], q[11]);
  }
  return result;
}

// q: base_color[3], metallic, specular, roughness, dual scale, dual opacity, diffuse Fresnel falloff and
// tangent falloff, retroreflection falloff and tangent falloff, specular Fresnel falloff, terminator length,
// then the products diffuse_fresnel[3], retroreflection[3], smooth_terminator[3].
template <class T>
CallistoCoefficients<T> callisto_coefficients(const T* q) {
  CallistoCoefficients<T> result;
  result.shape = kernel::callisto_shape(q[5], q[6], q[7], q[8], q[9], q[10], q[11], q[12], q[13]);
  for (std::size_t c = 0; c < 3; ++c) {
    result.colour[c] = kernel::callisto_colour(q[c], q[3], q[4], q[14 + c], q[17 + c], q[20 + c]);
  }
  return result;
}

}  // namespace brdfit

#endif  // BRDFIT_BRDF_COEFFICIENTS_H_
