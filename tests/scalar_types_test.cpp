// One definition, many number types: float, Jets and every vector instruction set agree with scalar double.
#include <ceres/jet.h>

#include "brdf/simd/dispatch.h"
#include "tests/model_matchers.h"
#include "tests/product_eval.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;

const std::vector<MaterialOptions> kOptions = {
    {},
    {.masking = Masking::kCorrelated, .burley_g = BurleyG::k2017, .diffuse = Diffuse::kProxima},
};

// Calls f(material) for random materials of every model, options and effects.
template <class F>
void for_random_materials(const F& f) {
  Random random(51);
  for (const Model model : all_models()) {
    for (const MaterialOptions& options : kOptions) {
      for (unsigned index = 0; index < 64; ++index) {
        const Effects effects = index < 32 ? effects_of(model) : testing_support::effect_subset(model, index);
        Material material = testing_support::random_material(model, effects, random);
        material.options() = options;
        f(material);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

// Through memory: the vectoriser of g++ 12.2 drops the rounding of a conversion to float and back.
double as_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}

Vec3 as_float(const Vec3& w) {
  return {as_float(w.x), as_float(w.y), as_float(w.z)};
}

TEST(Float, AgreesWithDoubleOnTheSameInputs) {
  Random random(52);
  std::vector<Pair> pairs = testing_support::test_pairs(200, random);
  for (Pair& pair : pairs) pair = {as_float(pair.wi), as_float(pair.wo)};
  constexpr double kUnderflow = 1e-30;
  for_random_materials([&](Material material) {
    for (double& x : material.values()) x = as_float(x);
    const std::vector<double> q = product_form(material);
    const std::vector<float> q_float(q.begin(), q.end());
    for (const Pair& pair : pairs) {
      const Rgb exact = eval_cos(material, pair.wi, pair.wo);
      const auto scale = reference::eval_cos(material, pair.wi, pair.wo);
      const auto actual =
          testing_support::eval_product(material.model(), material.options(), material.effects(),
                                        q_float.data(), testing_support::kernel_geometry<float>(pair));
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(static_cast<double>(actual[c]), exact[c],
                    kUnderflow + 1e-5 * static_cast<double>(scale[c].magnitude))
            << testing_support::describe(material, pair);
      }
    }
  });
}

template <int N>
void expect_jet_value(const Material& material, const Pair& pair) {
  const std::vector<double> q = product_form(material);
  std::vector<ceres::Jet<double, N>> variables;
  for (int k = 0; k < N; ++k) variables.emplace_back(q[static_cast<std::size_t>(k)], k);
  const auto jets = testing_support::eval_product(material.model(), material.options(), material.effects(),
                                                  variables.data(), testing_support::kernel_geometry(pair));
  const auto scale = reference::eval_cos(material, pair.wi, pair.wo);
  const Rgb expected = eval_cos(material, pair.wi, pair.wo);
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_NEAR(jets[c].a, expected[c], 1e-14 * static_cast<double>(scale[c].magnitude))
        << testing_support::describe(material, pair);
  }
}

TEST(Jets, HaveTheValueOfDouble) {
  Random random(53);
  const std::vector<Pair> pairs = testing_support::test_pairs(50, random);
  for_random_materials([&](const Material& material) {
    for (const Pair& pair : pairs) {
      if (material.model() == Model::kLambertGgx) expect_jet_value<kLambertGgxProductSize>(material, pair);
      if (material.model() == Model::kBurley) expect_jet_value<kBurleyProductSize>(material, pair);
      if (material.model() == Model::kCallisto) expect_jet_value<kCallistoProductSize>(material, pair);
    }
  });
}

// Columns of doubles for vector code, padded with the last pair.
class Columns {
 public:
  explicit Columns(const std::vector<Pair>& pairs) : count_(pairs.size()) {
    const std::size_t padded = (count_ + simd::kBlock - 1) / simd::kBlock * simd::kBlock;
    for (auto& column : directions_) column.resize(padded);
    for (auto& column : geometry_) column.resize(padded);
    for (auto& column : out_) column.resize(padded);
    for (std::size_t k = 0; k < padded; ++k) fill(k, pairs[std::min(k, count_ - 1)]);
  }

  std::vector<Rgb> eval_directions(simd::Isa isa, const Material& material) {
    const simd::DirectionColumns columns = {directions_[0].data(), directions_[1].data(),
                                            directions_[2].data(), directions_[3].data(),
                                            directions_[4].data(), directions_[5].data()};
    simd::eval_directions(isa)(simd::coefficients_of(material), columns, out_[0].size(), outputs().data());
    return result();
  }

  std::vector<Rgb> eval_geometry(simd::Isa isa, const Material& material) {
    const auto at = [this](std::size_t k) { return geometry_[k].data(); };
    const simd::GeometryColumns columns = {at(0), at(1), at(2), at(3), at(4), at(5),
                                           at(6), at(7), at(8), at(9), at(10)};
    simd::eval_columns(isa)(simd::coefficients_of(material), columns, out_[0].size(), outputs().data());
    return result();
  }

 private:
  void fill(std::size_t k, const Pair& pair) {
    const std::array<double, 6> w = {pair.wi.x, pair.wi.y, pair.wi.z, pair.wo.x, pair.wo.y, pair.wo.z};
    for (std::size_t column = 0; column < w.size(); ++column) directions_[column][k] = w[column];
    const auto g = testing_support::kernel_geometry(pair);
    const auto logs = kernel::geometry_logs(g);
    const std::array<double, 11> values = {g.cos_i,
                                           g.cos_o,
                                           std::hypot(g.h_x, g.h_y),
                                           g.cos_h,
                                           g.cos_d,
                                           g.one_minus_cos_h,
                                           g.one_minus_cos_d,
                                           logs.cos_h,
                                           logs.cos_d,
                                           logs.one_minus_cos_h,
                                           logs.one_minus_cos_d};
    for (std::size_t column = 0; column < values.size(); ++column) geometry_[column][k] = values[column];
  }
  std::array<double*, 3> outputs() { return {out_[0].data(), out_[1].data(), out_[2].data()}; }
  std::vector<Rgb> result() const {
    std::vector<Rgb> rgb;
    for (std::size_t k = 0; k < count_; ++k) rgb.push_back({out_[0][k], out_[1][k], out_[2][k]});
    return rgb;
  }

  std::size_t count_;
  std::array<std::vector<double>, 6> directions_;
  std::array<std::vector<double>, 11> geometry_;
  std::array<std::vector<double>, 3> out_;
};

void expect_scalar_values(const std::vector<Rgb>& actual, const Material& material,
                          const std::vector<Pair>& pairs, std::string_view isa) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Rgb expected = eval_cos(material, pairs[k].wi, pairs[k].wo);
    const auto scale = reference::eval_cos(material, pairs[k].wi, pairs[k].wo);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(actual[k][c], expected[c], 1e-14 * static_cast<double>(scale[c].magnitude))
          << isa << " " << testing_support::describe(material, pairs[k]);
    }
  }
}

