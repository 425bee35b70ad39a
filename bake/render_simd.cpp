// Vectorised renders of materials under lights, one texel per lane. Compiled once for every instruction set.
#include "bake/chunk_jobs.h"
#include "bake/chunk_lanes.h"
#include "brdf/simd/model_lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using bake::AffineJob;
using bake::BaseColourJob;
using bake::kChunk;
using bake::ProjectionJob;
using bake::RenderJob;

// A texel's frame; tangents after Duff et al. (2017).
template <class S>
struct Frame {
  using V = Lanes<S>;
  VecOf<S> tangent;
  VecOf<S> bitangent;
  VecOf<S> normal;

  explicit HWY_INLINE Frame(const VecOf<S>& n) : normal(n) {
    const V one(1.0);
    const V sign = select(n.z < V(0.0), V(-1.0), one);
    const V a = V(-1.0) / (sign + n.z);
    const V b = n.x * n.y * a;
    tangent = {one + sign * n.x * n.x * a, sign * b, V(0.0) - sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, V(0.0) - n.y};
  }
  HWY_INLINE VecOf<S> local(const VecOf<S>& v) const {
    return {dot(tangent, v), dot(bitangent, v), dot(normal, v)};
  }
};

// Calls use(light, channel, offset, slope) with radiances per unit of the light's own intensity in the
// channel.
template <class S, template <class> class ModelLanes, bool kNear, class Use>
HWY_INLINE void for_each_light(const AffineJob<S>& job, const ModelLanes<S>& black,
                               const ModelLanes<S>& white, std::size_t at, const Use& use) {
  using V = Lanes<S>;
  const V pi(BRDF_PI);
  const Frame<S> frame(load_rows(job.normals, at));
  const VecOf<S> wo = frame.local({V(job.view[0]), V(job.view[1]), V(job.view[2])});
  for (std::size_t k = 0; k < job.lights.count; ++k) {
    const LightAt<S, kNear> light(job.lights, k, at);
    const VecOf<S> wi = frame.local(light.direction);
    const kernel::Geometry<V> g = kernel::geometry_from_directions(wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
    kernel::GeometryLogs<V> logs = {V(0.0), V(0.0), V(0.0), V(0.0)};
    if constexpr (ModelLanes<S>::uses_logs) logs = kernel::geometry_logs(g);
    const auto terms = white.terms(g, logs);
    const V scale = pi * light.falloff;
    for (int c = 0; c < 3; ++c) {
      const V offset = kernel::above_horizon(black.combine(c, terms), g.cos_i, g.cos_o) * scale;
      const V sum = kernel::above_horizon(white.combine(c, terms), g.cos_i, g.cos_o) * scale;
      use(k, static_cast<std::size_t>(c), offset, sum - offset);
    }
  }
}

template <class S, template <class> class ModelLanes, bool kNear>
HWY_FLATTEN void affine_lanes(const AffineJob<S>& job) {
  using V = Lanes<S>;
  const ModelLanes<S> black(job.black);
  const ModelLanes<S> white(job.white);
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    for_each_light<S, ModelLanes, kNear>(job, black, white, at,
                                         [&](std::size_t k, std::size_t c, V offset, V slope) HWY_ATTR {
                                           const V intensity(job.lights.intensity[3 * k + c]);
                                           (offset * intensity).store(job.offset + (3 * k + c) * kChunk + at);
                                           (slope * intensity).store(job.slope + (3 * k + c) * kChunk + at);
                                         });
  }
}

template <template <class> class ModelLanes, bool kNear>
HWY_FLATTEN void render_lanes(const RenderJob& job) {
  using V = Lanes<float>;
  const ModelLanes<float> black(job.affine.black);
  const ModelLanes<float> white(job.affine.white);
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    const VecOf<float> albedo = load_rows(job.albedo, at);
    const V base[3] = {albedo.x, albedo.y, albedo.z};
    for_each_light<float, ModelLanes, kNear>(
        job.affine, black, white, at, [&](std::size_t k, std::size_t c, V offset, V slope) HWY_ATTR {
          const V value = multiply_add(slope, base[c], offset) * V(job.affine.lights.intensity[3 * k + c]);
          value.store(job.out + k * job.light_stride + c * job.channel_stride + at);
        });
  }
}

template <bool kNear>
HWY_FLATTEN void lambert_lanes(const RenderJob& job) {
  using V = Lanes<float>;
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    const VecOf<float> normal = load_rows(job.affine.normals, at);
    const VecOf<float> albedo = load_rows(job.albedo, at);
    const V base[3] = {albedo.x, albedo.y, albedo.z};
    for (std::size_t k = 0; k < job.affine.lights.count; ++k) {
      const LightAt<float, kNear> light(job.affine.lights, k, at);
      const V shown = at_least(dot(light.direction, normal), V(0.0)) * light.falloff;
      for (std::size_t c = 0; c < 3; ++c) {
        const V value = shown * base[c] * V(job.affine.lights.intensity[3 * k + c]);
        value.store(job.out + k * job.light_stride + c * job.channel_stride + at);
      }
    }
  }
}

