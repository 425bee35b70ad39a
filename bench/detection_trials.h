// Made-up materials in which one group has a strength that is known, and what the choice of effects finds.
#ifndef BRDFIT_BENCH_DETECTION_TRIALS_H_
#define BRDFIT_BENCH_DETECTION_TRIALS_H_

#include <cstddef>
#include <cstdint>

#include "brdf/material.h"
#include "fit/groups.h"

namespace brdfit::bench {

// The strength of a group: how much the held-out error rises when the material is refitted without it, in
// units of the threshold of the choice.
inline constexpr double kLeastStrength = 0.1;
inline constexpr double kMostStrength = 10.0;

struct Trial {
  Model model = Model::kCallisto;
  std::size_t group = 0;  // whose strength it is
  double strength = 0.0;
  fit::Groups truth;
  fit::Groups chosen;

  // Whether the strength could be brought into the range; else nothing was chosen.
  bool is_in_range() const { return strength >= kLeastStrength && strength < kMostStrength; }
};

// A random material of which half of the other groups are part, at whatever strength they have. The group in
// question, an effect without its refinements or a refinement, is weakened towards the value at which it does
// nothing, until its strength is near one drawn evenly in its logarithm from the range above. 1% noise; the
// same seed gives the same trial.
Trial run_trial(Model model, std::size_t group, std::uint64_t seed);

}  // namespace brdfit::bench

#endif  // BRDFIT_BENCH_DETECTION_TRIALS_H_
