// What in a capture itself makes a bake hard, by name: where its lights are, what its pixels hold.
#ifndef BRDFIT_BAKE_CAPTURE_WARNINGS_H_
#define BRDFIT_BAKE_CAPTURE_WARNINGS_H_

#include <vector>

#include "bake/solve_warnings.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// In this order, each where it applies:
// - lights-on-the-horizon: within 3 degrees of the picture's plane, where n.l goes to 0 and noise does not.
// - unusable-values: 1% of the values or more have weight 0 (not finite, saturated or masked).
// - values-far-above-one: some exceed 100 times what a white surface shows.
// - black-texels: texels that are black under every light that counts.
// - uneven-gains: lights at least 10% brighter or dimmer than the stack says. gains_known: whether gains are
//   already in the intensities, and nothing is looked for.
// sample: some hundred texels with all the lights of info.
std::vector<SolveWarning> capture_warnings(const StackInfo& info, const TexelBlock& sample, bool gains_known);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CAPTURE_WARNINGS_H_
