// cli/cost/paired_timing.h: quantiles, turns and the reference, without a look at real times.
#include "cli/cost/paired_timing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brdfit::cli {
namespace {

using testing::ElementsAre;

TEST(PairedTiming, QuantilesLieBetweenNeighboursInOrder) {
  EXPECT_EQ(quantile_of({3, 1, 2}, 0.5), 2.0);
  EXPECT_EQ(quantile_of({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_EQ(quantile_of({4, 1, 3, 2, 5}, 0.25), 2.0);
  EXPECT_EQ(quantile_of({7}, 0.75), 7.0);
  EXPECT_EQ(quantile_of({9, 2, 5}, 0.0), 2.0);
  EXPECT_EQ(quantile_of({9, 2, 5}, 1.0), 9.0);
  EXPECT_THROW(quantile_of({}, 0.5), std::invalid_argument);
}

TEST(PairedTiming, ASummaryHoldsMedianQuartilesAndTheMedianOfPairedRatios) {
  Repeats repeats;
  EXPECT_FALSE(repeats.summary().is_measured());
  // A machine that is twice as slow in one repeat: the ratios do not know it.
  for (const double pace : {1.0, 2.0, 1.0, 1.0, 3.0}) repeats.add(10.0 * pace, 2.0 * pace);
  const RepeatedTime time = repeats.summary();
  EXPECT_EQ(time.repeats, 5);
  EXPECT_EQ(time.median, 10.0);
  EXPECT_EQ(time.low_quartile, 10.0);
  EXPECT_EQ(time.high_quartile, 20.0);
  EXPECT_EQ(time.units, 5.0);
}

TEST(PairedTiming, EveryWorkIsMeasuredOnceARoundAndEachRoundBeginsWithAnother) {
  std::vector<std::size_t> order;
  TurnOptions options;
  options.repeats = 3;
  const TimesInTurns times = time_in_turns(
      3,
      [&](std::size_t what) {
        order.push_back(what);
        return static_cast<double>(what + 1);
      },
      options);
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 1, 2, 0, 2, 0, 1));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(times.works[k].median, static_cast<double>(k + 1));
    EXPECT_EQ(times.works[k].low_quartile, times.works[k].high_quartile);
    EXPECT_EQ(times.works[k].repeats, 3);
  }
  EXPECT_EQ(times.reference_seconds.repeats, 9);
  EXPECT_GT(times.reference_seconds.median, 0.0);
}

TEST(PairedTiming, UnitsAreRatiosToTheReferenceInTheUnitOfTheWorks) {
  TurnOptions options;
  options.repeats = 1;
  options.per_second = 1e9;
  const TimesInTurns times = time_in_turns(
      1, [](std::size_t) { return 5e6; }, options);
  EXPECT_NEAR(times.works[0].units, 5e-3 / times.reference_seconds.median, 1e-12);
}

TEST(PairedTiming, WhatIsThrownBeforeAWorkEndsTheMeasurement) {
  int done = 0;
  TurnOptions options;
  options.before_each = [&] {
    if (done == 2) throw std::runtime_error("interrupted");
  };
  const auto work = [&](std::size_t) { return static_cast<double>(++done); };
  EXPECT_THROW(time_in_turns(4, work, options), std::runtime_error);
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace brdfit::cli
