// Vectorised costs and Gram matrices against sums over samples that are written out, for every instruction
// set, model, option, loss and set of effects.
#include "fit/gram.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "fit/problem.h"
#include "tests/product_jets.h"
#include "tests/random_parameters.h"

namespace brdfit::fit {
namespace {

using testing_support::Random;
using testing_support::Sloped;
using testing_support::uniform;

constexpr double kFloor = 1e-3;

// A transformed value and its slope by y = f cos_i, as fit/loss.h describes them.
struct Curve {
  double value;
  double slope;
};

Curve srgb_curve(double x) {
  if (x < 0.0031308) return {12.92 * x, 12.92};
  return {1.055 * std::pow(x, 1 / 2.4) - 0.055, 1.055 / 2.4 * std::pow(x, 1 / 2.4 - 1)};
}

Curve expected_curve(Loss loss, double y, double cos_i) {
  switch (loss) {
    case Loss::kLogRatio:
      return {std::log(y + kFloor), 1 / (y + kFloor)};
    case Loss::kCubeRoot:
      return {std::cbrt(y + 1e-6), 1 / (3 * std::pow(std::cbrt(y + 1e-6), 2))};
    case Loss::kLinear:
      return {y, 1.0};
    case Loss::kSrgb: {
      const Curve curve = srgb_curve(std::numbers::pi * y);
      return {curve.value, std::numbers::pi * curve.slope};
    }
    case Loss::kSlice:
      break;
  }
  return y / cos_i > 1 ? Curve{1.0, 0.0} : Curve{y / cos_i, 1 / cos_i};
}

// The cost of a residual and its derivative over the residual: pseudo-Huber of the width, squares for 0.
double robust_cost(double r, double width) {
  if (width == 0.0) return r * r / 2;
  return width * width * (std::hypot(1.0, r / width) - 1);
}

double robust_weight(double r, double width) {
  return width == 0.0 ? 1.0 : 1 / std::hypot(1.0, r / width);
}

// What a measured value is compared with: f(wi, wo), or its mean with f(wo, wi).
enum class Orders { kOne, kMean };

// f cos_i.
Rgb expected_value(const Material& material, const DirectionPair& pair, Orders orders) {
  if (orders == Orders::kOne) return eval_cos(material, pair.wi, pair.wo);
  Rgb y = eval(material, pair.wi, pair.wo);
  const Rgb back = eval(material, pair.wo, pair.wi);
  for (std::size_t c = 0; c < 3; ++c) y[c] = 0.5 * (y[c] + back[c]) * pair.wi.z;
  return y;
}

// Observations with their directions, so that brdf/models.h can be asked about them.
struct Observed {
  SampleSet samples;
  std::vector<DirectionPair> pairs;
};

// Whether a value is at the clipped residual's corner, over which differences must not step.
bool is_nearly_clipped(const Rgb& f) {
  return std::ranges::any_of(f, [](double x) { return std::abs(x - 1.0) < 0.02; });
}

// About as bright as the material: above and below it, clipped and not.
Observed observe(const Material& material, std::size_t count, Random& random) {
  Observed observed;
  while (observed.pairs.size() < count) {
    const HalfDiff angles = {uniform(random, 0, 1.55), uniform(random, 0, 1.55), uniform(random, 0, 3.14)};
    const DirectionPair pair = directions_from_half_diff(angles);
    if (pair.wi.z < 0.01 || pair.wo.z < 0.01) continue;
    Rgb f = expected_value(material, pair, Orders::kMean);
    for (double& channel : f) channel /= pair.wi.z;
    if (is_nearly_clipped(f)) continue;
    for (double& channel : f) channel *= std::exp(uniform(random, -0.5, 0.5));
    observed.samples.add(cell_geometry(angles), f, uniform(random, 0.1, 2.0));
    observed.pairs.push_back(pair);
  }
  observed.samples.finish();
  return observed;
}

GramJob job_of(const Material& material, const SampleSet& samples, const Targets& targets, Loss loss,
               Orders orders) {
  GramJob job;
  job.coefficients = simd::coefficients_of(material);
  job.geometry = samples.geometry();
  job.sqrt_weight = targets.sqrt_weight.data();
  for (std::size_t c = 0; c < 3; ++c) {
    job.target[c] = targets.value[c].data();
    job.clipped_target[c] = targets.clipped[c].data();
  }
  job.count = samples.padded_size();
  job.mean_of_orders = orders == Orders::kMean;
  job.loss = static_cast<int>(loss);
  job.robust_width = targets.robust_width;
  job.clipped_width = targets.clipped_width;
  job.clipped_share = targets.clipped_share.data();
  return job;
}

// The share of the clipped residual, which ends at 80 deg.
double expected_share(const SampleSet& samples, std::size_t k, Loss loss) {
  const double cos_h = samples.cos_h()[k];
  const double cos_d = samples.cos_d()[k];
  const double end = std::cos(80 * std::numbers::pi / 180);
  if (cos_h <= end || cos_d <= end) return 0.0;
  return shape_of(loss).clipped_share / std::sqrt(cos_h * cos_d);
}

double expected_cost(const Material& material, const Observed& observed, Loss loss, Orders orders) {
  const SampleSet& s = observed.samples;
  const LossShape shape = shape_of(loss);
  double cost = 0.0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Rgb y = expected_value(material, observed.pairs[k], orders);
    const double cos_i = observed.pairs[k].wi.z;
    for (std::size_t c = 0; c < 3; ++c) {
      const double measured = s.f(static_cast<int>(c))[k];
      const double r =
          expected_curve(loss, y[c], cos_i).value - expected_curve(loss, measured * cos_i, cos_i).value;
      const double u = std::min(y[c] / cos_i, 1.0) - std::min(measured, 1.0);
      cost += s.weight()[k] * (robust_cost(r, shape.robust_width) +
                               expected_share(s, k, loss) * robust_cost(u, shape.clipped_width));
    }
  }
  return cost;
}

// [J r]^T [J r] by the product form, through Jets, without the corner r^T r; robust residuals weighted, in
// J^T J by the second derivative of the cost where curvature is asked for.
Eigen::MatrixXd expected_gram(const SampleSet& s, const std::vector<std::array<Sloped, 3>>& rows, Loss loss,
                              bool curvature) {
  const LossShape shape = shape_of(loss);
  const Eigen::Index n = rows[0][0].slope.size();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n + 1, n + 1);
  for (std::size_t k = 0; k < s.size(); ++k) {
    const double cos_i = s.cos_i()[k];
    for (std::size_t c = 0; c < 3; ++c) {
      const Sloped& row = rows[k][c];
      const auto add = [&](Loss curve_of, double width, double share) {
        const Curve curve = expected_curve(curve_of, row.value, cos_i);
        const double measured = s.f(static_cast<int>(c))[k];
        const double r = curve.value - expected_curve(curve_of, measured * cos_i, cos_i).value;
        const double robust = robust_weight(r, width);
        const double weight = s.weight()[k] * share;
        gram.topLeftCorner(n, n) += weight * (curvature ? std::pow(robust, 3) : robust) * curve.slope *
                                    curve.slope * row.slope * row.slope.transpose();
        gram.col(n).head(n) += weight * robust * curve.slope * r * row.slope;
      };
      add(loss, shape.robust_width, 1.0);
      add(Loss::kSlice, shape.clipped_width, expected_share(s, k, loss));
    }
  }
  return gram;
}

