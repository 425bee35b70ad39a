// Materials weakened in one group.
#include "bench/detection_trials.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

#include "tests/selection_study.h"

namespace brdfit::bench {
namespace {

using testing_support::noisy_table;
using testing_support::select_all;
using testing_support::validation_of;

constexpr double kNoise = 0.01;

// Attempts at a strength, and how close (as a factor) is close enough.
constexpr int kAttempts = 4;
constexpr double kCloseEnough = 2.0;

// A random half of the other effects, and of the refinements of what is on. An effect in question has no
// refinements, a refinement in question has its effect.
fit::Groups draw_truth(Model model, std::size_t group, std::mt19937_64& random) {
  const std::span<const fit::Group> table = fit::groups_of(model);
  fit::Groups truth = fit::Groups().with(group);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const bool heads = !table[k].refines && fit::family_of(model, k).has(group);
    const bool coin = (random() >> 63) != 0;
    if (heads || (coin && !table[k].refines)) truth = truth.with(k);
  }
  for (std::size_t k = 0; k < table.size(); ++k) {
    const bool coin = (random() >> 63) != 0;
    const bool has_effect = fit::effects_of_groups(model, truth).has(table[k].effect);
    if (table[k].refines && coin && has_effect && table[k].effect != table[group].effect) {
      truth = truth.with(k);
    }
  }
  return truth;
}

Material draw_material(Model model, fit::Groups truth, std::uint64_t seed) {
  Material material = synthetic::random_material(model, Tier::kFull, effects_of(model), {}, seed);
  for (const ParameterInfo& info : parameters_of(model)) {
    const auto group = fit::group_of_parameter(model, info.name);
    if (group && !truth.has(*group)) material.set(info.name, info.default_value);
  }
  material.set_effects(fit::effects_of_groups(model, truth));
  return material;
}

// The parameter whose default switches the group off.
std::string_view switch_of(const fit::Group& group) {
  return group.effect == Effect::kDualSpecular ? "dual_specular_opacity" : group.name;
}

Material weakened(const Material& material, const fit::Group& group, double share) {
  Material result = material;
  const ParameterInfo& info = *find_parameter(material.model(), switch_of(group));
  Rgb value = material.colour(info.name);
  for (double& channel : value) channel = std::lerp(info.default_value, channel, share);
  if (info.components == 3) {
    result.set(info.name, value);
  } else {
    result.set(info.name, value[0]);
  }
  return result;
}

double strength_of(const MeasuredTable& table, Model model, fit::Groups truth, std::size_t group) {
  fit::CrossValidation validation = validation_of(table, model);
  const fit::Groups without = truth.without(fit::family_of(model, group));
  validation.fit({{truth, {}, 8}});
  validation.fit({{without, {{truth, {}}}, 3}});
  // What the smaller set found is open to the larger one too.
  validation.fit({{truth, {{without, {}}}, 0}});
  return (validation.error(without) / validation.error(truth) - 1.0) / fit::kGroupThreshold;
}

}  // namespace

Trial run_trial(Model model, std::size_t group, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Trial trial = {model, group, 0.0, draw_truth(model, group, random), {}};
  const Material strong = draw_material(model, trial.truth, random());
  const double place = static_cast<double>(random() >> 11) * 0x1.0p-53;
  const double wanted = kLeastStrength * std::pow(kMostStrength / kLeastStrength, place);
  double share = 0.3;
  MeasuredTable table;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    table = noisy_table(weakened(strong, fit::groups_of(model)[group], share), kNoise, seed);
    trial.strength = strength_of(table, model, trial.truth, group);
    const double ratio = wanted / std::max(trial.strength, 0.02);
    if (trial.is_in_range() && std::max(ratio, 1.0 / ratio) < kCloseEnough) break;
    if (attempt + 1 == kAttempts || (share == 1.0 && ratio > 1.0)) break;
    // Against noise the error rises with the square of what is missing.
    share = std::min(share * std::clamp(std::sqrt(ratio), 0.1, 3.0), 1.0);
  }
  if (trial.is_in_range()) trial.chosen = select_all(table, model).chosen;
  return trial;
}

}  // namespace brdfit::bench
