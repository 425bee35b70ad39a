// The errors of choices of a bake under some lights of a stack.
#ifndef BRDFIT_CLI_COST_STACK_ERRORS_H_
#define BRDFIT_CLI_COST_STACK_ERRORS_H_

#include <cstddef>
#include <span>

#include "bake/error_sums.h"
#include "bake/plan.h"
#include "cli/cost/choice_bake.h"

namespace brdfit::cli {

// Root-mean-square errors over texels and lights, in 1/255 (a value of 1 is 255), each usable value alike.
struct StackErrorSummary {
  double rgb_rmse_255 = 0.0;  // of the three channels together
  double rmse_255 = 0.0;      // of luminance, as `brdfit bake` shows them
  double lit_rmse_255 = 0.0;  // of luminance where the texel faces the light
  double worst_light_rmse_255 = 0.0;
};

// Sums of squares, per light.
struct StackErrorSums {
  bake::ErrorSums luminance;
  bake::ErrorSums rgb;

  explicit StackErrorSums(std::size_t lights)
      : luminance(bake::ErrorSums::of_lights(lights)), rgb(bake::ErrorSums::of_lights(lights)) {}
  StackErrorSummary summary() const;
};

// Texels at which errors are taken, in the size of the whole picture, with all lights.
struct StackTargets {
  const StackInfo& info;
  const TexelBlock& sample;
};

// The errors under `lights` of choices of one base and size. baked: of the sample in that size, whose texels
// hold all that magnifying to the targets needs; plans: those that it was baked by. Textures that were shrunk
// are magnified as a renderer filters them, over the surface in the size of the whole picture, which it has
// anyway.
void add_errors(const StackTargets& targets, const bake::LightChoice& lights, const TexelBlock& baked_sample,
                const LobePlans& plans, const bake::BakeSettings& settings, ChoiceBake& baked,
                std::span<const StackChoice> choices, std::span<StackErrorSums* const> sums);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_ERRORS_H_
