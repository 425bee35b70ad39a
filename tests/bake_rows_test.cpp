// The short way from blocks to codes against the long one.
#include "bake/bake_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "bake/compress_block.h"
#include "bake/luminance.h"
#include "tests/bake_data.h"

namespace brdfit::bake {
namespace {

constexpr double kPenalty = 0.02;

LobeSet some_lobes() {
  return {{{0.0, 0.0, 1.0}, 3.0, -1.0},
          {test_data::normalised({0.7, 0.1, 0.6}), 4.0, -0.5},
          {test_data::normalised({-0.5, 0.6, 0.5}), 2.0, -1.0},
          {test_data::normalised({-0.2, -0.8, 0.6}), 6.0, 0.0},
          {test_data::normalised({0.4, -0.4, 0.8}), 5.0, -1.0}};
}

// A Lambert sphere with something added that no Lambert surface shows.
test_data::TrueStack sphere(int size) {
  const LobeSet lobes = some_lobes();
  return test_data::make_sphere(
      size, test_data::cap_of_lights(30, 70.0), [&](const Vec3& n, const Rgb& base, const Vec3& l) {
        const double cosine = std::max(test_data::dot(n, l), 0.0);
        double added = 0.0;
        for (std::size_t k = 0; k < lobes.size(); ++k) {
          added += 0.2 * std::sin(static_cast<double>(k) + 9.0 * n.x + 5.0 * n.y) * eval(lobes[k], l);
        }
        Rgb value;
        for (std::size_t c = 0; c < 3; ++c) value[c] = cosine * (base[c] + added);
        return value;
      });
}

struct Case {
  test_data::TrueStack stack;
  BakeSettings settings;
  BakePlan plan;
  RealisPacking packing;
};

Case given(int size) {
  Case c{sphere(size), {}, {}, {}};
  c.stack.info.has_normals = c.stack.info.has_albedo = true;
  c.stack.block.normals = c.stack.truth.normals;
  c.stack.block.albedo = c.stack.truth.albedo;
  c.settings.base = BaseKind::kLambert;
  c.settings.given_lobes = some_lobes();
  c.settings.lobes = static_cast<int>(c.settings.given_lobes->size());
  c.settings.given_penalty = kPenalty;
  c.plan = decided_plan(c.stack.info, c.settings);
  c.packing = {8, c.settings.lobes, std::vector<RealisRange>(some_lobes().size(), {0.4 / 127.0, 128})};
  return c;
}

TexelBlock luminance_of(const TexelBlock& block) {
  TexelBlock out = block;
  out.channels = 1;
  out.rgb.resize(block.lights * block.count());
  for (std::size_t l = 0; l < block.lights; ++l) {
    for (std::size_t k = 0; k < block.count(); ++k) {
      const double sum =
          0.2126 * block.plane(l, 0)[k] + 0.7152 * block.plane(l, 1)[k] + 0.0722 * block.plane(l, 2)[k];
      out.plane(l, 0)[k] = static_cast<float>(sum);
    }
  }
  return out;
}

void expect_same(const BakedRows& rows, const Case& c) {
  const BakedBlock whole = bake_block(c.stack.info, c.stack.block, c.plan, c.settings);
  const SolveResult& solved = whole.solved[0];
  for (std::size_t k = 0; k < solved.amplitudes.size(); ++k) {
    ASSERT_NEAR(rows.solved.amplitudes[k], solved.amplitudes[k], 2e-4) << k;
  }
  const Compressed codes =
      compress_block(*c.plan.system, whole.problems[0], solved.amplitudes, c.stack.block.texels,
                     c.stack.info.width, c.packing.ranges, {8, c.packing.dominant, true});
  std::size_t others = 0;
  for (std::size_t k = 0; k < codes.codes.size(); ++k) {
    ASSERT_LE(std::abs(rows.stored[k] - 128 - codes.codes[k]), 12) << k;
    if (rows.stored[k] - 128 != codes.codes[k]) ++others;
  }
  // Rounding falls the other way where single precision and double do not agree on the nearer code.
  EXPECT_LT(others, codes.codes.size() / 20);
}

TEST(BakeRows, AgreesWithTheLongWayFromColours) {
  const Case c = given(37);
  ASSERT_TRUE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
  expect_same(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true), c);
}

TEST(BakeRows, AgreesWithTheLongWayFromLuminance) {
  const Case c = given(37);
  ASSERT_TRUE(needs_luminance_alone(c.stack.info, c.plan));
  expect_same(bake_rows(c.stack.info, luminance_of(c.stack.block), c.plan, c.settings, c.packing, true), c);
}

TEST(BakeRows, AgreesWithTheLongWayUnderWeightsAndWithAlbedoInTheModulation) {
  Case c = given(37);
  c.settings.albedo_in_modulation = true;
  c.stack.block.weight.assign(c.stack.block.lights * c.stack.block.count(), 1.0F);
  for (std::size_t k = 0; k < c.stack.block.weight.size(); k += 7)
    c.stack.block.weight[k] = k % 2 == 0 ? 0.0F : 0.3F;
  expect_same(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true), c);
}

