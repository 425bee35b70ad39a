// The choice of a loss: the judge decides, and what does not depend on the loss is chosen once.
#include "fit/choose_loss.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing::HasSubstr;

MeasuredTable small_table() {
  return testing_support::table_of(
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3));
}

FitOptions quick() {
  FitOptions options;
  options.model = Model::kLambertGgx;
  options.samples = 1500;
  options.choose_loss = true;
  return options;
}

// Likes rough materials.
double roughness_judge(const Material& material) {
  return 1.0 - material.number("roughness");
}

TEST(ChooseLoss, KeepsTheResultThatTheJudgeFindsBest) {
  const MeasuredTable table = small_table();
  const FitResult best = fit_under_best_loss(table, quick(), roughness_judge);
  ASSERT_EQ(best.losses.size(), all_losses().size());
  double least = 1e9;
  for (const LossTrial& trial : best.losses) {
    FitOptions one = quick();
    one.loss = trial.loss;
    EXPECT_EQ(trial.judged, roughness_judge(fit(table, one).material)) << name_of(trial.loss);
    least = std::min(least, trial.judged);
  }
  EXPECT_EQ(roughness_judge(best.material), least);
  EXPECT_THAT(best.notes.back(), HasSubstr("fitted under " + std::string(name_of(best.options.loss))));
  EXPECT_TRUE(best.options.choose_loss);
}

TEST(ChooseLoss, TheFirstOfEqualsIsKept) {
  const FitResult best = fit_under_best_loss(small_table(), quick(), [](const Material&) { return 1.0; });
  EXPECT_EQ(best.options.loss, all_losses().front());
}

TEST(ChooseLoss, GroupsAreChosenOnceAndHoldForEveryLoss) {
  FitOptions options = quick();
  options.model = Model::kCallisto;
  options.choose_groups = true;
  std::vector<Effects> seen;
  const FitResult best = fit_under_best_loss(small_table(), options, [&](const Material& material) {
    seen.push_back(material.effects());
    return static_cast<double>(all_losses().size() - seen.size());
  });
  EXPECT_EQ(best.options.loss, all_losses().back());
  ASSERT_TRUE(best.selection.has_value());
  EXPECT_EQ(best.selection->chosen, best.groups);
  EXPECT_TRUE(best.options.choose_groups);
  EXPECT_TRUE(std::ranges::all_of(seen, [&](Effects effects) { return effects == seen.front(); }));
}

}  // namespace
}  // namespace brdfit::fit
