// Half/difference angles (Rusinkiewicz 1998) and the directions that they stand for.
#ifndef BRDFIT_BRDF_HALF_DIFF_H_
#define BRDFIT_BRDF_HALF_DIFF_H_

#include "brdf/vec3.h"

namespace brdfit {

// Isotropic half/difference coordinates. theta_h, theta_d in [0, pi/2]; phi_d is the azimuth of wi around h.
struct HalfDiff {
  double theta_h_rad = 0.0;
  double theta_d_rad = 0.0;
  double phi_d_rad = 0.0;
};

struct DirectionPair {
  Vec3 wi;
  Vec3 wo;
};

// The pair whose half vector lies in the xz plane at theta_h. Either direction may be below the horizon:
// cos_i = cos_d cos_h - sin_d cos(phi_d) sin_h, cos_o the same with a plus.
DirectionPair directions_from_half_diff(const HalfDiff& angles);

// The inverse, for wi + wo != 0; phi_d in [0, 2 pi), 0 where theta_d or theta_h leave it undefined.
HalfDiff half_diff_from_directions(const Vec3& wi, const Vec3& wo);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_HALF_DIFF_H_
