// Vectorised photometric stereo, one texel per lane. Compiled once for every instruction set.
#include "bake/chunk_jobs.h"
#include "bake/chunk_lanes.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using bake::kChunk;
using bake::LightColumns;
using bake::StereoJob;
using F = Lanes<float>;

using Vec = VecOf<float>;

// Symmetric 3 x 3.
struct Symmetric {
  F xx, xy, xz, yy, yz, zz;

  HWY_INLINE void clear() { xx = xy = xz = yy = yz = zz = F(0.0); }
  HWY_INLINE void add(const Vec& v, F w) {
    const Vec s = v * w;
    xx = multiply_add(s.x, v.x, xx);
    xy = multiply_add(s.x, v.y, xy);
    xz = multiply_add(s.x, v.z, xz);
    yy = multiply_add(s.y, v.y, yy);
    yz = multiply_add(s.y, v.z, yz);
    zz = multiply_add(s.z, v.z, zz);
  }
  HWY_INLINE void add_identity(F w) {
    xx = xx + w;
    yy = yy + w;
    zz = zz + w;
  }
  HWY_INLINE F trace() const { return xx + yy + zz; }
  HWY_INLINE Vec times(const Vec& v) const {
    return {dot({xx, xy, xz}, v), dot({xy, yy, yz}, v), dot({xz, yz, zz}, v)};
  }
  HWY_INLINE Symmetric inverse() const {
    const F cxx = yy * zz - yz * yz;
    const F cxy = xz * yz - xy * zz;
    const F cxz = xy * yz - xz * yy;
    const F det = multiply_add(xx, cxx, multiply_add(xy, cxy, xz * cxz));
    const F scale = F(1.0) / at_least(det, F(1e-30));
    return {cxx * scale,
            cxy * scale,
            cxz * scale,
            (xx * zz - xz * xz) * scale,
            (xy * xz - xx * yz) * scale,
            (xx * yy - xy * xy) * scale};
  }
};

// How values count at the end.
struct Estimate {
  Vec normal;
  Vec scaled;     // albedo times normal
  F variance;     // of residuals
  F prior_share;  // of the view in the normal's slopes, from 0 to 1
};

template <bool kNear>
struct Stereo {
  const StereoJob& job;
  std::size_t at;
  Vec view;
  float* grey;    // [light], kChunk apart, from lane `at` on
  float* weight;  // the same
  F usable;       // values that count
  F shining;      // of them above 0
  F floor;        // the least variance that makes sense for values of this size

  HWY_INLINE Stereo(const StereoJob& j, std::size_t a)
      : job(j),
        at(a),
        view{F(j.view[0]), F(j.view[1]), F(j.view[2])},
        grey(j.scratch + a),
        weight(j.scratch + j.lights.count * kChunk + a) {
    usable = shining = F(0.0);
    F squares(0.0);
    for (std::size_t k = 0; k < job.lights.count; ++k) {
      const std::size_t light = job.values.light[k];
      const float* value = job.values.value + light * job.values.light_stride + at;
      F v(0.0);
      for (std::size_t c = 0; c < 3; ++c) {
        v = multiply_add(F(job.grey[3 * k + c]), F::load(value + c * job.values.channel_stride), v);
      }
      F w(job.grey_intensity[k] > 0.0F ? 1.0 : 0.0);
      if (job.values.weight != nullptr)
        w = w * F::load(job.values.weight + light * job.values.weight_stride + at);
      v = select(w > F(0.0), v, F(0.0));
      v.store(grey + k * kChunk);
      w.store(weight + k * kChunk);
      const auto counts = w > F(0.0);
      usable = usable + select(counts, F(1.0), F(0.0));
      shining = shining + select(counts, select(v > F(0.0), F(1.0), F(0.0)), F(0.0));
      squares = multiply_add(w * v, v, squares);
    }
    floor = at_least(F(1e-14) * squares / at_least(usable, F(1.0)), F(1e-30));
  }

  HWY_INLINE Vec scaled_light(std::size_t k) const {
    if constexpr (!kNear) {
      const float* d = job.scaled_direction + 3 * k;
      return {F(d[0]), F(d[1]), F(d[2])};
    }
    const LightAt<float, kNear> light(job.lights, k, at);
    return light.direction * (light.falloff * F(job.grey_intensity[k]));
  }

