// What makes a stack hard to solve for lobes, by name.
#ifndef BRDFIT_BAKE_SOLVE_WARNINGS_H_
#define BRDFIT_BAKE_SOLVE_WARNINGS_H_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bake/solve.h"
#include "bake/texel_problem.h"

namespace brdfit::bake {

// name: stable, for scripts. message: a sentence with what was found and what follows.
struct SolveWarning {
  std::string name;
  std::string message;
};

// In this order, each where it applies:
// - fewer-lights-than-lobes: the ridge decides what lights do not.
// - narrow-lights: all within 15 degrees of their mean, beyond which nothing is known.
// - coincident-lights: some directions are given twice.
// - coincident-lobes: the lobes' Gram matrix without ridge has a condition of 1e5 or more.
// - few-lights-per-texel: 1% of the texels or more are lit by fewer lights than there are lobes.
// - unlit-texels: texels that no light reaches.
// directions: of the lights. lobes: how many there are or were asked for. system: null where no lobes are
// baked; it alone tells whether lobes coincide. problem: a sample of the asset's texels. Throws
// std::invalid_argument if it has not as many lights.
std::vector<SolveWarning> solve_warnings(std::span<const Vec3> directions, std::size_t lobes,
                                         const LobeSystem* system, const TexelProblem& problem);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_WARNINGS_H_
