// Tables and materials through one face.
#include "render/subject.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"

namespace brdfit::render {
namespace {

constexpr double kPi = std::numbers::pi;

struct Directions {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
};

// Some of them below the horizon.
Directions some_directions(std::size_t count) {
  testing_support::Random random(1);
  Directions result;
  for (std::size_t k = 0; k < count; ++k) {
    const auto pair = testing_support::pair_at(testing_support::uniform(random, 0.0, 0.5 * kPi),
                                               testing_support::uniform(random, 0.0, 0.5 * kPi),
                                               testing_support::uniform(random, 0.0, 2.0 * kPi), 0.7);
    result.wi.push_back(pair.wi);
    result.wo.push_back(pair.wo);
  }
  return result;
}

struct Values {
  std::vector<Rgb> f_cos;
  std::vector<PixelState> state;
};

// What was in the output before must not matter.
Values evaluate(const Subject& subject, const Directions& directions) {
  Values values;
  values.f_cos.assign(directions.wi.size(), {7.0, 7.0, 7.0});
  values.state.assign(directions.wi.size(), PixelState::kNegative);
  subject.eval_cos(directions.wi, directions.wo, values.f_cos, values.state);
  return values;
}

bool is_above(const Directions& directions, std::size_t k) {
  return directions.wi[k].z > 0.0 && directions.wo[k].z > 0.0;
}

TEST(Subject, IsATableOrAMaterial) {
  const Material material;
  const MeasuredTable table(Grid{1, 1, 1, CellAnchor::kCentre}, {1.0F, 1.0F, 1.0F});
  EXPECT_EQ(Subject(material).material(), &material);
  EXPECT_EQ(Subject(material).table(), nullptr);
  EXPECT_EQ(Subject(table).table(), &table);
  EXPECT_EQ(Subject(table).material(), nullptr);
}

TEST(Subject, EvaluatesMaterialsAsTheModelsDo) {
  testing_support::Random random(2);
  const Directions directions = some_directions(500);
  for (const Model model : all_models()) {
    const Material material = testing_support::random_material(model, effects_of(model), random);
    const Values values = evaluate(material, directions);
    for (std::size_t k = 0; k < values.f_cos.size(); ++k) {
      EXPECT_EQ(values.state[k], is_above(directions, k) ? PixelState::kValue : PixelState::kBelowHorizon);
      const Rgb expected = eval_cos(material, directions.wi[k], directions.wo[k]);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(values.f_cos[k][c], expected[c], 1e-12 * expected[c]);
      }
    }
  }
}

TEST(Subject, EvaluatesTablesByInterpolationTimesTheCosine) {
  const MeasuredTable table =
      testing_support::table_of(testing_support::random_full_material(Model::kLambertGgx, {}, 3));
  const Directions directions = some_directions(2000);
  const Values values = evaluate(table, directions);
  std::size_t with_value = 0;
  for (std::size_t k = 0; k < values.f_cos.size(); ++k) {
    const auto f = table.interpolate(directions.wi[k], directions.wo[k]);
    if (!is_above(directions, k)) {
      EXPECT_EQ(values.state[k], PixelState::kBelowHorizon);
      EXPECT_EQ(values.f_cos[k], (Rgb{0.0, 0.0, 0.0}));
    } else if (!f) {
      EXPECT_EQ(values.state[k], PixelState::kUnmeasured);
      EXPECT_EQ(values.f_cos[k], (Rgb{0.0, 0.0, 0.0}));
    } else {
      ++with_value;
      EXPECT_EQ(values.state[k], PixelState::kValue);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_DOUBLE_EQ(values.f_cos[k][c], (*f)[c] * directions.wi[k].z);
      }
    }
  }
  EXPECT_GT(with_value, 500U);
}

// A table whose cells are all of one kind.
TEST(Subject, SaysWhyATableHasNoValue) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::pair<std::array<float, 3>, PixelState> kinds[] = {
      {{-1.0F, -1.0F, -1.0F}, PixelState::kUnmeasured},
      {{-0.5F, 1.0F, 1.0F}, PixelState::kNegative},
      {{1.0F, nan, 1.0F}, PixelState::kNotFinite}};
  const Directions directions = some_directions(200);
  const Grid grid = {6, 5, 4, CellAnchor::kLowerEdge};
  for (const auto& [f, state] : kinds) {
    std::vector<float> planes;
    for (const float channel : f) planes.insert(planes.end(), grid.cell_count(), channel);
    const MeasuredTable table(grid, planes);
    const Values values = evaluate(table, directions);
    for (std::size_t k = 0; k < values.state.size(); ++k) {
      EXPECT_EQ(values.state[k], is_above(directions, k) ? state : PixelState::kBelowHorizon);
      EXPECT_EQ(values.f_cos[k], (Rgb{0.0, 0.0, 0.0}));
    }
  }
}

TEST(Subject, RefusesSpansOfDifferentSizes) {
  const Material material;
  const std::vector<Vec3> three(3, Vec3{0.0, 0.0, 1.0});
  const std::vector<Vec3> two(2, Vec3{0.0, 0.0, 1.0});
  std::vector<Rgb> out(3);
  std::vector<PixelState> state(3);
  std::vector<PixelState> short_state(2);
  EXPECT_THROW(Subject(material).eval_cos(three, two, out, state), std::invalid_argument);
  EXPECT_THROW(Subject(material).eval_cos(two, two, out, state), std::invalid_argument);
  EXPECT_THROW(Subject(material).eval_cos(three, three, out, short_state), std::invalid_argument);
}

TEST(PixelStateOf, KeepsTheReason) {
  EXPECT_EQ(pixel_state_of(CellState::kMeasured), PixelState::kValue);
  EXPECT_EQ(pixel_state_of(CellState::kUnmeasured), PixelState::kUnmeasured);
  EXPECT_EQ(pixel_state_of(CellState::kNegative), PixelState::kNegative);
  EXPECT_EQ(pixel_state_of(CellState::kNotFinite), PixelState::kNotFinite);
}

// At its stored angles, anywhere inside, and with wi and wo exchanged.
TEST(CellOf, FindsTheCellThatContainsTheAngles) {
  testing_support::Random random(4);
  for (const Grid& grid :
       {Grid{}, Grid{7, 5, 3, CellAnchor::kLowerEdge}, Grid{11, 90, 36, CellAnchor::kCentre}}) {
    for (int k = 0; k < 3000; ++k) {
      const int h = static_cast<int>(random() % static_cast<unsigned>(grid.n_theta_h));
      const int d = static_cast<int>(random() % static_cast<unsigned>(grid.n_theta_d));
      const int p = static_cast<int>(random() % static_cast<unsigned>(grid.n_phi_d));
      const std::size_t cell = grid.index(h, d, p);
      ASSERT_EQ(cell_of(grid, grid.angles(h, d, p)), cell);
      const auto inside = [&] { return testing_support::uniform(random, 0.001, 0.999); };
      const double root = (h + inside()) / grid.n_theta_h;
      HalfDiff angles = {root * root * 0.5 * kPi, (d + inside()) / grid.n_theta_d * 0.5 * kPi,
                         (p + inside()) / grid.n_phi_d * kPi};
      ASSERT_EQ(cell_of(grid, angles), cell);
      angles.phi_d_rad += kPi;
      ASSERT_EQ(cell_of(grid, angles), cell);
    }
  }
}

}  // namespace
}  // namespace brdfit::render