  // The albedo along the view direction alone, and the residuals' variance about it.
  HWY_INLINE Estimate along_view() const {
    F top(0.0);
    F bottom(0.0);
    for (std::size_t k = 0; k < job.lights.count; ++k) {
      const F e = at_least(dot(scaled_light(k), view), F(0.0));
      const F w = F::load(weight + k * kChunk);
      top = multiply_add(w * e, F::load(grey + k * kChunk), top);
      bottom = multiply_add(w * e, e, bottom);
    }
    const F albedo = select(bottom > F(0.0), at_least(top, F(0.0)) / at_least(bottom, F(1e-30)), F(0.0));
    Estimate result;
    result.scaled = view * albedo;
    result.normal = view;
    result.prior_share = F(1.0);
    F squares(0.0);
    F weights(0.0);
    for (std::size_t k = 0; k < job.lights.count; ++k) {
      const F w = F::load(weight + k * kChunk);
      const F r = F::load(grey + k * kChunk) - at_least(dot(scaled_light(k), result.scaled), F(0.0));
      squares = multiply_add(w * r, r, squares);
      weights = weights + w;
    }
    result.variance = at_least(squares / at_least(weights, F(1e-30)), floor);
    return result;
  }

  // One step of reweighted least squares for albedo times normal. Residuals are formed anew, so that single
  // precision is enough.
  template <bool kAbsolute>
  HWY_INLINE void step(Estimate& e) const {
    // Of a normal distribution min(z^2, 1) has this mean: the scale by Huber's second proposal.
    const F kClippedMean(0.5161);
    const F inverse_width = F(1.0) / (F(job.robust_width * job.robust_width) * e.variance);
    const F absolute_width = F(0.1) * sqrt(e.variance);
    Symmetric a;
    a.clear();
    Vec g = {F(0.0), F(0.0), F(0.0)};
    F clipped(0.0);
    F weights(0.0);
    for (std::size_t k = 0; k < job.lights.count; ++k) {
      const Vec light = scaled_light(k);
      const F base = F::load(weight + k * kChunk);
      const F shown = dot(light, e.scaled);
      const auto lit = shown > F(0.0);
      const F r = F::load(grey + k * kChunk) - select(lit, shown, F(0.0));
      const F squared = r * r;
      F w;
      if constexpr (kAbsolute) {
        w = absolute_width / at_least(abs(r), absolute_width);
      } else {
        w = F(1.0) / multiply_add(squared, inverse_width, F(1.0));
      }
      w = base * w;
      // A light below the horizon of the texel says nothing of its slope, unless the value is brighter.
      const F counted = select(lit, w, select(r > F(0.0), w, F(0.0)));
      a.add(light, counted);
      g = g + light * (counted * r);
      clipped = multiply_add(base, select(squared < e.variance, squared, e.variance), clipped);
      weights = weights + base;
    }
    const F size = dot(e.scaled, e.scaled);
    const F trace = at_least(a.trace(), F(1e-30));
    const F inverse_trace = F(1.0) / trace;
    const F prior = e.variance / at_least(F(job.slope_deviation * job.slope_deviation) * size, F(1e-30));
    const F ridge = select(prior * inverse_trace < F(1e4), prior * inverse_trace, F(1e4));
    const Vec across = e.scaled - view * dot(e.scaled, view);
    Symmetric m = {a.xx * inverse_trace, a.xy * inverse_trace, a.xz * inverse_trace,
                   a.yy * inverse_trace, a.yz * inverse_trace, a.zz * inverse_trace};
    // Damping keeps the steps finite where lights leave a direction open, and goes with the prior.
    const F damping(1e-5);
    m.add_identity(ridge + damping);
    m.add(view, F(0.0) - ridge);
    const Symmetric inverse = m.inverse();
    const Vec change = inverse.times(g * inverse_trace - across * ridge);
    e.scaled = e.scaled + change;
    e.prior_share = F(0.5) * (ridge + damping) * (inverse.trace() - dot(view, inverse.times(view)));
    e.variance = at_least(clipped / at_least(kClippedMean * weights, F(1e-30)), floor);
  }

  // Unit normal of the scaled one, not turned from the viewer; 1 in *turned where it was.
  HWY_INLINE Vec normal_of(const Vec& scaled, F* turned) const {
    const F length = sqrt(dot(scaled, scaled));
    const Vec unit = scaled * (F(1.0) / at_least(length, F(1e-30)));
    const F facing = dot(unit, view);
    const Vec across = unit - view * facing;
    const F sine = sqrt(dot(across, across));
    const F least(job.least_cosine);
    const F rest = sqrt(F(1.0) - least * least);
    const auto has_sine = sine > F(1e-6);
    const Vec horizon = across * (rest / at_least(sine, F(1e-6))) + view * least;
    const auto away = facing < least;
    *turned = select(away, F(1.0), F(0.0));
    const Vec bent = {select(has_sine, horizon.x, view.x), select(has_sine, horizon.y, view.y),
                      select(has_sine, horizon.z, view.z)};
    return {select(away, bent.x, unit.x), select(away, bent.y, unit.y), select(away, bent.z, unit.z)};
  }

