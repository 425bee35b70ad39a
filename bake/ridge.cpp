// Ridges tried on a grid.
#include "bake/ridge.h"

#include <cmath>
#include <limits>

#include "bake/solve.h"

namespace brdfit::bake {
namespace {

// Decades that are tried; then half a decade to each side of the best.
constexpr int kFirstDecade = -8;
constexpr int kLastDecade = 4;

}  // namespace

RidgeChoice choose_ridge(const LobeSet& lobes, std::span<const Vec3> directions,
                         const TexelProblem& problem) {
  const std::vector<double> squared = mean_squared_modulation(problem);
  RidgeChoice best;
  best.error = std::numeric_limits<double>::infinity();
  double best_exponent = kLastDecade;
  const auto attempt = [&](double exponent) {
    const LobeSystem system(lobes, directions, squared, std::pow(10.0, exponent));
    const SolveResult result = solve(system, problem);
    double error = 0.0;
    double without = 0.0;
    for (std::size_t i = 0; i < problem.texels; ++i) {
      error += result.error_with[i];
      without += result.error_without[i];
    }
    if (error >= best.error) return;
    best = {system.ridge(), error, without};
    best_exponent = exponent;
  };
  for (int decade = kFirstDecade; decade <= kLastDecade; ++decade) attempt(decade);
  const double centre = best_exponent;
  for (const double exponent : {centre - 0.5, centre + 0.5}) attempt(exponent);
  return best;
}

}  // namespace brdfit::bake
