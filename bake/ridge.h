// How strongly amplitudes are held back: chosen by leave-one-out error.
#ifndef BRDFIT_BAKE_RIDGE_H_
#define BRDFIT_BAKE_RIDGE_H_

#include <span>
#include <vector>

#include "bake/lobes.h"
#include "bake/texel_problem.h"

namespace brdfit::bake {

struct RidgeChoice {
  double ridge = 0.0;  // relative, as LobeSystem takes it
  // Sums over texels and lights of weight x error^2, each light left out in turn.
  double error = 0.0;
  double error_without = 0.0;  // with no lobes at all
  bool helps() const { return error < error_without; }
};

// The ridge of those tried, decades from 1e-8 to 1e4 (where lobes are as good as absent) and half a decade to
// each side of the best, whose leave-one-out error over the problem's texels is least. All texels count with
// their lobes: to count those that lobes do not help as if they had none flatters small ridges. problem: a
// sample of an asset's texels.
RidgeChoice choose_ridge(const LobeSet& lobes, std::span<const Vec3> directions, const TexelProblem& problem);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_RIDGE_H_