  // The grey albedo of a texel with that normal, and the variance of its residuals, robustly. From least
  // squares on where `albedo` is negative.
  HWY_INLINE F grey_albedo(const Vec& normal, F albedo, int rounds, F* variance) const {
    const F kClippedMean(0.5161);
    const auto is_new = albedo < F(0.0);
    for (int round = 0; round < rounds; ++round) {
      const F robust = F(1.0) / (F(job.robust_width * job.robust_width) * *variance);
      const F inverse_width = round > 0 ? robust : select(is_new, F(0.0), robust);
      F top(0.0);
      F bottom(0.0);
      F clipped(0.0);
      F weights(0.0);
      for (std::size_t k = 0; k < job.lights.count; ++k) {
        const F e = at_least(dot(scaled_light(k), normal), F(0.0));
        const F v = F::load(grey + k * kChunk);
        const F r = v - e * albedo;
        const F base = F::load(weight + k * kChunk);
        const F w = base / multiply_add(r * r, inverse_width, F(1.0));
        top = multiply_add(w * e, v, top);
        bottom = multiply_add(w * e, e, bottom);
        clipped = multiply_add(base, select(r * r < *variance, r * r, *variance), clipped);
        weights = weights + base;
      }
      albedo = at_least(top, F(0.0)) / at_least(bottom, F(1e-30));
      const F next = at_least(clipped / at_least(kClippedMean * weights, F(1e-30)), floor);
      *variance = round > 0 ? next : select(is_new, *variance, next);
    }
    return albedo;
  }

  HWY_INLINE void store_albedo(const Vec& normal, F start, int rounds, F variance, F* sum) const {
    const F last = grey_albedo(normal, start, rounds, &variance);
    const F inverse_width = F(1.0) / (F(job.robust_width * job.robust_width) * variance);
    F top[3] = {F(0.0), F(0.0), F(0.0)};
    F bottom[3] = {F(0.0), F(0.0), F(0.0)};
    F full[3] = {F(0.0), F(0.0), F(0.0)};
    for (std::size_t k = 0; k < job.lights.count; ++k) {
      const LightAt<float, kNear> light(job.lights, k, at);
      const F cosine = at_least(dot(light.direction, normal), F(0.0)) * light.falloff;
      const F r = F::load(grey + k * kChunk) - cosine * F(job.grey_intensity[k]) * last;
      const F w = F::load(weight + k * kChunk) / multiply_add(r * r, inverse_width, F(1.0));
      const std::size_t at_light = job.values.light[k];
      const float* value = job.values.value + at_light * job.values.light_stride + at;
      for (std::size_t c = 0; c < 3; ++c) {
        const F intensity(job.lights.intensity[3 * k + c]);
        const F e = cosine * intensity;
        const F v = select(w > F(0.0), F::load(value + c * job.values.channel_stride), F(0.0));
        top[c] = multiply_add(w * e, v, top[c]);
        bottom[c] = multiply_add(w * e, e, bottom[c]);
        full[c] = multiply_add(w * intensity, intensity, full[c]);
      }
    }
    *sum = F(0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      const F least = at_least(bottom[c], F(bake::kLeastSquaredCosine) * full[c]);
      const F albedo =
          select(bottom[c] > F(1e-30), at_least(top[c], F(0.0)) / at_least(least, F(1e-30)), F(0.0));
      albedo.store(job.albedo + c * kChunk + at);
      *sum = *sum + albedo;
    }
  }

  HWY_INLINE void run() const {
    Estimate e = along_view();
    F state(0.0);
    Vec normal;
    F start(-1.0);
    if (job.given_normals != nullptr) {
      normal = {F::load(job.given_normals + at), F::load(job.given_normals + kChunk + at),
                F::load(job.given_normals + 2 * kChunk + at)};
    } else {
      for (int round = 0; round < job.absolute_rounds; ++round) step<true>(e);
      for (int round = 0; round < job.robust_rounds; ++round) step<false>(e);
      F turned;
      normal = normal_of(e.scaled, &turned);
      state = select(turned > F(0.0), F(2.0), select(e.prior_share > F(0.5), F(1.0), F(0.0)));
      const auto few = shining < F(2.5);
      state = select(few, F(3.0), state);
      // A normal that was not turned comes with its albedo.
      start = select(state < F(1.5), dot(e.scaled, normal), start);
      normal = {select(few, view.x, normal.x), select(few, view.y, normal.y), select(few, view.z, normal.z)};
    }
    normal.x.store(job.normals + at);
    normal.y.store(job.normals + kChunk + at);
    normal.z.store(job.normals + 2 * kChunk + at);
    F sum;
    store_albedo(normal, start, job.given_normals != nullptr ? 11 : 2, e.variance, &sum);
    state = select(sum > F(0.0), state, F(4.0));
    state = select(usable > F(0.0), state, F(5.0));
    state.store(job.state + at);
  }
};

template <bool kNear>
HWY_FLATTEN void stereo_lanes(const StereoJob& job) {
  for (std::size_t at = 0; at < kChunk; at += F::size) Stereo<kNear>(job, at).run();
}

}  // namespace

void stereo_chunk(const StereoJob& job) {
  if (job.lights.stride == 1) return stereo_lanes<false>(job);
  stereo_lanes<true>(job);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
