// Made-up problems of the baker, with known answers.
#ifndef BRDFIT_TESTS_LOBE_DATA_H_
#define BRDFIT_TESTS_LOBE_DATA_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "bake/lobes.h"
#include "bake/texel_problem.h"

namespace brdfit::bake_data {

// Lights spread evenly over a cap around +z (angle in radians).
inline std::vector<Vec3> cap_of_lights(std::size_t count, double angle) {
  std::vector<Vec3> directions;
  for (std::size_t l = 0; l < count; ++l) {
    const double z =
        1.0 - (1.0 - std::cos(angle)) * (static_cast<double>(l) + 0.5) / static_cast<double>(count);
    const double phi = 2.399963229728653 * static_cast<double>(l);
    const double s = std::sqrt(1.0 - z * z);
    directions.push_back({s * std::cos(phi), s * std::sin(phi), z});
  }
  return directions;
}

inline std::vector<Vec3> dome(std::size_t count) {
  return cap_of_lights(count, 1.35);
}

// Modulations of texels whose normals lie up to `tilt` (radians) off +z.
inline bake::TexelProblem lit_texels(const std::vector<Vec3>& directions, std::size_t texels, double tilt,
                                     std::uint64_t seed) {
  bake::TexelProblem problem;
  problem.lights = directions.size();
  problem.texels = texels;
  problem.residual.assign(directions.size() * texels, 0.0F);
  problem.modulation.resize(directions.size() * texels);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (std::size_t i = 0; i < texels; ++i) {
    const double theta = tilt * std::sqrt(uniform(random));
    const double phi = 2.0 * std::numbers::pi * uniform(random);
    const Vec3 n = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    for (std::size_t l = 0; l < directions.size(); ++l) {
      const Vec3& d = directions[l];
      problem.modulation[problem.at(l, i)] =
          static_cast<float>(std::max(0.0, n.x * d.x + n.y * d.y + n.z * d.z));
    }
  }
  return problem;
}

// Adds modulation x lobes x random amplitudes in [-size, size] to the residual, and returns the amplitudes,
// [lobe][texel].
inline std::vector<float> add_lobes(bake::TexelProblem& problem, const std::vector<Vec3>& directions,
                                    const LobeSet& lobes, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  std::vector<float> amplitudes(lobes.size() * problem.texels);
  for (float& a : amplitudes) a = static_cast<float>(size) * uniform(random);
  for (std::size_t l = 0; l < problem.lights; ++l) {
    for (std::size_t i = 0; i < problem.texels; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < lobes.size(); ++k) {
        sum += amplitudes[k * problem.texels + i] * eval(lobes[k], problem.direction(l, i, directions[l]));
      }
      float& e = problem.residual[problem.at(l, i)];
      e = static_cast<float>(e + problem.modulation[problem.at(l, i)] * sum);
    }
  }
  return amplitudes;
}

inline void add_noise(bake::TexelProblem& problem, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, size);
  for (float& e : problem.residual) e = static_cast<float>(e + normal(random));
}

// Lobes as no uniform set has them.
inline LobeSet odd_lobes() {
  return {{{0.6, 0.0, 0.8}, 9.0, -0.2},
          {{-0.48, 0.64, 0.6}, 5.0, -0.5},
          {{0.0, -0.6, 0.8}, 14.0, 0.1},
          {{0.0, 0.0, 1.0}, 3.0, -0.9}};
}

// Texels whose residual is made of lobes with random amplitudes, and of noise.
inline bake::TexelProblem made_of(const LobeSet& lobes, const std::vector<Vec3>& directions,
                                  std::size_t texels, double noise) {
  bake::TexelProblem problem = lit_texels(directions, texels, 0.5, 1);
  add_lobes(problem, directions, lobes, 1.0, 2);
  if (noise > 0.0) add_noise(problem, noise, 3);
  return problem;
}

}  // namespace brdfit::bake_data

#endif  // BRDFIT_TESTS_LOBE_DATA_H_