TEST(BakeRows, AgreesWithTheLongWayOverAMaterial) {
  Case c = given(21);
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.4);
  c.plan.base = {material, 0.1};
  EXPECT_FALSE(needs_luminance_alone(c.stack.info, c.plan));
  expect_same(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true), c);
}

TEST(BakeRows, AgreesWithTheLongWayWhereNothingIsGiven) {
  Case c = given(21);
  c.stack.info.has_normals = c.stack.info.has_albedo = false;
  c.stack.block.normals.clear();
  c.stack.block.albedo.clear();
  expect_same(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true), c);
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.4);
  c.plan.base = {material, 0.1};
  expect_same(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true), c);
}

TEST(BakeRows, AgreesWithTheLongWayUnderNearLights) {
  Case c = given(37);
  c.stack.info.plane.pixel_size = 0.02;
  for (StackLight& light : c.stack.info.lights) {
    light.position = Vec3{2.0 * light.direction.x, 2.0 * light.direction.y, 2.0 * light.direction.z};
  }
  ASSERT_TRUE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
  ASSERT_FALSE(needs_luminance_alone(c.stack.info, c.plan));
  const BakedRows near = bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true);
  expect_same(near, c);
  for (StackLight& light : c.stack.info.lights) light.position.reset();
  EXPECT_NE(bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true).stored, near.stored);
}

// A texel's bits depend on nothing but the texel.
TEST(BakeRows, DoesNotDependOnHowAnAssetIsCut) {
  const Case c = given(37);
  const BakedRows whole = bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, true);
  const std::size_t texels = c.stack.block.count();
  for (const std::size_t first : {std::size_t{0}, std::size_t{5}, std::size_t{700}}) {
    std::vector<std::uint32_t> places(std::min<std::size_t>(101, texels - first));
    std::iota(places.begin(), places.end(), static_cast<std::uint32_t>(first));
    const BakedRows part =
        bake_rows(c.stack.info, chosen_texels(c.stack.block, places), c.plan, c.settings, c.packing, true);
    for (std::size_t lobe = 0; lobe < some_lobes().size(); ++lobe) {
      for (std::size_t k = 0; k < places.size(); ++k) {
        ASSERT_EQ(part.solved.amplitudes[lobe * places.size() + k],
                  whole.solved.amplitudes[lobe * texels + first + k]);
        ASSERT_EQ(part.stored[lobe * places.size() + k], whole.stored[lobe * texels + first + k]);
      }
    }
  }
}

// Rounded each by itself, codes leave more error than those that make each other's rounding good.
TEST(BakeRows, RoundsAmplitudesTogether) {
  Case c = given(24);
  c.packing.ranges.assign(c.packing.ranges.size(), {4.0 / 127.0, 128});
  const BakedRows rows = bake_rows(c.stack.info, c.stack.block, c.plan, c.settings, c.packing, false);
  const BakedBlock whole = bake_block(c.stack.info, c.stack.block, c.plan, c.settings);
  const std::size_t texels = c.stack.block.count();
  const double step = 4.0 / 127.0;
  double together = 0.0;
  double apart = 0.0;
  for (std::size_t t = 0; t < texels; ++t) {
    const TexelEquations equations = texel_equations(*c.plan.system, whole.problems[0], t);
    LobeVector by_code(equations.b.size());
    LobeVector by_itself(equations.b.size());
    for (Eigen::Index k = 0; k < by_code.size(); ++k) {
      const std::size_t at = static_cast<std::size_t>(k) * texels + t;
      const double best = rows.solved.amplitudes[at];
      by_code[k] = step * (rows.stored[at] - 128) - best;
      by_itself[k] = step * std::floor(best / step + 0.5) - best;
    }
    together += by_code.dot(equations.a * by_code);
    apart += by_itself.dot(equations.a * by_itself);
  }
  EXPECT_LT(together, 0.9 * apart);
}

TEST(BakeRows, AreTakenOnlyWhereTheyHoldEverything) {
  Case c = given(8);
  c.settings.colour = RealisColour::kRgb;
  EXPECT_FALSE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
  c = given(8);
  c.packing.bits = 4;
  EXPECT_FALSE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
  c = given(8);
  c.packing.dominant = 2;
  EXPECT_FALSE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
  c = given(8);
  c.packing.ranges[1].step = 0.0;
  EXPECT_FALSE(has_short_way(c.stack.info, c.plan, c.settings, c.packing));
}

TEST(DecidedPlan, KeepsThePenaltyWhateverTheLights) {
  const Case c = given(8);
  EXPECT_NEAR(c.plan.system->penalty(), kPenalty, 1e-12);
  EXPECT_TRUE(is_decided(c.settings));
  BakeSettings open = c.settings;
  open.given_penalty.reset();
  EXPECT_FALSE(is_decided(open));
  EXPECT_THROW(decided_plan(c.stack.info, open), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
