// cli/cost/findings.h: sentences say what the figures of the points say.
#include "cli/cost/findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cost_data.h"

namespace brdfit::cli {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing_support::cost_point;
using testing_support::cost_run;
using testing_support::Settings;

Settings with(const std::string& effects, const std::string& samples, const std::string& model = "callisto") {
  return {{"model", model}, {"effects", effects}, {"samples", samples}};
}

CostPoint default_point(double error = 10.0) {
  return cost_point("callisto", "default", with("all", "20000"), error, 0.1, 20.0);
}

std::vector<std::string> sentences(const std::vector<CostPoint>& points) {
  return sentences_of(findings_of(cost_run(points)));
}

TEST(Findings, AccuracyIsTheInverseOfTheError) {
  EXPECT_DOUBLE_EQ(accuracy_share_pct(20.0, 10.0), 50.0);
  EXPECT_DOUBLE_EQ(accuracy_share_pct(10.0, 20.0), 200.0);
  EXPECT_EQ(accuracy_share_pct(0.0, 0.0), 100.0);
  EXPECT_EQ(accuracy_share_pct(5.0, 0.0), 0.0);
}

TEST(Findings, AChoiceIsComparedWithTheDefaultInAccuracyAndBothTimes) {
  const auto said = sentences(
      {default_point(), cost_point("burley", "model", with("all", "20000", "burley"), 12.5, 0.03, 8.0)});
  EXPECT_THAT(said, Contains("burley reaches 80% of the accuracy of callisto at 0.40x its run-time cost and "
                             "0.30x its time to fit."));
}

TEST(Findings, TimesWhoseMediansAreNotToldApartAreAboutTheSame) {
  const auto said = sentences(
      {default_point(), cost_point("burley", "model", with("all", "20000", "burley"), 12.5, 0.101, 8.0)});
  EXPECT_THAT(said, Contains(HasSubstr("at 0.40x its run-time cost and about its time to fit.")));
}

TEST(Findings, SharesNextToAHundredAreNotRoundedToIt) {
  const auto said = sentences(
      {default_point(), cost_point("burley", "model", with("all", "20000", "burley"), 10.02, 0.03, 8.0)});
  EXPECT_THAT(said, Contains(HasSubstr("burley reaches 99.8% of")));
}

// Errors by the number of samples.
std::vector<CostPoint> samples_sweep(const std::vector<std::pair<int, double>>& tried) {
  std::vector<CostPoint> points = {default_point()};
  for (const auto& [samples, error] : tried) {
    points.push_back(cost_point(std::to_string(samples) + " samples", "samples",
                                with("all", std::to_string(samples)), error, 1e-5 * samples, 20.0));
  }
  return points;
}

TEST(Findings, APlateauBeginsWhereNoLargerValueImprovesByMoreThanAPercent) {
  const auto points = samples_sweep({{1000, 12.0}, {2000, 10.5}, {4000, 10.05}, {50000, 9.99}});
  const auto plateau = plateau_of(cost_run(points), "samples");
  ASSERT_TRUE(plateau);
  EXPECT_EQ(plateau->value, 4000.0);
  EXPECT_EQ(plateau->largest, 50000.0);
  EXPECT_THAT(
      sentences(points),
      Contains("After 4,000 samples nothing improves by more than 1%; 50,000 take 12x as long to fit."));
}

TEST(Findings, APlateauIsNotBegunByAPointThatALargerOneBeatsLater) {
  const auto points = samples_sweep({{1000, 10.02}, {2000, 10.02}, {4000, 10.02}, {50000, 9.0}});
  EXPECT_EQ(plateau_of(cost_run(points), "samples")->value, 50000.0);
  EXPECT_THAT(sentences(points),
              Contains("The error still falls by more than 1% at 50,000 samples, the most that were tried."));
}

TEST(Findings, WordsAmongNumbersAreNoPartOfAPlateau) {
  auto points = samples_sweep({{1000, 10.02}});
  points.push_back(cost_point("chosen samples", "samples", with("all", "auto"), 9.0, 0.2, 20.0));
  EXPECT_EQ(plateau_of(cost_run(points), "samples")->largest, 20000.0);
  EXPECT_THAT(sentences(points),
              Contains(HasSubstr("chosen samples reaches 111% of the accuracy of callisto")));
}

TEST(Findings, AnEffectIsWorthWhatTheErrorRisesByWithoutIt) {
  const auto said =
      sentences({default_point(), cost_point("without a", "effects", with("b,c", "20000"), 13.0, 0.1, 16.0),
                 cost_point("without b", "effects", with("a,c", "20000"), 10.05, 0.1, 18.0),
                 cost_point("without c", "effects", with("a,b", "20000"), 9.0, 0.1, 20.0),
                 cost_point("only a", "effects", with("a", "20000"), 15.0, 0.1, 12.0)});
  EXPECT_THAT(said, Contains("Without a the error is 30% higher, at 0.80x the run-time cost."));
  EXPECT_THAT(said, Contains("b is worth nothing here: without it the error changes by no more than 1%, at "
                             "0.90x the run-time cost."));
  EXPECT_THAT(said, Contains("Without c the error is 10% lower, at about the run-time cost."));
}

TEST(Findings, EffectsOfOtherModelsAreNotHeldAgainstTheDefault) {
  const auto said = sentences(
      {default_point(), cost_point("burley without a", "effects", with("b", "20000", "burley"), 13, 0.1, 16),
       cost_point("burley without b", "effects", with("a", "20000", "burley"), 13, 0.1, 16)});
  EXPECT_THAT(said, Not(Contains(HasSubstr("Without"))));
}

TEST(Findings, TheCheapestPointOfAFrontIsNamedForAShareOfTheBestAccuracy) {
  const auto said =
      sentences({default_point(), cost_point("plain", "model", with("all", "1", "a"), 18.0, 0.01, 4.0),
                 cost_point("middle", "model", with("all", "1", "b"), 11.0, 0.05, 10.0),
                 cost_point("slow", "model", with("all", "1", "c"), 10.9, 0.09, 19.0)});
  EXPECT_THAT(said,
              Contains("For 50% of the accuracy of callisto pay 0.20x its run-time cost: plain (56% of it, "
                       "4 ns an evaluation)."));
  EXPECT_THAT(said,
              Contains("For 75% of the accuracy of callisto pay 0.50x its run-time cost: middle (91% of it, "
                       "10 ns an evaluation)."));
  EXPECT_THAT(said,
              Contains("For 75% of the accuracy of callisto pay 0.50x its time to fit: middle (91% of it, "
                       "0.05 s)."));
  EXPECT_THAT(said, Not(Contains(HasSubstr("For 90%"))));
}

TEST(Findings, WhatWasNotMeasuredIsNotSpokenOf) {
  CostPoint point = cost_point("burley", "model", with("all", "20000", "burley"), 12.5, 0.03, 8.0);
  point.make_seconds = {};
  point.evaluation_ns = {};
  EXPECT_THAT(sentences({default_point(), point}),
              Contains("burley reaches 80% of the accuracy of callisto."));
  CostPoint nothing = default_point();
  nothing.errors.clear();
  EXPECT_THAT(sentences({nothing}), IsEmpty());
}

TEST(Findings, StacksAreBaked) {
  CostRun run = cost_run({cost_point("8 lobes", "default", {{"lobes", "8"}}, 10, 1, 20),
                          cost_point("4 lobes", "lobes", {{"lobes", "4"}}, 10.01, 0.5, 10)});
  run.kind = "stack";
  EXPECT_THAT(sentences_of(findings_of(run)),
              Contains("After 4 lobes nothing improves by more than 1%; 8 take 2.0x as long to bake."));
}

TEST(Findings, MoreOfARidgeIsNoMore) {
  CostRun run = cost_run({cost_point("8 lobes", "default", {{"ridge-factor", "1"}}, 10, 1, 20),
                          cost_point("ridge x 10", "ridge-factor", {{"ridge-factor", "10"}}, 12, 1, 20)});
  const std::vector<std::string> sentences = sentences_of(findings_of(run));
  EXPECT_THAT(sentences, testing::Not(Contains(testing::HasSubstr("nothing improves"))));
  EXPECT_THAT(sentences, Contains(testing::HasSubstr("ridge x 10 reaches 83% of the accuracy of 8 lobes")));
}

}  // namespace
}  // namespace brdfit::cli
