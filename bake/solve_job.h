// What the vectorised solve takes: plain arrays, lobes padded to a width that vector code is made for.
#ifndef BRDFIT_BAKE_SOLVE_JOB_H_
#define BRDFIT_BAKE_SOLVE_JOB_H_

#include <cstddef>

namespace brdfit::bake {

// A light whose value alone decides some mix of lobes (its diagonal of the hat matrix is 1 but for this) says
// nothing of how well lobes would predict it: its leave-one-out prediction is that of no lobes.
inline constexpr double kLeastFreedom = 1e-3;

// Lights of a job are padded to a multiple of this, with lobes that are 0.
inline constexpr std::size_t kLightGroup = 8;

inline constexpr std::size_t kMostTexelsAtOnce = 32;

// Texels [first, first + count) of planes with `stride` texels per row. Unknowns are mixes of lobes.
struct SolveJob {
  int width = 0;  // unknowns: 4, 8, 12 or 16
  int lobes = 0;
  std::size_t lights = 0;
  std::size_t stride = 0;
  std::size_t first = 0;
  std::size_t count = 0;
  const float* residual = nullptr;    // [light][texel]
  const float* modulation = nullptr;  // [light][texel]
  const float* weight = nullptr;      // [light][texel]; null: all 1
  const float* basis = nullptr;       // [padded light][width]
  const float* products = nullptr;    // [padded light][width (width + 1) / 2], lower triangles by rows
  const float* penalty = nullptr;     // [width (width + 1) / 2], likewise
  const float* mixes = nullptr;       // [lobe][width]: amplitudes of the unknowns
  float* scratch = nullptr;           // 3 x padded lights x kMostTexelsAtOnce
  bool leave_one_out = true;
  bool select = true;
  float* amplitudes = nullptr;  // [lobe][texel]
  float* confidence = nullptr;
  float* error_with = nullptr;
  float* error_without = nullptr;
};

using SolveFunction = void (*)(const SolveJob&);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_JOB_H_
