// Ridges tried on a grid.
#include "bake/ridge.h"

#include <cmath>
#include <limits>

#include "bake/solve.h"

namespace brdfit::bake {
namespace {

constexpr double kFirstExponent = -5.0;
constexpr double kLastExponent = 4.0;
constexpr double kStep = 0.5;

}  // namespace

RidgeChoice choose_ridge(const LobeSet& lobes, std::span<const Vec3> directions,
                         const TexelProblem& problem) {
  const std::vector<double> squared = mean_squared_modulation(problem);
  RidgeChoice best;
  best.error = std::numeric_limits<double>::infinity();
  for (double exponent = kFirstExponent; exponent <= kLastExponent; exponent += kStep) {
    const LobeSystem system(lobes, directions, squared, std::pow(10.0, exponent));
    const SolveResult result = solve(system, problem);
    double error = 0.0;
    double without = 0.0;
    for (std::size_t i = 0; i < problem.texels; ++i) {
      error += result.error_with[i];
      without += result.error_without[i];
    }
    if (error < best.error) best = {system.ridge(), error, without};
  }
  return best;
}

}  // namespace brdfit::bake
