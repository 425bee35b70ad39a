// Small tables with known answers, for the tests of fits.
#ifndef BRDFIT_TESTS_FIT_DATA_H_
#define BRDFIT_TESTS_FIT_DATA_H_

#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "fit/problem.h"

namespace brdfit::testing_support {

inline constexpr Grid kSmallGrid = {30, 30, 60, CellAnchor::kLowerEdge};

inline synthetic::Recipe recipe_of(const Material& material, const Grid& grid = kSmallGrid) {
  synthetic::Recipe recipe;
  recipe.name = "test";
  recipe.material = material;
  recipe.grid = grid;
  return recipe;
}

inline MeasuredTable table_of(const Material& material, const Grid& grid = kSmallGrid) {
  return synthetic::generate_table(recipe_of(material, grid));
}

inline Material random_full_material(Model model, Effects effects, std::uint64_t seed) {
  return synthetic::random_material(model, Tier::kFull, effects, {}, seed);
}

// A least-squares problem with everything that it refers to.
struct OwnedProblem {
  fit::Parametrisation parametrisation;
  SampleSet samples;
  fit::Targets targets;
  fit::Problem problem;

  OwnedProblem(const MeasuredTable& table, const Material& start, const fit::FreedomOptions& options,
               fit::Loss loss = fit::Loss::kLogRatio, std::size_t cells = 3000)
      : parametrisation(fit::make_parametrisation(start, options)),
        samples(sample_table(table, cells, 1, {90.0})),
        targets(fit::make_targets(samples, loss)),
        problem(parametrisation, samples, targets, loss) {}
  OwnedProblem(const OwnedProblem&) = delete;
  OwnedProblem& operator=(const OwnedProblem&) = delete;

  std::size_t index_of(std::string_view name) const {
    for (std::size_t k = 0; k < parametrisation.size(); ++k) {
      if (parametrisation.free[k].name == name) return k;
    }
    throw std::logic_error("no free number of that name");
  }
};

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_FIT_DATA_H_
