// Directional albedo of a material: how much of the light from a direction it sends back.
#ifndef BRDFIT_BRDF_ALBEDO_H_
#define BRDFIT_BRDF_ALBEDO_H_

#include "brdf/material.h"

namespace brdfit {

// The integral of f(wi, wo) cos_i over the hemisphere of wi, per channel, for wo at theta_o from the normal
// (0 <= theta_o < pi/2). A quadrature over the sphere of half vectors, square-root spaced around the normal
// so that highlights down to alpha = 1e-3 are resolved; good to about 1%.
Rgb directional_albedo(const Material& material, double theta_o_rad);

// The largest channel of it over theta_o = 0, 10, ..., 80 deg. Above 1 the material gives back more light
// than it gets.
double largest_directional_albedo(const Material& material);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_ALBEDO_H_
