// Lambert and materials compared under lights held out.
#include "bake/choose_base.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "bake/fold_gain.h"
#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

// A model must lower the error in most folds, and in their mean by so many standard errors.
constexpr double kStandardErrors = 2.0;
// Under fewer lights errors of folds say too little about a light that is not like the others: where
// there are 12, one of them can decide, whatever rule is applied to the other 11.
constexpr std::size_t kLeastLights = 16;

// In folds, few values and steps from where the fit to all lights began are enough to compare models.
constexpr std::size_t kFoldValues = 12000;
constexpr int kFoldIterations = 8;
// With fewer lights than this a fit is held by its lights alone: what it led to with all of them is no fair
// start without one, and few values are not enough to tell starts apart.
constexpr std::size_t kFewLights = 30;

SharedMaterialOptions options_of(Model model, std::size_t lights, const ChooseBaseOptions& options) {
  SharedMaterialOptions material = options.material;
  if (lights < kFewLights) material.explored_values = std::max(material.explored_values, material.values);
  material.model = model;
  material.effects = effects_of(model);
  return material;
}

SharedMaterial fit_candidate(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                             const LightChoice& lights, const BaseCandidate& candidate,
                             const std::optional<Material>& start, bool in_fold,
                             const ChooseBaseOptions& options) {
  const std::optional<Model>& model = candidate.model;
  if (!model) {
    SharedMaterial lambert;
    lambert.converged = true;
    lambert.termination = "nothing to fit";
    return lambert;
  }
  SharedMaterialOptions material = options_of(*model, lights.size(), options);
  if (!in_fold || lights.size() >= kFewLights) material.start = start;
  if (in_fold && lights.size() >= kFewLights) {
    material.values = std::min(material.values, kFoldValues);
    material.max_iterations = std::min(material.max_iterations, kFoldIterations);
  }
  return fit_shared_material(info, block, surface, lights, material);
}

// Errors of one candidate, trained on some lights, under these and under others.
struct Errors {
  double training = 0.0;
  double held_out = 0.0;
};

Errors errors_of(const StackInfo& info, const StackInfo& gained, const TexelBlock& block,
                 const Surface& surface, const LightChoice& training, const LightChoice& held_out,
                 const BaseCandidate& candidate, const std::optional<Material>& start,
                 const ChooseBaseOptions& options) {
  const SharedMaterial fit = fit_candidate(gained, block, surface, training, candidate, start, true, options);
  const Surface coloured = with_base_colour(gained, block, surface, training, fit.model);
  return {luminance_rmse(block, render_block(gained, block, coloured, training, fit.model), training),
          luminance_rmse(block, render_block(info, block, coloured, held_out, fit.model), held_out)};
}

std::vector<double> gains_of(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                             const ChooseBaseOptions& options, GainEstimate* estimate) {
  if (!options.with_gains) return std::vector<double>(info.lights.size(), 1.0);
  GainEstimate found = estimate_gains(info, block, lights, options.gains);
  std::vector<double> gains = found.gain;
  if (estimate != nullptr) *estimate = std::move(found);
  return gains;
}

void add_fold(const StackInfo& info, const TexelBlock& block, const LightChoice& training,
              const LightChoice& held_out, const std::vector<std::optional<Material>>& starts,
              const ChooseBaseOptions& options, std::vector<BaseCandidate>& candidates) {
  const StackInfo gained = with_gains(info, gains_of(info, block, training, options, nullptr));
  const Surface surface = photometric_stereo(gained, block, training, options.stereo);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    BaseCandidate& candidate = candidates[k];
    const Errors errors =
        errors_of(info, gained, block, surface, training, held_out, candidate, starts[k], options);
    candidate.training_rmse += errors.training * errors.training;
    // Folds may differ in size by a light.
    candidate.fold_errors.push_back(errors.held_out * errors.held_out * static_cast<double>(held_out.size()));
  }
}

// Where fits of each candidate start: the best of its starts under all the lights given.
std::vector<std::optional<Material>> starts_of(const StackInfo& info, const TexelBlock& block,
                                               const Surface& surface, const LightChoice& lights,
                                               const ChooseBaseOptions& options,
                                               const std::vector<BaseCandidate>& candidates) {
  std::vector<std::optional<Material>> starts(candidates.size());
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    const std::optional<Model>& model = candidates[k].model;
    if (!model) return;
    starts[k] =
        explore_shared_material(info, block, surface, lights, options_of(*model, lights.size(), options))
            .model.material;
  });
  return starts;
}

// Whether the error falls in most folds, and in their mean by more than the chance of which lights were held
// out: with few lights one fold can decide by far.
bool is_surely_better(const BaseCandidate& candidate, const BaseCandidate& than) {
  const FoldGain gain = fold_gain(candidate.fold_errors, than.fold_errors);
  return gain.helped >= kHelpedFolds && gain.mean > kStandardErrors * gain.standard_error;
}

std::size_t best_of(const std::vector<BaseCandidate>& candidates, double margin) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < candidates.size(); ++k) {
    const bool lower = candidates[k].held_out_rmse < (1.0 - margin) * candidates[best].held_out_rmse;
    if (lower && is_surely_better(candidates[k], candidates[best])) best = k;
  }
  return best;
}

}  // namespace

bool ChooseBaseOptions::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (folds < 2) return fails("there must be two folds or more");
  if (!(margin >= 0.0 && margin < 1.0)) return fails("margin must lie in [0, 1)");
  return stereo.is_valid(why) && material.is_valid(why) && gains.is_valid(why);
}

std::string_view title_of(const BaseCandidate& candidate) {
  return candidate.model ? title_of(*candidate.model) : "Lambert";
}

BaseChoice choose_base_model(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                             const ChooseBaseOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("choose_base_model: " + why);
  BaseChoice choice;
  choice.candidates.push_back({});
  if (lights.size() >= kLeastLights) {
    for (const Model model : options.models) choice.candidates.emplace_back().model = model;
  }
  const StackInfo gained = with_gains(info, gains_of(info, block, lights, options, &choice.gains));
  const Surface surface = photometric_stereo(gained, block, lights, options.stereo);
  const auto starts = starts_of(gained, block, surface, lights, options, choice.candidates);
  const std::size_t folds = std::min<std::size_t>(static_cast<std::size_t>(options.folds), lights.size());
  if (folds >= 2) {
    for (std::size_t fold = 0; fold < folds; ++fold) {
      if (options.check) options.check();
      LightChoice training;
      LightChoice held_out;
      for (std::size_t k = 0; k < lights.size(); ++k) {
        (k % folds == fold ? held_out : training).push_back(lights[k]);
      }
      add_fold(info, block, training, held_out, starts, options, choice.candidates);
    }
    for (BaseCandidate& candidate : choice.candidates) {
      candidate.training_rmse = std::sqrt(candidate.training_rmse / static_cast<double>(folds));
      candidate.held_out_rmse = std::sqrt(sum(candidate.fold_errors) / static_cast<double>(lights.size()));
    }
    choice.chosen = best_of(choice.candidates, options.margin);
  }
  choice.fit = fit_candidate(gained, block, surface, lights, choice.candidates[choice.chosen],
                             starts[choice.chosen], false, options);
  return choice;
}

}  // namespace brdfit::bake
