// Materials whose directional albedo docs/stability.md states: those that promise to give back no more light
// than they get, and those that do not.
#ifndef BRDFIT_TESTS_STABILITY_ENERGY_H_
#define BRDFIT_TESTS_STABILITY_ENERGY_H_

#include <array>
#include <string>
#include <vector>

#include "brdf/material.h"

namespace brdfit::stability {

struct EnergyCase {
  std::string id;
  std::vector<Material> materials;  // the largest of them counts
  bool promises = false;            // an albedo of at most 1
};
const std::vector<EnergyCase>& energy_cases();

// Angles of wo from the normal at which the albedo is taken.
inline constexpr std::array<int, 4> kEnergyAnglesDeg = {0, 45, 80, 89};

// The largest directional albedo of any material and channel, per angle.
std::array<double, kEnergyAnglesDeg.size()> albedos_of(const EnergyCase& one);

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_ENERGY_H_
