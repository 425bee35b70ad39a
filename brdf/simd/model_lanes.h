// The models over lanes: coefficients spread over a vector, and one overload set to evaluate any model.
#ifndef BRDFIT_BRDF_SIMD_MODEL_LANES_H_
#define BRDFIT_BRDF_SIMD_MODEL_LANES_H_

#include "brdf/kernel/burley.h"
#include "brdf/kernel/callisto.h"
#include "brdf/kernel/lambert_ggx.h"
#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

using V = Lanes<double>;

HWY_INLINE kernel::Geometry<V> load_geometry(const GeometryColumns& g, std::size_t at) {
  kernel::Geometry<V> r;
  r.cos_i = V::load(g.cos_i + at);
  r.cos_o = V::load(g.cos_o + at);
  r.h_x = V::load(g.sin_h + at);
  r.h_y = V(0.0);
  r.cos_h = V::load(g.cos_h + at);
  r.cos_d = V::load(g.cos_d + at);
  r.cos_k = kernel::cos_k_from_cos_d(r.cos_d);
  r.one_minus_cos_h = V::load(g.one_minus_cos_h + at);
  r.one_minus_cos_d = V::load(g.one_minus_cos_d + at);
  // Only anisotropic lobes look at these, and columns are isotropic.
  r.wi_x = r.wi_y = r.wo_x = r.wo_y = V(0.0);
  return r;
}

HWY_INLINE kernel::GeometryLogs<V> load_logs(const GeometryColumns& g, std::size_t at) {
  kernel::GeometryLogs<V> r;
  r.cos_h = V::load(g.log_cos_h + at);
  r.cos_d = V::load(g.log_cos_d + at);
  r.one_minus_cos_h = V::load(g.log_one_minus_cos_h + at);
  r.one_minus_cos_d = V::load(g.log_one_minus_cos_d + at);
  return r;
}

// One struct per model: its kernel's shape and colours, and the steps of its evaluation. S: double or
// float.
template <class S>
struct LambertGgxLanesOf {
  using V = Lanes<S>;
  static constexpr bool uses_logs = false;
  kernel::LambertGgxShape<V> shape;
  kernel::LambertGgxColour<V> colour[3];
  int masking;
  int diffuse;

  explicit HWY_INLINE LambertGgxLanesOf(const Coefficients& k) : masking(k.masking), diffuse(k.diffuse) {
    shape.alpha = V(k.shape[0]);
    for (int c = 0; c < 3; ++c) colour[c] = {V(k.colour[c][0]), V(k.colour[c][1])};
  }
  HWY_INLINE kernel::LambertGgxTerms<V> terms(const kernel::Geometry<V>& g,
                                              const kernel::GeometryLogs<V>&) const {
    return kernel::lambert_ggx_terms(shape, g, masking, diffuse);
  }
  HWY_INLINE kernel::LambertGgxLine<V> line(const kernel::Geometry<V>& g,
                                            const kernel::GeometryLogs<V>&) const {
    return kernel::lambert_ggx_line(shape, g);
  }
  HWY_INLINE V lobe(const kernel::LambertGgxLine<V>& line, const kernel::Geometry<V>& g) const {
    return kernel::lambert_ggx_lobe(shape, line, g, masking);
  }
  HWY_INLINE kernel::LambertGgxTerms<V> terms(const kernel::LambertGgxLine<V>& line, V lobe,
                                              const kernel::Geometry<V>& g) const {
    return kernel::lambert_ggx_terms_of_line(shape, line, lobe, g, diffuse);
  }
  HWY_INLINE V combine(int c, const kernel::LambertGgxTerms<V>& terms) const {
    return kernel::lambert_ggx_combine(colour[c], terms);
  }
};

template <class S>
struct BurleyLanesOf {
  using V = Lanes<S>;
  static constexpr bool uses_logs = false;
  kernel::BurleyShape<V> shape;
  kernel::BurleyColour<V> colour[3];
  int burley_g;
  int effects;

