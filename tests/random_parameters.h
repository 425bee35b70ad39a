// Random materials for the tests of models: anywhere in the ranges, often at their ends. Seeded.
#ifndef BRDFIT_TESTS_RANDOM_PARAMETERS_H_
#define BRDFIT_TESTS_RANDOM_PARAMETERS_H_

#include <algorithm>
#include <string>

#include "brdf/material.h"
#include "tests/direction_pairs.h"

namespace brdfit::testing_support {

// Inside the range; intensities up to 256 are drawn evenly by magnitude.
inline double interior_value(const ParameterInfo& info, Random& random) {
  if (info.upper > 100.0) return std::exp(uniform(random, std::log(0.05), std::log(info.upper)));
  return uniform(random, info.lower, info.upper);
}

inline double any_value(const ParameterInfo& info, Random& random) {
  const double which = uniform(random, 0.0, 1.0);
  if (which < 0.1) return info.lower;
  if (which < 0.2) return info.upper;
  if (which < 0.3) return info.default_value;
  return interior_value(info, random);
}

// Every parameter at random; effects as given.
inline Material random_material(Model model, Effects effects, Random& random) {
  Material material(model);
  material.set_effects(effects);
  for (const ParameterInfo& info : parameters_of(model)) {
    for (int c = 0; c < info.components; ++c) {
      material.values()[static_cast<std::size_t>(info.offset + c)] = any_value(info, random);
    }
    if (info.kind == Kind::kTint) {
      material.values()[static_cast<std::size_t>(info.offset) + random() % 3] = 1.0;
    }
  }
  return material;
}

// Every parameter strictly inside its range.
inline Material interior_material(Model model, Effects effects, Random& random) {
  Material material(model);
  material.set_effects(effects);
  for (const ParameterInfo& info : parameters_of(model)) {
    for (int c = 0; c < info.components; ++c) {
      material.values()[static_cast<std::size_t>(info.offset + c)] = interior_value(info, random);
    }
  }
  return material;
}

// A set of effects that is a subset of the model's, by its index in [0, 2^effects).
inline Effects effect_subset(Model model, unsigned index) {
  Effects subset;
  for (const Effect effect : all_effects()) {
    if ((effects_of(model).bits() & static_cast<std::uint32_t>(effect)) == 0) continue;
    if ((index & 1U) != 0) subset = subset.with(effect);
    index >>= 1U;
  }
  return subset;
}

// What a failing comparison shows.
inline std::string describe(const Material& material, const Pair& pair) {
  std::string text(name_of(material.model()));
  for (const ParameterInfo& info : parameters_of(material.model())) {
    text += "\n  " + std::string(info.name) + " " + std::to_string(material.colour(info.name)[0]);
  }
  for (const Effect effect : all_effects()) {
    if (material.effects().has(effect)) text += "\n  effect " + std::string(effect_name(effect));
  }
  for (const Vec3& w : {pair.wi, pair.wo}) {
    text += "\n  " + std::to_string(w.x) + " " + std::to_string(w.y) + " " + std::to_string(w.z);
  }
  return text;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_RANDOM_PARAMETERS_H_
