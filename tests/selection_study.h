// Materials with known effects and noise, for tests of the choice of effects.
#ifndef BRDFIT_TESTS_SELECTION_STUDY_H_
#define BRDFIT_TESTS_SELECTION_STUDY_H_

#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "fit/select.h"
#include "tests/fit_data.h"

namespace brdfit::testing_support {

inline constexpr Grid kStudyGrid = {45, 45, 90, CellAnchor::kLowerEdge};

inline MeasuredTable noisy_table(const Material& material, double noise, std::uint64_t seed,
                                 const Grid& grid = kStudyGrid) {
  synthetic::Recipe recipe = recipe_of(material, grid);
  recipe.noise.multiplicative = noise;
  recipe.seed = seed;
  return synthetic::generate_table(recipe);
}

inline std::vector<fit::Fold> folds_of(const MeasuredTable& table, std::uint64_t seed = 1) {
  std::vector<std::size_t> cells;
  const SampleSet samples = sample_table(table, 20000, seed, {}, &cells);
  fit::FoldOptions options;
  options.seed = seed;
  return make_folds(samples, cells, table.grid(), options);
}

inline fit::CrossValidation validation_of(const MeasuredTable& table, Model model) {
  fit::CrossValidationOptions options;
  options.start = Material(model);
  return {folds_of(table), options};
}

inline fit::Groups every_group(Model model) {
  return fit::groups_of_effects(model, effects_of(model));
}

// A table in two parts: what choices and fits see, and samples of what they do not. Blocks of angles are set
// aside, as neighbouring cells are alike.
struct SplitTable {
  MeasuredTable seen;
  SampleSet aside;
};

inline SplitTable split(const MeasuredTable& table, std::uint64_t seed) {
  // Another number than that of the folds: else blocks of both would be the same boxes.
  const fit::AngleBlocks blocks(table.grid(), 6, seed);
  std::vector<float> seen;
  std::vector<float> aside;
  for (int channel = 0; channel < 3; ++channel) {
    const std::span<const float> plane = table.plane(channel);
    for (std::size_t cell = 0; cell < plane.size(); ++cell) {
      const bool is_aside = blocks.fold_of(cell) == 0;
      seen.push_back(is_aside ? -1.0F : plane[cell]);
      aside.push_back(is_aside ? plane[cell] : -1.0F);
    }
  }
  return {{table.grid(), std::move(seen)}, sample_table({table.grid(), std::move(aside)}, 6000, seed, {})};
}

// A material of which a random half of the model's effects is part, drawn again until each is so strong that
// the held-out error without it is higher by `strength` (a share of it), as fits with many starts have it.
struct Study {
  Material material;
  Effects effects;
  MeasuredTable table;  // that choices and fits see
  SampleSet aside;      // that they do not
};

inline double weakest_effect(const MeasuredTable& table, Model model, Effects effects) {
  fit::CrossValidation validation = validation_of(table, model);
  const fit::Groups truth = fit::groups_of_effects(model, effects);
  validation.fit({{truth, {}, 8}});
  double weakest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < fit::groups_of(model).size(); ++k) {
    if (!truth.has(k) || fit::groups_of(model)[k].refines) continue;
    const fit::Groups without = truth.without(fit::family_of(model, k));
    validation.fit({{without, {{truth, {}}}, 3}});
    weakest = std::min(weakest, validation.error(without) / validation.error(truth) - 1.0);
  }
  return weakest;
}

inline Study make_study(Model model, Tier tier, double strength, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  while (true) {
    Effects effects;
    for (const fit::Group& group : fit::groups_of(model)) {
      if (!group.refines && (random() >> 63) != 0) effects = effects.with(group.effect);
    }
    Study study = {synthetic::random_material(model, tier, effects, {}, random()), {}, {}, {}};
    study.effects = study.material.effects();
    SplitTable parts = split(noisy_table(study.material, 0.01, seed), seed);
    study.table = std::move(parts.seen);
    study.aside = std::move(parts.aside);
    if (weakest_effect(study.table, model, study.effects) >= strength) return study;
  }
}

inline fit::Selection select_all(const MeasuredTable& table, Model model,
                                 double threshold = fit::kGroupThreshold) {
  fit::CrossValidation validation = validation_of(table, model);
  return fit::select_groups(validation, model, {every_group(model), {}, threshold});
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_SELECTION_STUDY_H_