// The same from vector code, chained from coefficients to the product form.
Eigen::MatrixXd chained_gram(const Material& material, const Gram& sums) {
  const std::vector<double> q = product_form(material);
  const auto n = static_cast<Eigen::Index>(q.size());
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(n + 1, n + 1);
  for (int c = 0; c < 3; ++c) {
    const Eigen::MatrixXd jacobian = coefficient_jacobian(material, q, c);
    const Eigen::Index rows = jacobian.rows();
    Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(rows + 1, n + 1);
    chain.topLeftCorner(rows, n) = jacobian;
    chain(rows, n) = 1.0;
    const Eigen::Map<const Eigen::Matrix<double, kGramSide, kGramSide, Eigen::RowMajor>> upper(
        sums.channel[c]);
    const Eigen::MatrixXd full = upper.topLeftCorner(rows + 1, rows + 1).selfadjointView<Eigen::Upper>();
    total += chain.transpose() * full * chain;
  }
  return total;
}

// Entries relative to what rows and columns are made of.
void expect_same_gram(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double cost,
                      double tolerance = 1e-10) {
  const Eigen::Index n = expected.rows() - 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size_i = std::sqrt(expected(i, i));
    for (Eigen::Index j = 0; j < n; ++j) {
      ASSERT_NEAR(actual(i, j), expected(i, j), tolerance * size_i * std::sqrt(expected(j, j)) + 1e-300)
          << i << ", " << j;
    }
    ASSERT_NEAR(actual(i, n), expected(i, n), tolerance * size_i * std::sqrt(2 * cost) + 1e-300) << i;
  }
}