// With directions below the horizon among them.
std::vector<Pair> pairs_of_every_kind() {
  Random random(54);
  std::vector<Pair> pairs = testing_support::test_pairs(100, random);
  pairs.push_back({{0.6, 0, -0.8}, {0, 0, 1}});
  pairs.push_back({{0, 0, 1}, {1, 0, 0}});
  pairs.push_back({{1, 0, 0}, {-1, 0, 0}});
  return pairs;
}

TEST(Simd, FromDirectionsAgreesWithScalarOnEveryInstructionSet) {
  const std::vector<Pair> pairs = pairs_of_every_kind();
  Columns columns(pairs);
  for_random_materials([&](const Material& material) {
    for (const simd::Isa isa : simd::available_isas()) {
      expect_scalar_values(columns.eval_directions(isa, material), material, pairs, name_of(isa));
    }
  });
}

TEST(Simd, FromGeometryAgreesWithScalarOnEveryInstructionSet) {
  const std::vector<Pair> pairs = pairs_of_every_kind();
  Columns columns(pairs);
  for_random_materials([&](Material material) {
    material.set_effects(material.effects().without(Effect::kAnisotropic));
    for (const simd::Isa isa : simd::available_isas()) {
      expect_scalar_values(columns.eval_geometry(isa, material), material, pairs, name_of(isa));
    }
  });
}

TEST(Simd, OffersTheBaselineFirstAndTheBestLast) {
  const auto isas = simd::available_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_EQ(isas.front(), simd::Isa::kBaseline);
  EXPECT_EQ(isas.back(), simd::best_isa());
}

TEST(Simd, InstructionSetsAreNamed) {
  EXPECT_EQ(name_of(simd::Isa::kBaseline), "baseline");
  EXPECT_EQ(name_of(simd::Isa::kAvx2), "avx2");
  EXPECT_EQ(name_of(simd::Isa::kAvx512), "avx512");
}

TEST(EvalSpans, EqualPairsForEverySizeAndWriteNothingElse) {
  Random random(55);
  Material material =
      testing_support::random_material(Model::kCallisto, effects_of(Model::kCallisto), random);
  for (const std::size_t size : {0U, 1U, 2U, 63U, 64U, 65U, 511U, 512U, 513U, 1000U}) {
    std::vector<Vec3> wi;
    std::vector<Vec3> wo;
    for (const Pair& pair : testing_support::random_pairs(size, random)) {
      wi.push_back(pair.wi);
      wo.push_back(pair.wo);
    }
    const Rgb untouched = {-1, -2, -3};
    std::vector<Rgb> f(size + 1, untouched);
    std::vector<Rgb> f_cos(size + 1, untouched);
    eval(material, wi, wo, std::span(f).first(size));
    eval_cos(material, wi, wo, std::span(f_cos).first(size));
    EXPECT_EQ(f[size], untouched);
    EXPECT_EQ(f_cos[size], untouched);
    for (std::size_t k = 0; k < size; ++k) {
      const auto scale = reference::eval_cos(material, wi[k], wo[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        const double tolerance = 1e-14 * static_cast<double>(scale[c].magnitude);
        ASSERT_NEAR(f_cos[k][c], eval_cos(material, wi[k], wo[k])[c], tolerance) << k << " of " << size;
        ASSERT_NEAR(f[k][c], eval(material, wi[k], wo[k])[c], tolerance / wi[k].z) << k << " of " << size;
      }
    }
  }
}

TEST(EvalSpans, AreDarkBelowTheHorizon) {
  const Material material(Model::kBurley);
  const std::vector<Vec3> wi = {{0.6, 0, -0.8}, {0, 0, 1}, {1, 0, 0}};
  const std::vector<Vec3> wo = {{0, 0, 1}, {0, 0.6, -0.8}, {0, 0, 1}};
  std::vector<Rgb> f(3);
  eval(material, wi, wo, f);
  for (const Rgb& rgb : f) EXPECT_EQ(rgb, (Rgb{0, 0, 0}));
}

TEST(EvalSpans, OfDifferentSizesAreRefused) {
  const Material material(Model::kCallisto);
  const std::vector<Vec3> two(2);
  const std::vector<Vec3> three(3);
  std::vector<Rgb> f(2);
  EXPECT_THROW(eval(material, two, three, f), std::invalid_argument);
  EXPECT_THROW(eval_cos(material, three, two, f), std::invalid_argument);
  EXPECT_THROW(eval_cos(material, three, three, f), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit
