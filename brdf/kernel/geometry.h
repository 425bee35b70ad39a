// What a pair of directions means to a model: cosines, half vector, difference angle.
//
// Local frame, z = normal. wi (to the light) and wo (to the viewer) are unit vectors pointing away from the
// surface; h = normalize(wi + wo); cos_d = wi.h = wo.h (Rusinkiewicz 1998).
#ifndef BRDFIT_BRDF_KERNEL_GEOMETRY_H_
#define BRDFIT_BRDF_KERNEL_GEOMETRY_H_

#include "math.h"

// A direction is above the horizon if its cosine is larger than this, so that in single precision its
// products with alpha >= 1e-4 and what is divided by them stay clear of BRDF_TINY, and of the denormal
// numbers, which many devices take for 0.
#define BRDF_HORIZON 1e-25

BRDF_NAMESPACE_BEGIN

BRDF_GEO_STRUCT(Geometry) {
  Geo wi_x;
  Geo wi_y;
  Geo cos_i;
  Geo wo_x;
  Geo wo_y;
  Geo cos_o;
  Geo h_x;
  Geo h_y;
  Geo cos_h;
  Geo cos_d;
  Geo cos_k;            // -(wi . wo) = 1 - 2 cos_d^2
  Geo one_minus_cos_h;  // from sin^2: exact to the last digits near 0, where 1 - cos is not
  Geo one_minus_cos_d;
};

// Natural logarithms of the bases of Callisto's falloffs (0 where a base is 0).
BRDF_GEO_STRUCT(GeometryLogs) {
  Geo cos_h;
  Geo cos_d;
  Geo one_minus_cos_h;
  Geo one_minus_cos_d;
};

// cos_k from cos_d; directions give it more exactly.
BRDF_GEO_FUNCTION
Geo cos_k_from_cos_d(Geo cos_d) {
  return GEO(1.0) - GEO(2.0) * cos_d * cos_d;
}

// 1 - cos from sin^2 and cos >= 0.
BRDF_GEO_FUNCTION
Geo one_minus_cos(Geo sin_squared, Geo cosine) {
  return sin_squared / (GEO(1.0) + cosine);
}

BRDF_GEO_FUNCTION
OF_GEO(Geometry)
geometry_from_directions(Geo wi_x, Geo wi_y, Geo wi_z, Geo wo_x, Geo wo_y, Geo wo_z) {
  OF_GEO(Geometry) g;
  Geo s_x = wi_x + wo_x;
  Geo s_y = wi_y + wo_y;
  Geo s_z = wi_z + wo_z;
  Geo d_x = wi_x - wo_x;
  Geo d_y = wi_y - wo_y;
  Geo d_z = wi_z - wo_z;
  // Of directions that are almost opposite, the squares would vanish in single precision.
  Geo unscaled = s_x * s_x + s_y * s_y + s_z * s_z;
  Geo scale = scale_before_squares(unscaled);
  s_x = s_x * scale;
  s_y = s_y * scale;
  s_z = s_z * scale;
  Geo s_squared = s_x * s_x + s_y * s_y + s_z * s_z;
  Geo length_s = sqrt(s_squared);
  // Opposite directions have no half vector: the normal serves.
  Geo divisor = select(s_squared > GEO(0.0), length_s, GEO(1.0));
  // Rounded directions are not quite unit vectors: |s|^2 + |d|^2 is 4 but for that, and this the inverse of
  // its root to the square of the difference.
  Geo d_squared = d_x * d_x + d_y * d_y + d_z * d_z;
  Geo inverse_root = GEO(0.75) - GEO(0.0625) * (unscaled + d_squared);
  Geo sin_d_squared = d_squared * inverse_root * inverse_root;
  g.wi_x = wi_x;
  g.wi_y = wi_y;
  g.cos_i = wi_z;
  g.wo_x = wo_x;
  g.wo_y = wo_y;
  g.cos_o = wo_z;
  g.h_x = s_x / divisor;
  g.h_y = s_y / divisor;
  g.cos_h = select(s_squared > GEO(0.0), s_z / divisor, GEO(1.0));
  g.cos_d = at_most(length_s / scale * inverse_root, GEO(1.0));
  g.cos_k = GEO(0.0) - accurate_dot(wi_x, wi_y, wi_z, wo_x, wo_y, wo_z);
  g.one_minus_cos_h = one_minus_cos(g.h_x * g.h_x + g.h_y * g.h_y, at_least(g.cos_h, GEO(0.0)));
  g.one_minus_cos_d = at_most(one_minus_cos(sin_d_squared, g.cos_d), GEO(1.0));
  return g;
}

BRDF_GEO_FUNCTION
OF_GEO(GeometryLogs) geometry_logs(OF_GEO(Geometry) g) {
  OF_GEO(GeometryLogs) logs;
  logs.cos_h = accurate_log_or_zero(g.cos_h, g.one_minus_cos_h);
  logs.cos_d = accurate_log_or_zero(g.cos_d, g.one_minus_cos_d);
  logs.one_minus_cos_h = accurate_log_or_zero(g.one_minus_cos_h, g.cos_h);
  logs.one_minus_cos_d = accurate_log_or_zero(g.one_minus_cos_d, g.cos_d);
  return logs;
}

// x where both directions are above the horizon, 0 elsewhere.
BRDF_FUNCTION
Real above_horizon(Real x, Geo cos_i, Geo cos_o) {
  return select(cos_i > GEO(BRDF_HORIZON), select(cos_o > GEO(BRDF_HORIZON), x, REAL(0.0)), REAL(0.0));
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_GEOMETRY_H_