// Float sums of one material; where there is no code for them they are those in double precision.
void expect_single_sums(const Material& material, const GramJob& job, const Eigen::MatrixXd& expected,
                        double cost, simd::Isa isa) {
  const std::vector<float> columns = single_columns(job);
  GramJob single = job;
  single.single = columns.data();
  single.single_stride = job.count;
  Gram gram;
  gram_function(isa)(single, gram);
  ASSERT_NEAR(gram.cost, cost, 1e-5 * cost);
  expect_same_gram(chained_gram(material, gram), expected, cost, 1e-4);
}

// Everything that is claimed of one material, for all losses and instruction sets.
void expect_sums(const Material& material, Orders orders, Random& random) {
  // More than two blocks of vector code, and not a multiple of one.
  const Observed observed = observe(material, 600, random);
  const SampleSet& samples = observed.samples;
  const std::vector<double> q = product_form(material);
  std::vector<std::array<Sloped, 3>> rows;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const kernel::Geometry<double> g = testing_support::geometry_of(samples, k);
    rows.push_back(orders == Orders::kOne ? testing_support::sloped(material, q, g)
                                          : testing_support::sloped_mean(material, q, g));
  }
  for (const Loss loss : all_losses()) {
    const Targets targets = make_targets(samples, loss);
    const GramJob job = job_of(material, samples, targets, loss, orders);
    GramJob curved = job;
    curved.curvature = true;
    const double cost = expected_cost(material, observed, loss, orders);
    const Eigen::MatrixXd expected = expected_gram(samples, rows, loss, false);
    const Eigen::MatrixXd expected_curvature = expected_gram(samples, rows, loss, true);
    for (const simd::Isa isa : simd::available_isas()) {
      SCOPED_TRACE(testing::Message()
                   << name_of(material.model()) << ", effects " << material.effects().bits() << ", "
                   << name_of(loss) << ", " << simd::name_of(isa));
      Gram gram;
      gram_function(isa)(job, gram);
      ASSERT_NEAR(gram.cost, cost, 1e-11 * cost);
      ASSERT_NEAR(cost_function(isa)(job), cost, 1e-11 * cost);
      expect_same_gram(chained_gram(material, gram), expected, cost);
      expect_single_sums(material, job, expected, cost, isa);
      gram_function(isa)(curved, gram);
      expect_same_gram(chained_gram(material, gram), expected_curvature, cost);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

Effects isotropic_subset(Model model, unsigned index) {
  return testing_support::effect_subset(model, index).without(Effect::kAnisotropic);
}

// The sanitizers ask whether memory is touched that is not there: for that every effect on and off is enough.
#if defined(__SANITIZE_ADDRESS__)
constexpr unsigned kSubsetStep = 5;
#else
constexpr unsigned kSubsetStep = 1;
#endif

void expect_sums_with(Model model, const MaterialOptions& options) {
  Random random(71);
  const unsigned subsets = effects_of(model).bits() == 0 ? 4 : 32;
  for (unsigned index = 0; index < subsets; index += kSubsetStep) {
    Material material = testing_support::interior_material(model, isotropic_subset(model, index), random);
    material.options() = options;
    for (const Orders orders : {Orders::kOne, Orders::kMean}) {
      if (orders == Orders::kMean && is_reciprocal(material)) continue;
      expect_sums(material, orders, random);
    }
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(GramSums, OfLambertGgxEqualPlainSums) {
  for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
    for (const Diffuse diffuse : {Diffuse::kLambert, Diffuse::kProxima}) {
      expect_sums_with(Model::kLambertGgx, {.masking = masking, .diffuse = diffuse});
    }
  }
}

TEST(GramSums, OfBurleyEqualPlainSums) {
  for (const BurleyG burley_g : {BurleyG::k2012, BurleyG::k2017}) {
    expect_sums_with(Model::kBurley, {.burley_g = burley_g});
  }
}

TEST(GramSums, OfCallistoEqualPlainSums) {
  for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
    for (const Diffuse diffuse : {Diffuse::kLambert, Diffuse::kProxima}) {
      expect_sums_with(Model::kCallisto, {.masking = masking, .diffuse = diffuse});
    }
  }
}

// At the ends of the ranges, where falloffs are 0^0 and steps are sharp: finite, and the same.
TEST(GramSums, AreFiniteAtTheEndsOfTheRanges) {
  Random random(72);
  for (const Model model : all_models()) {
    for (int repeat = 0; repeat < 20; ++repeat) {
      Material material =
          testing_support::random_material(model, effects_of(model).without(Effect::kAnisotropic), random);
      const Observed observed = observe(material, 200, random);
      for (const Loss loss : all_losses()) {
        const Targets targets = make_targets(observed.samples, loss);
        const GramJob job = job_of(material, observed.samples, targets, loss, Orders::kMean);
        const double cost = expected_cost(material, observed, loss, Orders::kMean);
        for (const simd::Isa isa : simd::available_isas()) {
          Gram gram;
          gram_function(isa)(job, gram);
          EXPECT_NEAR(gram.cost, cost, 1e-10 * cost) << name_of(model) << ", " << name_of(loss);
          EXPECT_TRUE(chained_gram(material, gram).allFinite());
          const std::vector<float> columns = single_columns(job);
          GramJob single = job;
          single.single = columns.data();
          single.single_stride = job.count;
          gram_function(isa)(single, gram);
          EXPECT_NEAR(gram.cost, cost, 1e-5 * cost) << name_of(model) << ", " << name_of(loss);
          EXPECT_TRUE(chained_gram(material, gram).allFinite());
        }
      }
    }
  }
}

// A problem in single precision is the same problem, and its cost alone is exact.
TEST(GramSums, InSinglePrecisionAreThoseOfTheSameProblem) {
  Random random(74);
  for (const Model model : all_models()) {
    const Material material = testing_support::interior_material(model, isotropic_subset(model, 31), random);
    // More than a chunk, and not a whole number of them.
    const Observed observed = observe(material, 5000, random);
    const Parametrisation parametrisation =
        make_parametrisation(Material(model), {Tier::kFull, isotropic_subset(model, 31), {}, {}});
    const std::vector<double> x = parametrisation.from_material(material);
    for (const Loss loss : all_losses()) {
      const Targets targets = make_targets(observed.samples, loss);
      const Problem exact(parametrisation, observed.samples, targets, loss);
      const Problem rough(parametrisation, observed.samples, targets, loss, Precision::kSingle);
      EXPECT_EQ(exact.cost(x), rough.cost(x));
      double cost = 0.0;
      double rough_cost = 0.0;
      const Eigen::MatrixXd gram = exact.gram(x, &cost);
      expect_same_gram(rough.gram(x, &rough_cost), gram, cost, 1e-4);
      EXPECT_NEAR(rough_cost, cost, 1e-5 * cost);
      EXPECT_EQ(exact.curvature(x), rough.curvature(x));
    }
  }
}

// Padding weighs nothing, whatever it holds.
TEST(GramSums, DoNotSeePadding) {
  Random random(73);
  const Material material =
      testing_support::interior_material(Model::kCallisto, effects_of(Model::kCallisto), random);
  const Observed observed = observe(material, 65, random);
  Targets targets = make_targets(observed.samples, Loss::kLogRatio);
  const double cost = cost_function(simd::best_isa())(
      job_of(material, observed.samples, targets, Loss::kLogRatio, Orders::kMean));
  ASSERT_EQ(targets.value[0].size(), 128U);
  for (std::size_t k = 65; k < 128; ++k) targets.value[0][k] = 1e3;
  EXPECT_EQ(cost_function(simd::best_isa())(
                job_of(material, observed.samples, targets, Loss::kLogRatio, Orders::kMean)),
            cost);
}

class ProblemOf : public testing::TestWithParam<std::tuple<Model, Loss>> {
 protected:
  // Every free number in the interior; fixed ones make for sources of -1 and factors.
  Parametrisation parametrisation(const FixedValues& fixed) {
    const Model model = std::get<0>(GetParam());
    const Effects effects = effects_of(model).without(Effect::kAnisotropic);
    const Material start = testing_support::interior_material(model, effects, random_);
    return make_parametrisation(start, {Tier::kFull, effects, fixed});
  }

  void expect_gradient(const Parametrisation& parametrisation) {
    const Loss loss = std::get<1>(GetParam());
    const std::vector<double> x = parametrisation.from_material(parametrisation.start);
    const Observed observed = observe(parametrisation.to_material(x), 300, random_);
    const Targets targets = make_targets(observed.samples, loss);
    const Problem problem(parametrisation, observed.samples, targets, loss);
    double cost = 0.0;
    const Eigen::MatrixXd gram = problem.gram(x, &cost);
    EXPECT_NEAR(cost, problem.cost(x), 1e-13 * cost);
    EXPECT_NEAR(cost, expected_cost(parametrisation.to_material(x), observed, loss, Orders::kMean),
                1e-10 * cost);
    EXPECT_TRUE(gram.isApprox(gram.transpose(), 1e-13));
    for (std::size_t k = 0; k < x.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      EXPECT_NEAR(gram(at, gram.cols() - 1), difference(problem, x, k),
                  1e-6 * std::sqrt(gram(at, at) * 2 * cost) + 1e-12)
          << parametrisation.free[k].name << " = " << x[k];
    }
  }

  Random random_{74};

 private:
  // Central difference of fourth order of the cost.
  static double difference(const Problem& problem, const std::vector<double>& x, std::size_t k) {
    const double step = 1e-4 * std::max(0.1, std::abs(x[k])) *
                        (problem.parametrisation().free[k].name == "roughness" ? x[k] : 1.0);
    const auto cost_at = [&](double steps) {
      std::vector<double> moved = x;
      moved[k] += steps * step;
      return problem.cost(moved);
    };
    return (8 * (cost_at(1) - cost_at(-1)) - (cost_at(2) - cost_at(-2))) / (12 * step);
  }
};

TEST_P(ProblemOf, FreeNumbersHasTheGradientOfItsCost) {
  expect_gradient(parametrisation({}));
}

TEST_P(ProblemOf, FixedNumbersHasTheGradientOfItsCost) {
  FixedValues fixed = {{"metallic", {0.3}}};
  if (std::get<0>(GetParam()) == Model::kCallisto) {
    fixed["diffuse_fresnel_tint"] = {0.5, 1.0, 0.25};
    fixed["retroreflection"] = {4.0};
  }
  expect_gradient(parametrisation(fixed));
}

// All but the clipped loss, whose cost has kinks that differences step over.
INSTANTIATE_TEST_SUITE_P(
    ModelsAndLosses, ProblemOf,
    testing::Combine(testing::Values(Model::kLambertGgx, Model::kBurley, Model::kCallisto),
                     testing::Values(Loss::kLogRatio, Loss::kCubeRoot, Loss::kLinear, Loss::kSrgb)));

}  // namespace
}  // namespace brdfit::fit
