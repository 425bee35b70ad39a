// Pairs of directions for tests: random ones, and those that formulas stumble over. Seeded.
#ifndef BRDFIT_TESTS_DIRECTION_PAIRS_H_
#define BRDFIT_TESTS_DIRECTION_PAIRS_H_

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "brdf/vec3.h"

namespace brdfit::testing_support {

struct Pair {
  Vec3 wi;
  Vec3 wo;
};

using Random = std::mt19937_64;

inline double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

inline Vec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

inline Vec3 random_direction(Random& random) {
  return direction(std::acos(uniform(random, 0.0, 1.0)), uniform(random, 0.0, 2 * std::numbers::pi));
}

// The pair of the half/difference angles, in radians, whose half vector has the azimuth phi_h.
inline Pair pair_at(double theta_h, double theta_d, double phi_d, double phi_h = 0.0) {
  const double along = std::sin(theta_d) * std::cos(phi_d);
  const double across = std::sin(theta_d) * std::sin(phi_d);
  const auto turned = [&](double sign) {
    const double x = sign * along * std::cos(theta_h) + std::cos(theta_d) * std::sin(theta_h);
    const double y = sign * across;
    const double z = std::cos(theta_d) * std::cos(theta_h) - sign * along * std::sin(theta_h);
    return Vec3{x * std::cos(phi_h) - y * std::sin(phi_h), x * std::sin(phi_h) + y * std::cos(phi_h), z};
  };
  return {turned(1.0), turned(-1.0)};
}

// Both directions above the horizon: half of them independent, half in narrow lobes about the mirror
// direction.
inline std::vector<Pair> random_pairs(std::size_t count, Random& random) {
  std::vector<Pair> pairs;
  while (pairs.size() < count) {
    Pair pair = {random_direction(random), random_direction(random)};
    if (pairs.size() % 2 == 1) {
      const double theta_h = std::pow(10.0, uniform(random, -6.0, 0.0));
      pair = pair_at(theta_h, uniform(random, 0.0, std::numbers::pi / 2),
                     uniform(random, 0.0, 2 * std::numbers::pi), uniform(random, 0.0, 2 * std::numbers::pi));
    }
    if (pair.wi.z > 0.0 && pair.wo.z > 0.0) pairs.push_back(pair);
  }
  return pairs;
}

// The normal, mirror and retro pairs, grazing and opposite directions, tiny and right angles: both directions
// above the horizon.
inline std::vector<Pair> adversarial_pairs() {
  constexpr double kRight = std::numbers::pi / 2;
  std::vector<Pair> pairs = {{{0, 0, 1}, {0, 0, 1}},          {{1, 0, 1e-9}, {-1, 0, 1e-9}},
                             {{1, 0, 1e-9}, {1, 0, 1e-9}},    {{1, 0, 1e-9}, {0, 1, 1e-9}},
                             {{0, 0, 1}, {0.6, 0.8, 1e-12}},  {{0.6, 0.8, 1e-12}, {0, 0, 1}},
                             {{0, -1, 1e-15}, {0, 1, 1e-15}}, {{1, 0, 6e-17}, {-1, 0, 6e-17}}};
  for (const double theta_h : {0.0, 1e-9, 1e-4, 0.01, 0.5, 1.2, kRight - 1e-3, kRight - 1e-9, kRight}) {
    for (const double theta_d :
         {0.0, 1e-9, 1e-4, 0.01, 0.5, 0.7853, 1.2, kRight - 1e-3, kRight - 1e-9, kRight}) {
      for (const double phi_d : {0.0, 0.3, kRight, 3.0}) {
        const Pair pair = pair_at(theta_h, theta_d, phi_d, 0.4);
        if (pair.wi.z > 0.0 && pair.wo.z > 0.0) pairs.push_back(pair);
      }
    }
  }
  return pairs;
}

// Some of each.
inline std::vector<Pair> test_pairs(std::size_t random_count, Random& random) {
  std::vector<Pair> pairs = random_pairs(random_count, random);
  const std::vector<Pair> hard = adversarial_pairs();
  pairs.insert(pairs.end(), hard.begin(), hard.end());
  return pairs;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_DIRECTION_PAIRS_H_
