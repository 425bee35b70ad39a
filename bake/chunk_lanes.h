// Vectors over lanes and lights at texels, for the vector code of the bake.
#ifndef BRDFIT_BAKE_CHUNK_LANES_H_
#define BRDFIT_BAKE_CHUNK_LANES_H_

#include "bake/chunk_jobs.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

template <class S>
struct VecOf {
  Lanes<S> x;
  Lanes<S> y;
  Lanes<S> z;
};
template <class S>
HWY_INLINE Lanes<S> dot(const VecOf<S>& a, const VecOf<S>& b) {
  return multiply_add(a.x, b.x, multiply_add(a.y, b.y, a.z * b.z));
}
template <class S>
HWY_INLINE VecOf<S> operator+(const VecOf<S>& a, const VecOf<S>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class S>
HWY_INLINE VecOf<S> operator-(const VecOf<S>& a, const VecOf<S>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class S>
HWY_INLINE VecOf<S> operator*(const VecOf<S>& a, Lanes<S> s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class S>
HWY_INLINE Lanes<S> at_least(Lanes<S> x, Lanes<S> lower) {
  return select(x > lower, x, lower);
}

// Three rows of a chunk, from a lane on.
template <class S>
HWY_INLINE VecOf<S> load_rows(const S* rows, std::size_t at) {
  using V = Lanes<S>;
  return {V::load(rows + at), V::load(rows + bake::kChunk + at), V::load(rows + 2 * bake::kChunk + at)};
}

// A light as it reaches lanes of texels.
template <class S, bool kNear>
struct LightAt {
  using V = Lanes<S>;
  VecOf<S> direction;
  V falloff;

  HWY_INLINE LightAt(const bake::LightColumnsOf<S>& lights, std::size_t k, std::size_t at) {
    const S* d = lights.direction + k * 3 * lights.stride;
    if constexpr (kNear) {
      direction = load_rows(d, at);
      falloff = V::load(lights.falloff + k * bake::kChunk + at);
    } else {
      direction = {V(d[0]), V(d[1]), V(d[2])};
      falloff = V(1.0);
    }
  }
};

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_BAKE_CHUNK_LANES_H_
