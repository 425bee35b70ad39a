// The time of relighting texels at run time: the base model's render and the correction on it.
#ifndef BRDFIT_CLI_COST_STACK_EVALUATION_H_
#define BRDFIT_CLI_COST_STACK_EVALUATION_H_

#include <cstddef>
#include <vector>

#include "bake/base_model.h"
#include "bake/held_correction.h"
#include "cli/cost/choice_bake.h"

namespace brdfit::cli {

// Texels of one choice as a renderer holds them, and some lights. The render is vector code, the correction
// single precision from what is stored (bake/held_correction.h); both run on the calling thread.
class StackEvaluation {
 public:
  // surface: of the texels of `stored`, which are repeated until there are enough for a clock.
  StackEvaluation(const StackInfo& info, const bake::BaseModel& base, const StackChoice& choice,
                  const Stored& stored, const bake::Surface& surface, bool albedo_in_modulation);

  // Relights all texels under each light once and gives the CPU nanoseconds of one texel and light.
  double nanoseconds();

  // The same with the correction in double precision (bake::relight), from amplitudes that are decoded
  // already.
  double nanoseconds_in_double();

  const RealisAsset& asset() const { return asset_; }
  const bake::HeldTexels& held() const { return held_; }
  const std::vector<RealisLight>& lights() const { return lights_; }
  // Of the last light, [channel][texel].
  const std::vector<float>& radiance() const { return radiance_; }

 private:
  template <class Relight>
  double timed(const Relight& relight);

  bake::BaseModel base_;
  StackInfo info_;
  RealisAsset asset_;
  bake::HeldTexels held_;
  bake::RunTimeTexels texels_;
  TexelBlock block_;
  std::vector<RealisLight> lights_;
  std::vector<float> radiance_;
  std::vector<float> correction_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_EVALUATION_H_
