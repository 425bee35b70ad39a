// Checks of a sample, each with its sentence.
#include "bake/solve_warnings.h"

#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

namespace brdfit::bake {
namespace {

constexpr double kNarrowDegrees = 15.0;
constexpr double kHighCondition = 1e5;
constexpr double kManyTexels = 0.01;
// Directions closer than this (the distance's square) are one.
constexpr double kSameDirection = 1e-12;

std::size_t coincident_lights(std::span<const Vec3> directions) {
  std::size_t count = 0;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    for (std::size_t other = 0; other < l; ++other) {
      const double x = directions[l].x - directions[other].x;
      const double y = directions[l].y - directions[other].y;
      const double z = directions[l].z - directions[other].z;
      if (x * x + y * y + z * z > kSameDirection) continue;
      ++count;
      break;
    }
  }
  return count;
}

struct Lit {
  std::size_t by_few = 0;
  std::size_t by_none = 0;
};

Lit count_lit(const TexelProblem& problem, std::size_t lobes) {
  Lit lit;
  for (std::size_t i = 0; i < problem.texels; ++i) {
    std::size_t lights = 0;
    for (std::size_t l = 0; l < problem.lights; ++l) {
      if (problem.modulation[problem.at(l, i)] > 0.0F && problem.weight_of(l, i) > 0.0F) ++lights;
    }
    if (lights == 0) {
      ++lit.by_none;
    } else if (lights < lobes) {
      ++lit.by_few;
    }
  }
  return lit;
}

}  // namespace

std::vector<SolveWarning> solve_warnings(std::span<const Vec3> directions, std::size_t lobes,
                                         const LobeSystem* system, const TexelProblem& problem) {
  const std::size_t lights = directions.size();
  if (problem.lights != lights) throw std::invalid_argument("solve_warnings: the problem has other lights");
  std::vector<SolveWarning> warnings;
  const auto warn = [&](const char* name, std::string message) {
    warnings.push_back({name, std::move(message)});
  };
  if (lights < lobes) {
    warn("fewer-lights-than-lobes",
         fmt::format("{} lights cannot determine {} lobes: the ridge decides the rest", lights, lobes));
  }
  const double degrees = cap_of(directions).angle * 180.0 / std::numbers::pi;
  if (degrees < kNarrowDegrees) {
    warn("narrow-lights",
         fmt::format("all lights lie within {:.1f} degrees of their mean: lobes know nothing beyond",
                     degrees));
  }
  if (const std::size_t twice = coincident_lights(directions); twice > 0) {
    warn("coincident-lights", fmt::format("{} lights have the direction of another", twice));
  }
  if (system != nullptr && system->condition() >= kHighCondition) {
    warn("coincident-lobes",
         fmt::format(
             "under these lights lobes are nearly the same (condition {:.1e}): amplitudes depend on the "
             "ridge and lose accuracy in few bits",
             system->condition()));
  }
  const Lit lit = count_lit(problem, lobes);
  if (problem.texels > 0 &&
      static_cast<double>(lit.by_few) >= kManyTexels * static_cast<double>(problem.texels)) {
    warn("few-lights-per-texel",
         fmt::format("{:.1f}% of the texels are lit by fewer lights than there are lobes",
                     100.0 * static_cast<double>(lit.by_few) / static_cast<double>(problem.texels)));
  }
  if (lit.by_none > 0) {
    warn("unlit-texels", fmt::format("{} of {} texels are reached by no light: they get no lobes",
                                     lit.by_none, problem.texels));
  }
  return warnings;
}

}  // namespace brdfit::bake
