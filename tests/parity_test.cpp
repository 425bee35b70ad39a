// What parity says of values that are right, wrong and not finite; no device needed.
#include "gpu/parity.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>

#include "gpu/parity_pairs.h"

namespace brdfit {
namespace {

TEST(LogHistogram, GivesPercentilesWithinABin) {
  LogHistogram histogram;
  for (int k = 1; k <= 1000; ++k) histogram.add(1e-6 * k);
  for (const double share : {0.001, 0.5, 0.9, 0.99, 1.0}) {
    const double exact = 1e-3 * share;
    EXPECT_GE(histogram.percentile(share), exact * (1 - 1e-12)) << share;
    EXPECT_LE(histogram.percentile(share), exact * 1.016) << share;
  }
  EXPECT_EQ(histogram.maximum(), 1e-6 * 1000);
  EXPECT_EQ(histogram.count(), 1000U);
}

TEST(LogHistogram, TakesZeroAndHugeNumbers) {
  LogHistogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), 0.0);
  for (int k = 0; k < 9; ++k) histogram.add(0.0);
  histogram.add(1e30);
  EXPECT_EQ(histogram.percentile(0.9), 0.0);
  EXPECT_EQ(histogram.percentile(1.0), 1e30);
}

TEST(ErrorTally, JudgesBrightReferencesByRelativeErrorAndOthersByAbsolute) {
  ErrorTally tally(ErrorThreshold{});
  EXPECT_NEAR(tally.add(2.0, 2.0F + 1e-5F).share, 0.5, 0.05);
  EXPECT_EQ(tally.over(), 0U);
  EXPECT_NEAR(tally.add(0.5e-4, 0.5e-4F + 1.5e-6F).share, 1.5, 0.01);
  EXPECT_EQ(tally.over(), 1U);
  EXPECT_NEAR(tally.relative().maximum(), 0.5e-5, 0.1e-5);
  EXPECT_NEAR(tally.ulp().maximum(), 1e-5 / 0x1p-22, 1.0);
  EXPECT_NEAR(tally.absolute().maximum(), 1.5e-6, 1e-10);
}

TEST(ErrorTally, CountsWhatIsNotFiniteAsBeyondTheThreshold) {
  ErrorTally tally(ErrorThreshold{});
  tally.add(1.0, std::numeric_limits<float>::quiet_NaN());
  const TalliedError error = tally.add(1.0, std::numeric_limits<float>::infinity());
  EXPECT_FALSE(error.worst);
  EXPECT_EQ(tally.not_finite(), 2U);
  EXPECT_EQ(tally.over(), 2U);
  EXPECT_EQ(tally.worst_share(), std::numeric_limits<double>::infinity());
}

Material material() {
  Material result(Model::kCallisto);
  result.set("roughness", 0.3);
  result.set_effects(effects_of(Model::kCallisto));
  return result;
}

TEST(Parity, OfTheFloatKernelsThemselvesPasses) {
  const ParityReport report = check_parity(material(),
                                           [](std::span<const FloatPair> pairs, std::span<FloatRgb> out) {
                                             eval_cos_float(material(), pairs, out);
                                           },
                                           {20000, 3});
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.pairs, 20000U);
  EXPECT_EQ(report.device.errors.worst_share(), report.processor.errors.worst_share());
}

TEST(Parity, FindsTheOneValueThatIsWrongAndThePairThatShowsIt) {
  std::vector<FloatPair> all(300000);
  fill_parity_pairs(4, 0, all);
  std::vector<FloatRgb> right(all.size());
  eval_cos_float(material(), all, right);
  // Beyond the first part of the pairs.
  std::size_t spoiled = 280000;
  while (!(right[spoiled][1] > 0.01F)) ++spoiled;
  std::size_t seen = 0;
  const ParityReport report = check_parity(material(),
                                           [&](std::span<const FloatPair> pairs, std::span<FloatRgb> out) {
                                             eval_cos_float(material(), pairs, out);
                                             if (spoiled >= seen && spoiled < seen + pairs.size())
                                               out[spoiled - seen][1] *= 1.001F;
                                             seen += pairs.size();
                                           },
                                           {all.size(), 4});
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(report.device.errors.over(), 1U);
  EXPECT_EQ(report.device.worst.pair, all[spoiled]);
  EXPECT_EQ(report.device.worst.channel, 1);
}

TEST(ParityPairs, DependOnSeedAndPlaceAlone) {
  std::vector<FloatPair> all(1000);
  fill_parity_pairs(7, 0, all);
  std::vector<FloatPair> some(10);
  fill_parity_pairs(7, 500, some);
  for (std::size_t k = 0; k < some.size(); ++k) EXPECT_EQ(some[k], all[500 + k]);
  fill_parity_pairs(8, 500, some);
  EXPECT_NE(some[0], all[500]);
}

double length(const std::array<float, 3>& w) {
  return std::hypot(double{w[0]}, double{w[1]}, double{w[2]});
}

TEST(ParityPairs, AreUnitVectorsAndWhatTheirKindSays) {
  std::vector<FloatPair> pairs(90000);
  fill_parity_pairs(9, 0, pairs);
  std::set<PairKind> denormals_in;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [wi, wo] = pairs[k];
    ASSERT_NEAR(length(wi), 1.0, 2e-7);
    ASSERT_NEAR(length(wo), 1.0, 2e-7);
    const PairKind kind = kind_of_parity_pair(k);
    const float least = std::min(wi[2], wo[2]);
    if (kind == PairKind::kBelow) {
      ASSERT_LE(least, 0.0F);
    } else {
      ASSERT_GE(least, 0.0F) << name_of(kind) << " " << k;
    }
    if (least > 0.0F && least < std::numeric_limits<float>::min()) denormals_in.insert(kind);
    if (kind == PairKind::kRight) {
      ASSERT_LT(std::abs(wi[0] * wo[0] + wi[1] * wo[1] + wi[2] * wo[2]), 0.7F);
    }
  }
  EXPECT_TRUE(denormals_in.count(PairKind::kDenormal));
}

TEST(ParityThreshold, GrowsAsHighlightsSharpen) {
  Material sharp;
  sharp.set("roughness", std::sqrt(1e-3));
  EXPECT_NEAR(parity_threshold(sharp).relative, 1e-5 + 4e-4, 1e-9);
  EXPECT_EQ(parity_threshold(sharp).absolute, 1e-6);
}

}  // namespace
}  // namespace brdfit
