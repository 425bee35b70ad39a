// How often the choice of effects finds a material's effects, over many made-up materials.
#include <gmock/gmock.h>
#include <tbb/parallel_for.h>

#include <fmt/format.h>

#include "tests/selection_study.h"

namespace brdfit::fit {
namespace {

using testing_support::make_study;
using testing_support::select_all;
using testing_support::Study;

constexpr std::size_t kMaterials = 100;

struct Outcome {
  bool exact = false;
  double excess_over_all = 0.0;  // of the held-out error, a share of that of everything
};

std::vector<Outcome> outcomes(Model model, Tier tier) {
  std::vector<Outcome> result(kMaterials);
  tbb::parallel_for(std::size_t{0}, kMaterials, [&](std::size_t k) {
    const Study study = make_study(model, tier, 3.0 * kGroupThreshold, 1000 + k);
    const Selection selection = select_all(study.table, model);
    result[k].exact = effects_of_groups(model, selection.chosen) == study.effects;
    result[k].excess_over_all = selection.held_out.log_ratio_pct / selection.held_out_all.log_ratio_pct - 1.0;
  });
  return result;
}

void expect_found(Model model, Tier tier) {
  const std::vector<Outcome> all = outcomes(model, tier);
  const auto exact = std::ranges::count_if(all, &Outcome::exact);
  fmt::print("{} {}: exactly the effects in {} of {} materials\n", name_of(model), name_of(tier), exact,
             all.size());
  EXPECT_GE(exact, 95);
  for (const Outcome& outcome : all) EXPECT_LE(outcome.excess_over_all, kGroupThreshold);
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
