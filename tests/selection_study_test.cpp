// How often the choice of effects finds a material's effects, over many made-up materials.
#include <gmock/gmock.h>
#include <tbb/parallel_for.h>

#include <fmt/format.h>

#include "fit/fit.h"
#include "fit/log_ratio.h"
#include "tests/selection_study.h"

namespace brdfit::fit {
namespace {

using testing_support::make_study;
using testing_support::Study;

constexpr std::size_t kMaterials = 100;

struct Outcome {
  bool exact = false;
  // How much worse than everything the choice is, as a share of the error of everything: held out by the
  // choice itself, and on cells that neither the choice nor a fit saw.
  double excess_held_out = 0.0;
  double excess_aside = 0.0;
};

FitOptions everything(Model model) {
  FitOptions options;
  options.model = model;
  return options;
}

FitOptions chosen(Model model) {
  FitOptions options = everything(model);
  options.choose_groups = true;
  return options;
}

Outcome outcome_of(const Study& study, Model model) {
  const FitResult result = fit(study.table, chosen(model));
  const FitResult all = fit(study.table, everything(model));
  const Selection& selection = *result.selection;
  Outcome outcome;
  outcome.exact = effects_of_groups(model, selection.chosen) == study.effects;
  outcome.excess_held_out = selection.held_out.log_ratio_pct / selection.held_out_all.log_ratio_pct - 1.0;
  outcome.excess_aside =
      log_ratio_pct(result.material, study.aside) / log_ratio_pct(all.material, study.aside) - 1.0;
  return outcome;
}

std::vector<Outcome> outcomes(Model model, Tier tier) {
  std::vector<Outcome> result(kMaterials);
  tbb::parallel_for(std::size_t{0}, kMaterials, [&](std::size_t k) {
    result[k] = outcome_of(make_study(model, tier, 3.0 * kGroupThreshold, 1000 + k), model);
  });
  return result;
}

void expect_found(Model model, Tier tier) {
  const std::vector<Outcome> all = outcomes(model, tier);
  const auto exact = std::ranges::count_if(all, &Outcome::exact);
  fmt::print(
      "{} {}: exactly the effects in {} of {} materials; on cells set aside the choice is at most {:.2f}% "
      "worse "
      "than everything\n",
      name_of(model), name_of(tier), exact, all.size(),
      100.0 * std::ranges::max(all, {}, &Outcome::excess_aside).excess_aside);
  EXPECT_GE(exact, 95);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_LE(all[k].excess_held_out, kGroupThreshold) << "material " << k;
    EXPECT_LE(all[k].excess_aside, kGroupThreshold) << "material " << k;
  }
}

TEST(ChoiceOfEffects, FindsThoseOfCallisto) {
  expect_found(Model::kCallisto, Tier::kFull);
}

TEST(ChoiceOfEffects, FindsThoseOfCallistoWithoutTintsAndTangentFalloffs) {
  expect_found(Model::kCallisto, Tier::kBase);
}

TEST(ChoiceOfEffects, FindsThoseOfBurley) {
  expect_found(Model::kBurley, Tier::kFull);
}

}  // namespace
}  // namespace brdfit::fit