  explicit HWY_INLINE BurleyLanesOf(const Coefficients& k) : burley_g(k.burley_g), effects(k.effects) {
    shape = {V(k.shape[0]), V(k.shape[1]), V(k.shape[2]), V(k.shape[3]), V(k.shape[4])};
    for (int c = 0; c < 3; ++c) {
      colour[c] = {V(k.colour[c][0]), V(k.colour[c][1]), V(k.colour[c][2]), V(k.colour[c][3])};
    }
  }
  HWY_INLINE kernel::BurleyTerms<V> terms(const kernel::Geometry<V>& g,
                                          const kernel::GeometryLogs<V>&) const {
    return kernel::burley_terms(shape, g, burley_g, effects);
  }
  HWY_INLINE kernel::BurleyLine<V> line(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>&) const {
    return kernel::burley_line(shape, g, effects);
  }
  HWY_INLINE V lobe(const kernel::BurleyLine<V>& line, const kernel::Geometry<V>& g) const {
    return kernel::burley_lobe(shape, line, g, burley_g, effects);
  }
  HWY_INLINE kernel::BurleyTerms<V> terms(const kernel::BurleyLine<V>& line, V lobe,
                                          const kernel::Geometry<V>& g) const {
    return kernel::burley_terms_of_line(shape, line, lobe, g, effects);
  }
  HWY_INLINE V combine(int c, const kernel::BurleyTerms<V>& terms) const {
    return kernel::burley_combine(colour[c], terms);
  }
};

template <class S>
struct CallistoLanesOf {
  using V = Lanes<S>;
  static constexpr bool uses_logs = true;
  kernel::CallistoShape<V> shape;
  kernel::CallistoColour<V> colour[3];
  int masking;
  int diffuse;
  int effects;

  explicit HWY_INLINE CallistoLanesOf(const Coefficients& k)
      : masking(k.masking), diffuse(k.diffuse), effects(k.effects) {
    shape = {V(k.shape[0]), V(k.shape[1]), V(k.shape[2]), V(k.shape[3]), V(k.shape[4]),
             V(k.shape[5]), V(k.shape[6]), V(k.shape[7]), V(k.shape[8])};
    for (int c = 0; c < 3; ++c) {
      colour[c] = {V(k.colour[c][0]), V(k.colour[c][1]), V(k.colour[c][2]), V(k.colour[c][3]),
                   V(k.colour[c][4])};
    }
  }
  HWY_INLINE kernel::CallistoTerms<V> terms(const kernel::Geometry<V>& g,
                                            const kernel::GeometryLogs<V>& logs) const {
    return kernel::callisto_terms(shape, g, logs, masking, diffuse, effects);
  }
  HWY_INLINE kernel::CallistoLine<V> line(const kernel::Geometry<V>& g,
                                          const kernel::GeometryLogs<V>& logs) const {
    return kernel::callisto_line(shape, g, logs, effects);
  }
  HWY_INLINE V lobe(const kernel::CallistoLine<V>& line, const kernel::Geometry<V>& g) const {
    return kernel::callisto_lobes(shape, line, g, masking, effects);
  }
  HWY_INLINE kernel::CallistoTerms<V> terms(const kernel::CallistoLine<V>& line, V lobes,
                                            const kernel::Geometry<V>& g) const {
    return kernel::callisto_terms_of_line(shape, line, lobes, g, diffuse, effects);
  }
  HWY_INLINE V combine(int c, const kernel::CallistoTerms<V>& terms) const {
    return kernel::callisto_combine(colour[c], terms);
  }
};

using LambertGgxLanes = LambertGgxLanesOf<double>;
using BurleyLanes = BurleyLanesOf<double>;
using CallistoLanes = CallistoLanesOf<double>;

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_BRDF_SIMD_MODEL_LANES_H_
