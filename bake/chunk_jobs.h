// Plain data handed to the vector code of the bake: a chunk of texels, its lights and its values.
#ifndef BRDFIT_BAKE_CHUNK_JOBS_H_
#define BRDFIT_BAKE_CHUNK_JOBS_H_

#include <cstddef>
#include <cstdint>

#include "brdf/simd/jobs.h"

namespace brdfit::bake {

// Texels that vector code works on at a time: their values under all lights stay in a cache.
inline constexpr std::size_t kChunk = simd::kBlock;

// Albedos and base colours are not taken from texels that all lights graze: in their least squares, the
// lights' mean squared cosine counts as at least this.
inline constexpr double kLeastSquaredCosine = 4e-4;

// Lights as they reach the texels of a chunk. S: float or double.
template <class S>
struct LightColumnsOf {
  std::size_t count = 0;
  std::size_t stride = 1;        // 1: the same for all texels; kChunk: one for each
  const S* direction = nullptr;  // [light][3][stride], unit, towards the light
  const S* falloff = nullptr;    // [light][stride]
  const S* intensity = nullptr;  // [light][3], linear
};
using LightColumns = LightColumnsOf<float>;

// Values of a chunk: those of light k stand at value + light[k] * light_stride + channel * channel_stride.
struct ValueColumns {
  const float* value = nullptr;
  std::size_t light_stride = 0;
  std::size_t channel_stride = 0;
  const float* weight = nullptr;  // of light k at weight + light[k] * weight_stride; null: all 1
  std::size_t weight_stride = 0;
  const std::uint32_t* light = nullptr;  // [count]
};

// Robust photometric stereo over a chunk; see bake/photometric_stereo.h.
struct StereoJob {
  LightColumns lights;
  ValueColumns values;
  const float* grey = nullptr;              // [light][3]: factors that make a channel's value grey
  const float* grey_intensity = nullptr;    // [light]: what a white texel that faces the light would show
  const float* scaled_direction = nullptr;  // [light][3] of directional lights: direction x grey_intensity
  const float* given_normals = nullptr;     // [3][kChunk] or null
  float view[3] = {0.0F, 0.0F, 1.0F};
  int absolute_rounds = 0;
  int robust_rounds = 0;
  float robust_width = 0.0F;
  float slope_deviation = 0.0F;
  float least_cosine = 0.0F;
  float* scratch = nullptr;  // [2][light][kChunk]
  float* normals = nullptr;  // [3][kChunk]
  float* albedo = nullptr;   // [3][kChunk]
  float* state = nullptr;    // [kChunk], values of TexelState
};
using StereoFunction = void (*)(const StereoJob&);

// A material over a chunk. It is affine in its base colour, so that under light k
//   radiance = offset[k] + slope[k] base_colour    per channel.
template <class S>
struct AffineJob {
  LightColumnsOf<S> lights;
  simd::Coefficients black;    // the material with base colour 0
  simd::Coefficients white;    // and 1
  const S* normals = nullptr;  // [3][kChunk]
  S view[3] = {S(0), S(0), S(1)};
  S* offset = nullptr;  // [light][channel][kChunk]
  S* slope = nullptr;
};

// A render over a chunk; see bake/base_model.h.
struct RenderJob {
  AffineJob<float> affine;
  bool lambert = false;           // slope only, of the white Lambert surface
  const float* albedo = nullptr;  // [3][kChunk]
  float* out = nullptr;  // of light k and a channel at out + k * light_stride + channel * channel_stride
  std::size_t light_stride = 0;
  std::size_t channel_stride = 0;
};

// Base colours of a chunk in closed form.
struct BaseColourJob {
  AffineJob<float> affine;
  ValueColumns values;
  float robust_width = 0.0F;
  float* base_colour = nullptr;  // [3][kChunk]
  bool is_given = false;         // base_colour is not solved but read
  // What the render of these base colours leaves of the values' luminance, [light] residual_stride apart;
  // null: not asked for.
  float* residual = nullptr;
  std::size_t residual_stride = 0;
  float mix[3] = {0.0F, 0.0F, 0.0F};  // what channels weigh in luminance
};

// Residuals of a chunk with base colours solved in closed form; see bake/shared_material.cpp.
struct ProjectionJob {
  AffineJob<double> affine;
  const double* value = nullptr;        // [light][channel][kChunk]
  const double* root_weight = nullptr;  // [light][kChunk]
  double robust_width = 1.0;
  double* residual = nullptr;  // [light][channel][kChunk]
};

using ProjectionFunction = void (*)(const ProjectionJob&);
using RenderFunction = void (*)(const RenderJob&);
using BaseColourFunction = void (*)(const BaseColourJob&);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CHUNK_JOBS_H_
