// Normals and albedo of texels from their values under many lights, for surfaces that are Lambert's in the
// main (Woodham 1980; robust: iteratively reweighted least squares, Holland and Welsch 1977).
#ifndef BRDFIT_BAKE_PHOTOMETRIC_STEREO_H_
#define BRDFIT_BAKE_PHOTOMETRIC_STEREO_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "bake/chunk.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// What is known of a texel.
enum class TexelState : std::uint8_t {
  kOk,
  kWeakNormal,  // lights too alike, or values too noisy, for the normal: it comes from the view for the most
                // part
  kTurned,      // the values ask for a normal away from the viewer: it was turned to the horizon
  kFewLights,   // fewer than three lights usable: the normal is the view, the albedo alone is estimated
  kBlack,       // no light in any usable value: albedo 0
  kUnlit,       // no usable value: albedo 0
};
std::string_view name_of(TexelState state);

// Of a block's texels.
struct Surface {
  std::vector<float> normals;  // [3][texel], unit, n.view > 0
  // [channel][texel], >= 0; above 1 where texels are brighter than white; less than values ask for where all
  // lights graze the texel (kLeastSquaredCosine).
  std::vector<float> albedo;
  std::vector<TexelState> state;

  std::size_t count() const { return state.size(); }
};

struct StereoOptions {
  // Rounds of reweighting: by 1/|residual| first, which finds the majority, then by Cauchy's weights.
  int absolute_rounds = 8;
  int robust_rounds = 8;
  // Half of its weight is lost to a value whose residual is this many standard deviations.
  double robust_width = 2.5;
  // Standard deviation of a normal's slopes against the view direction before anything is seen: how far a
  // texel that says little may lean.
  double slope_deviation = 0.5;
  // Normals are at most this close to the horizon of the viewer.
  double least_cosine = 0.02;

  bool is_valid(std::string* why) const;
};

// Normals and albedo from the given lights; where the block has normals the albedo alone, where it has both
// they are handed on. Shadows and highlights lose weight by their residuals; the block's weights multiply in.
//
// The normal's prior is the view direction with Gaussian slopes: its share comes from the residuals' own
// variance, so it fades as values agree, and it does not depend on the unit of the values. Lights may have
// any colour. Every output is finite. Deterministic; parallel over texels.
// Throws std::invalid_argument where sizes disagree, a light is not in the stack, or options are invalid.
Surface photometric_stereo(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                           const StereoOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_PHOTOMETRIC_STEREO_H_
