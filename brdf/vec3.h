// A direction or a linear RGB colour: three doubles.
#ifndef BRDFIT_BRDF_VEC3_H_
#define BRDFIT_BRDF_VEC3_H_

#include <array>

namespace brdfit {

// Unit vector in the local frame of a surface, z = normal.
struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 1.0;
};

// Linear Rec.709, red first.
using Rgb = std::array<double, 3>;

}  // namespace brdfit

#endif  // BRDFIT_BRDF_VEC3_H_
