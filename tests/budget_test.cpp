// cli/cost/budget.h: the best point under limits, decided by upper quartiles and by a second measurement.
#include "cli/cost/budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/cost_data.h"

namespace brdfit::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::cost_point;
using testing_support::cost_run;
using testing_support::time_of;

CostPoint point(const std::string& name, double error, double seconds, double ns, double bytes = 40.0) {
  return cost_point(name, "model", {}, error, seconds, ns, bytes);
}

// Three points that buy accuracy with time and bytes, and one that nobody wants.
CostRun ladder() {
  return cost_run({point("plain", 30, 0.01, 5, 16), point("middle", 20, 0.02, 10, 28),
                   point("waste", 25, 0.5, 50, 80), point("full", 10, 0.1, 20, 88)});
}

CostPoint same(const CostPoint& point) {
  return point;
}

Limits ns(double limit) {
  Limits limits;
  limits.evaluation_ns = limit;
  return limits;
}

TEST(Budget, TheLeastErrorUnderALimitOfTimeIsChosen) {
  const CostRun run = ladder();
  const BudgetAnswer answer = spend(ns(15.0), run, same);
  ASSERT_TRUE(answer.point);
  EXPECT_EQ(run.points[*answer.point].name, "middle");
  EXPECT_TRUE(run.points[*answer.point].on_run_front);
}

TEST(Budget, ALimitIsHeldAgainstTheUpperQuartile) {
  EXPECT_THAT(choices_under(ns(20.0), ladder()), ElementsAre(1, 0));
  EXPECT_THAT(choices_under(ns(20.2), ladder()), ElementsAre(3, 1, 0));
}

TEST(Budget, BytesSecondsAndErrorLimitTogether) {
  Limits limits;
  limits.bytes = 40;
  limits.make_seconds = 0.015;
  EXPECT_THAT(choices_under(limits, ladder()), ElementsAre(0));
  limits.make_seconds = 1.0;
  limits.error = 25.0;
  EXPECT_THAT(choices_under(limits, ladder()), ElementsAre(1));
  limits.error = 15.0;
  EXPECT_THAT(choices_under(limits, ladder()), IsEmpty());
}

TEST(Budget, ALimitOfTheErrorAloneBuysTheCheapestEvaluation) {
  Limits limits;
  limits.error = 22.0;
  EXPECT_THAT(choices_under(limits, ladder()), ElementsAre(1, 3));
}

TEST(Budget, AnswersAreOnTheFrontWhateverTheLimits) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> values(1, 30);
  std::vector<CostPoint> points;
  for (int k = 0; k < 80; ++k) {
    points.push_back(point(std::to_string(k), values(random), values(random), values(random)));
  }
  const CostRun run = cost_run(points);
  int found = 0;
  for (int limit = 1; limit <= 30; ++limit) {
    const BudgetAnswer by_time = spend(ns(limit), run, same);
    EXPECT_TRUE(!by_time.point || run.points[*by_time.point].on_run_front);
    Limits seconds;
    seconds.make_seconds = limit;
    const BudgetAnswer by_seconds = spend(seconds, run, same);
    EXPECT_TRUE(!by_seconds.point || run.points[*by_seconds.point].on_make_front);
    Limits error;
    error.error = limit;
    const BudgetAnswer by_error = spend(error, run, same);
    EXPECT_TRUE(!by_error.point || run.points[*by_error.point].on_run_front);
    for (const BudgetAnswer* answer : {&by_time, &by_seconds, &by_error}) found += answer->point ? 1 : 0;
  }
  EXPECT_GT(found, 60);
}

TEST(Budget, APointThatIsTooSlowTheSecondTimeGivesWayToTheNext) {
  const CostRun run = ladder();
  const BudgetAnswer answer = spend(ns(25.0), run, [](CostPoint again) {
    if (again.name == "full") again.evaluation_ns = time_of(26.0);
    return again;
  });
  ASSERT_EQ(answer.trials.size(), 2U);
  EXPECT_EQ(answer.trials[0].point, 3U);
  ASSERT_EQ(answer.trials[0].excess.size(), 1U);
  EXPECT_EQ(answer.trials[0].excess[0].what, "evaluation_ns");
  ASSERT_TRUE(answer.point);
  EXPECT_EQ(run.points[*answer.point].name, "middle");
  const std::string text = budget_text(answer, ns(25.0), run);
  EXPECT_THAT(text,
              HasSubstr("full kept the limits, but not when measured again (evaluation_ns 26.3 over 25)"));
  EXPECT_THAT(text, HasSubstr("middle is best"));
}

TEST(Budget, WhereNothingFitsTheNearestIsNamedAndNothingIsMeasuredAgain) {
  const CostRun run = ladder();
  int measured = 0;
  const BudgetAnswer answer = spend(ns(4.0), run, [&](const CostPoint& again) {
    ++measured;
    return again;
  });
  EXPECT_FALSE(answer.point);
  EXPECT_EQ(measured, 0);
  EXPECT_EQ(run.points[answer.nearest].name, "plain");
  EXPECT_THAT(budget_text(answer, ns(4.0), run), HasSubstr("No point keeps the limits. Nearest is plain"));
}

TEST(Budget, WhatWasNotMeasuredKeepsNoLimit) {
  CostPoint unmeasured = point("unmeasured", 1, 1, 1);
  unmeasured.evaluation_ns = {};
  const CostRun run = cost_run({unmeasured, point("measured", 2, 1, 1)});
  EXPECT_THAT(choices_under(ns(5.0), run), ElementsAre(1));
  EXPECT_EQ(excess_over(ns(5.0), unmeasured, "error").size(), 1U);
}

TEST(Budget, OtherDevicesAreNoChoice) {
  CostPoint device = point("on a device", 1, 1, 1);
  device.sweep = "device";
  const CostRun run = cost_run({device, point("on the processor", 2, 1, 1)});
  EXPECT_THAT(choices_under(ns(5.0), run), ElementsAre(1));
  EXPECT_EQ(nearest_to(ns(0.5), run), 1U);
}

}  // namespace
}  // namespace brdfit::cli
