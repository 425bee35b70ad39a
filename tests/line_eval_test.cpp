// Evaluation of lines, along which phi_d alone changes, against evaluation pair by pair.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "tests/random_parameters.h"

namespace brdfit {
namespace {

using testing_support::Random;

constexpr std::size_t kStride = 2 * simd::kLineBlock;

// Eight lines of one theta_h; the last is empty, and others differ in length.
struct Lines {
  simd::LineColumns columns;
  std::vector<double> cos_i, cos_o;
  std::vector<DirectionPair> pairs;

  explicit Lines(double theta_h) {
    cos_i.resize(simd::kLines * kStride, 1.0);
    cos_o.resize(simd::kLines * kStride, 1.0);
    pairs.resize(simd::kLines * kStride);
    columns.sin_h = std::sin(theta_h);
    columns.cos_h = std::cos(theta_h);
    columns.one_minus_cos_h = 2.0 * std::pow(std::sin(0.5 * theta_h), 2);
    columns.log_cos_h = std::log(columns.cos_h);
    columns.log_one_minus_cos_h = theta_h > 0.0 ? std::log(columns.one_minus_cos_h) : 0.0;
    for (std::size_t line = 0; line < simd::kLines; ++line) fill(line, theta_h);
    columns.cos_i = cos_i.data();
    columns.cos_o = cos_o.data();
    columns.stride = kStride;
  }

  void fill(std::size_t line, double theta_h) {
    const double theta_d = (std::numbers::pi / 2 - theta_h) * static_cast<double>(line) / simd::kLines;
    columns.cos_d[line] = std::cos(theta_d);
    columns.one_minus_cos_d[line] = 2.0 * std::pow(std::sin(0.5 * theta_d), 2);
    columns.log_cos_d[line] = std::log(columns.cos_d[line]);
    columns.log_one_minus_cos_d[line] = theta_d > 0.0 ? std::log(columns.one_minus_cos_d[line]) : 0.0;
    columns.count[line] = line + 1 == simd::kLines ? 0 : simd::kLineBlock * (1 + line % 2);
    for (std::size_t k = 0; k < columns.count[line]; ++k) {
      const std::size_t at = line * kStride + k;
      pairs[at] = directions_from_half_diff({theta_h, theta_d, 0.1 * static_cast<double>(k)});
      cos_i[at] = pairs[at].wi.z;
      cos_o[at] = pairs[at].wo.z;
    }
  }
};

void expect_pairs(simd::Isa isa, const Material& material, const Lines& lines) {
  constexpr double kUntouched = -7.0;
  std::array<std::vector<double>, 6> out;
  for (auto& column : out) column.assign(lines.cos_i.size(), kUntouched);
  double* const f[3] = {out[0].data(), out[1].data(), out[2].data()};
  double* const swapped[3] = {out[3].data(), out[4].data(), out[5].data()};
  simd::eval_lines(isa)(simd::coefficients_of(material), lines.columns, f, swapped);
  for (std::size_t at = 0; at < lines.pairs.size(); ++at) {
    const bool is_pair = at % kStride < lines.columns.count[at / kStride];
    const DirectionPair& pair = lines.pairs[at];
    const Rgb forth = is_pair ? eval(material, pair.wi, pair.wo) : Rgb{kUntouched, kUntouched, kUntouched};
    const Rgb back = is_pair ? eval(material, pair.wo, pair.wi) : forth;
    for (std::size_t c = 0; c < 3; ++c) {
      // Directions carry the half vector to 1e-16, which narrow lobes magnify.
      ASSERT_NEAR(f[c][at], forth[c], 1e-9 * std::abs(forth[c]) + 1e-14)
          << simd::name_of(isa) << " " << name_of(material.model()) << " entry " << at;
      ASSERT_NEAR(swapped[c][at], back[c], 1e-9 * std::abs(back[c]) + 1e-14);
    }
  }
  // Without the other order the first is the same.
  const std::array<std::vector<double>, 6> before = out;
  simd::eval_lines(isa)(simd::coefficients_of(material), lines.columns, f, nullptr);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(out[c], before[c]);
}

TEST(EvalLines, GiveWhatPairsGiveForEverySetOfEffects) {
  const std::array<Lines, 3> all_lines = {Lines(0.0), Lines(0.3), Lines(1.2)};
  Random random(11);
  for (const Model model : all_models()) {
    const Effects effects = effects_of(model).without(Effect::kAnisotropic);
    for (unsigned subset = 0; subset < 32; ++subset) {
      const Effects used(testing_support::effect_subset(model, subset).bits() & effects.bits());
      Material material = testing_support::interior_material(model, used, random);
      material.options().masking = subset % 2 == 0 ? Masking::kSeparable : Masking::kCorrelated;
      material.options().diffuse = subset % 3 == 0 ? Diffuse::kProxima : Diffuse::kLambert;
      material.options().burley_g = subset % 2 == 0 ? BurleyG::k2012 : BurleyG::k2017;
      for (const simd::Isa isa : simd::available_isas()) {
        for (const Lines& lines : all_lines) expect_pairs(isa, material, lines);
      }
    }
  }
}

}  // namespace
}  // namespace brdfit
