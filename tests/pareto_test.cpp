// cli/cost/pareto.h: fronts hold what nothing beats, and nothing else.
#include "cli/cost/pareto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace brdfit::cli {
namespace {

using testing::ElementsAre;

CostPoint point(double error, double make, double evaluation, double bytes = 4) {
  CostPoint result;
  result.errors = {{"error", error}};
  if (!std::isnan(make)) result.make_seconds = {make, make, make, 1, 0};
  if (!std::isnan(evaluation)) result.evaluation_ns = {evaluation, evaluation, evaluation, 1, 0};
  result.bytes = bytes;
  return result;
}

CostRun run_of(std::vector<CostPoint> points) {
  CostRun run;
  run.leading_error = "error";
  run.points = std::move(points);
  mark_fronts(run);
  return run;
}

CostRun random_run(unsigned seed) {
  std::mt19937 random(seed);
  // Few values, so that many points are alike.
  std::uniform_int_distribution<int> values(1, 12);
  std::vector<CostPoint> points;
  for (int k = 0; k < 60; ++k) points.push_back(point(values(random), values(random), values(random)));
  return run_of(points);
}

TEST(Pareto, NothingOnAFrontIsBeatenAndAllElseIs) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const CostRun run = random_run(seed);
    for (const CostPoint& p : run.points) {
      const auto beats = [&](const CostPoint& q) {
        const double error = error_of(p, "error") - error_of(q, "error");
        const double time = make_seconds_of(p) - make_seconds_of(q);
        return error >= 0 && time >= 0 && (error > 0 || time > 0);
      };
      const bool is_beaten = std::ranges::any_of(run.points, beats);
      EXPECT_FALSE(p.on_make_front && is_beaten);
      if (!p.on_make_front && !is_beaten) {
        // Only a point that is alike and comes first takes its place.
        EXPECT_TRUE(std::any_of(run.points.data(), &p, [&](const CostPoint& q) {
          return q.on_make_front && q.errors == p.errors && make_seconds_of(q) == make_seconds_of(p);
        }));
      }
    }
  }
}

TEST(Pareto, AlongAFrontTheErrorFallsAsTheCostRises) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const CostRun run = random_run(seed);
    const auto front = by_cost(run.points, &CostPoint::on_run_front, evaluation_ns_of);
    ASSERT_FALSE(front.empty());
    for (std::size_t k = 1; k < front.size(); ++k) {
      const CostPoint& before = run.points[front[k - 1]];
      const CostPoint& after = run.points[front[k]];
      EXPECT_LT(evaluation_ns_of(before), evaluation_ns_of(after));
      EXPECT_GT(error_of(before, "error"), error_of(after, "error"));
    }
  }
}

TEST(Pareto, ThePointOfLeastErrorIsOnBothFronts) {
  const CostRun run = run_of({point(3, 1, 1), point(1, 9, 9), point(2, 5, 9)});
  EXPECT_TRUE(run.points[1].on_make_front);
  EXPECT_TRUE(run.points[1].on_run_front);
  EXPECT_TRUE(run.points[2].on_make_front);
  EXPECT_FALSE(run.points[2].on_run_front);
}

TEST(Pareto, PointsThatLackAFigureAreOnNoFrontOfItAndBeatNothingThere) {
  const CostRun run = run_of({point(1, kNotMeasured, 2), point(2, 1, 3), point(kNotMeasured, 0, 0)});
  EXPECT_FALSE(run.points[0].on_make_front);
  EXPECT_TRUE(run.points[1].on_make_front);
  EXPECT_TRUE(run.points[0].on_run_front);
  EXPECT_FALSE(run.points[1].on_run_front);
  EXPECT_FALSE(run.points[2].on_make_front || run.points[2].on_run_front);
}

TEST(Pareto, OfPointsThatAreAlikeTheFirstIsOnTheFront) {
  const CostRun run = run_of({point(2, 2, 2), point(2, 2, 2), point(2, 2, 2)});
  EXPECT_THAT(by_cost(run.points, &CostPoint::on_make_front, make_seconds_of), ElementsAre(0));
}

TEST(Pareto, AFrontOfThreeFiguresKeepsWhatOnlyTheThirdSpeaksFor) {
  const std::vector<CostPoint> points = {point(1, 1, 1, 100), point(2, 2, 2, 8), point(3, 3, 3, 8)};
  const std::vector<CostFigure> figures = {[](const CostPoint& p) { return error_of(p, "error"); },
                                           make_seconds_of, bytes_of};
  EXPECT_THAT(front_of(points, figures), ElementsAre(true, true, false));
}

}  // namespace
}  // namespace brdfit::cli