// Robust least squares for one number per texel and channel, all else known.
HWY_FLATTEN void solve_base_colour(const BaseColourJob& job) {
  using V = Lanes<float>;
  constexpr int kRounds = 5;
  const std::size_t lights = job.affine.lights.count;
  const V inverse_width(job.robust_width > 0.0F ? 1.0F / (job.robust_width * job.robust_width) : 0.0F);
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    for (std::size_t c = 0; c < 3; ++c) {
      V base(0.0);
      for (int round = 0; round < kRounds; ++round) {
        V top(0.0);
        V bottom(0.0);
        V full(0.0);
        for (std::size_t k = 0; k < lights; ++k) {
          const std::size_t light = job.values.light[k];
          const float* value =
              job.values.value + light * job.values.light_stride + c * job.values.channel_stride;
          const V slope = V::load(job.affine.slope + (3 * k + c) * kChunk + at);
          const V intensity(job.affine.lights.intensity[3 * k + c]);
          V w(1.0);
          if (job.values.weight != nullptr) {
            w = V::load(job.values.weight + light * job.values.weight_stride + at);
          }
          const V value_here = select(w > V(0.0), V::load(value + at), V(0.0));
          const V rest = value_here - V::load(job.affine.offset + (3 * k + c) * kChunk + at);
          const V r = rest - slope * base;
          if (round > 0) w = w / sqrt(multiply_add(r * r, inverse_width, V(1.0)));
          top = multiply_add(w * slope, rest, top);
          bottom = multiply_add(w * slope, slope, bottom);
          full = multiply_add(w * intensity, intensity, full);
        }
        bottom = at_least(bottom, V(bake::kLeastSquaredCosine) * full);
        base = at_least(top, V(0.0)) / at_least(bottom, V(1e-30));
      }
      base.store(job.base_colour + c * kChunk + at);
    }
  }
}

// Values without weight leave a residual too, which nobody looks at.
HWY_FLATTEN void leave_luminance(const BaseColourJob& job) {
  using V = Lanes<float>;
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    const VecOf<float> colour = load_rows(job.base_colour, at);
    const V base[3] = {colour.x, colour.y, colour.z};
    for (std::size_t k = 0; k < job.affine.lights.count; ++k) {
      const float* value = job.values.value + job.values.light[k] * job.values.light_stride + at;
      V left(0.0);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t row = (3 * k + c) * kChunk + at;
        const V render =
            multiply_add(V::load(job.affine.slope + row), base[c], V::load(job.affine.offset + row));
        left = multiply_add(V(job.mix[c]), V::load(value + c * job.values.channel_stride) - render, left);
      }
      left.store(job.residual + k * job.residual_stride + at);
    }
  }
}

// Base colours by reweighted least squares, then residuals r sqrt(2 / (sqrt(1 + t^2) + 1)) with t = r /
// width, whose squares are twice the pseudo-Huber costs.
HWY_FLATTEN void project(const ProjectionJob& job) {
  using V = Lanes<double>;
  constexpr int kRounds = 3;
  const std::size_t lights = job.affine.lights.count;
  const V one(1.0);
  const V inverse_squared(1.0 / (job.robust_width * job.robust_width));
  for (std::size_t at = 0; at < kChunk; at += V::size) {
    for (std::size_t c = 0; c < 3; ++c) {
      V base(0.0);
      for (int round = 0; round < kRounds; ++round) {
        V top(0.0);
        V bottom(0.0);
        V full(0.0);
        for (std::size_t k = 0; k < lights; ++k) {
          const std::size_t row = (3 * k + c) * kChunk + at;
          const V root = V::load(job.root_weight + k * kChunk + at);
          const V slope = V::load(job.affine.slope + row);
          const V rest = V::load(job.value + row) - V::load(job.affine.offset + row);
          const V intensity(job.affine.lights.intensity[3 * k + c]);
          V w = root * root;
          if (round > 0) {
            const V r = root * (rest - slope * base);
            w = w / sqrt(multiply_add(r * r, inverse_squared, one));
          }
          top = multiply_add(w * slope, rest, top);
          bottom = multiply_add(w * slope, slope, bottom);
          full = multiply_add(w * intensity, intensity, full);
        }
        bottom = at_least(bottom, V(bake::kLeastSquaredCosine) * full);
        base = at_least(top, V(0.0)) / at_least(bottom, V(1e-30));
      }
      for (std::size_t k = 0; k < lights; ++k) {
        const std::size_t row = (3 * k + c) * kChunk + at;
        const V root = V::load(job.root_weight + k * kChunk + at);
        const V rest = V::load(job.value + row) - V::load(job.affine.offset + row);
        const V r = root * (rest - V::load(job.affine.slope + row) * base);
        const V above = sqrt(multiply_add(r * r, inverse_squared, one)) + one;
        (r * sqrt(V(2.0) / above)).store(job.residual + row);
      }
    }
  }
}

template <class S, bool kNear>
void affine_of(const AffineJob<S>& job) {
  if (job.white.model == 0) return affine_lanes<S, LambertGgxLanesOf, kNear>(job);
  if (job.white.model == 1) return affine_lanes<S, BurleyLanesOf, kNear>(job);
  affine_lanes<S, CallistoLanesOf, kNear>(job);
}

template <class S>
void affine_any(const AffineJob<S>& job) {
  if (job.lights.stride == 1) return affine_of<S, false>(job);
  affine_of<S, true>(job);
}

template <bool kNear>
void render_of(const RenderJob& job) {
  if (job.lambert) return lambert_lanes<kNear>(job);
  if (job.affine.white.model == 0) return render_lanes<LambertGgxLanesOf, kNear>(job);
  if (job.affine.white.model == 1) return render_lanes<BurleyLanesOf, kNear>(job);
  render_lanes<CallistoLanesOf, kNear>(job);
}

}  // namespace

void projection_chunk(const ProjectionJob& job) {
  affine_any(job.affine);
  project(job);
}

void render_chunk(const RenderJob& job) {
  if (job.affine.lights.stride == 1) return render_of<false>(job);
  render_of<true>(job);
}

void base_colour_chunk(const BaseColourJob& job) {
  affine_any(job.affine);
  if (!job.is_given) solve_base_colour(job);
  if (job.residual != nullptr) leave_luminance(job);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
