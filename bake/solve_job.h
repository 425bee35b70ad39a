// What the vectorised solve takes: plain arrays, lobes padded to a width that vector code is made for.
#ifndef BRDFIT_BAKE_SOLVE_JOB_H_
#define BRDFIT_BAKE_SOLVE_JOB_H_

#include <cstddef>
#include <cstdint>

namespace brdfit::bake {

// A light whose value alone decides some mix of lobes (its diagonal of the hat matrix is 1 but for this) says
// nothing of how well lobes would predict it: its leave-one-out prediction is that of no lobes.
inline constexpr double kLeastFreedom = 1e-3;

// Lights of a job are padded to a multiple of this, with lobes that are 0.
inline constexpr std::size_t kLightGroup = 8;

inline constexpr std::size_t kMostTexelsAtOnce = 32;

// Values and normals in place of a problem's planes: residuals and modulations are formed as they are needed,
// which costs less than to write and read them. Directional lights alone.
struct ShadeSource {
  const float* values = nullptr;      // [light][channel][texel]
  std::size_t channels = 3;           // of values: 3, or 1 where they are luminances
  bool is_residual = false;           // values are what a render leaves of luminance; else Lambert is taken
                                      // from them
  const float* normals = nullptr;     // [3][texel]
  const float* albedo = nullptr;      // [3][texel]
  const float* direction = nullptr;   // [light][3]
  const float* colour = nullptr;      // [light][3]: intensity x what the channel weighs in luminance
  float mix[3] = {0.0F, 0.0F, 0.0F};  // what channels weigh
  bool albedo_in_modulation = false;
};

// Lights that are near, so that each texel sees them elsewhere and has its own values of the lobes.
struct NearLights {
  const float* directions = nullptr;  // [light][3][texel], unit, towards the light
  const double* lobes = nullptr;      // [lobe][5]: axis, sharpness, cosine of the cut-off
};

// Amplitudes to stored codes, each rounded at its best value given those that are rounded already; as
// bake/codes.h has it for codes of 8 bits.
struct RoundJob {
  const float* steps = nullptr;           // [lobe]: amplitude of one code, > 0
  const float* zeros = nullptr;           // [lobe]: how 0 is stored
  const std::uint32_t* texels = nullptr;  // [texel], as amplitudes: which of the asset's; null: no dither
  std::uint32_t asset_width = 1;
  float dither = 0.0F;             // strength of dither
  float top = 255.0F;              // the largest number that is stored
  std::uint8_t* stored = nullptr;  // [lobe][texel], as amplitudes
};

// Texels [first, first + count) of planes with `stride` texels per row. Unknowns are mixes of lobes.
struct SolveJob {
  int width = 0;  // unknowns: 4, 8, 12 or 16
  int lobes = 0;
  std::size_t lights = 0;
  std::size_t stride = 0;
  std::size_t first = 0;
  std::size_t count = 0;
  const float* residual = nullptr;      // [light][texel]
  const float* modulation = nullptr;    // [light][texel]
  const ShadeSource* source = nullptr;  // in place of the two
  const float* weight = nullptr;        // [light][texel]; null: all 1
  const NearLights* near = nullptr;     // null: directional lights, of which basis and products speak
  const float* basis = nullptr;         // [padded light][width]
  const float* products = nullptr;      // [padded light][width (width + 1) / 2], lower triangles by rows
  const float* penalty = nullptr;       // [width (width + 1) / 2], likewise
  const float* mixes = nullptr;         // [lobe][width]: amplitudes of the unknowns, an upper triangle
  float* scratch = nullptr;  // planes of padded lights x kMostTexelsAtOnce: 3, and `width` where near
  bool leave_one_out = true;
  bool select = true;
  const RoundJob* round = nullptr;  // null: no codes
  float* amplitudes = nullptr;      // [lobe][texel]
  float* confidence = nullptr;
  float* error_with = nullptr;
  float* error_without = nullptr;
};

using SolveFunction = void (*)(const SolveJob&);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_JOB_H_
