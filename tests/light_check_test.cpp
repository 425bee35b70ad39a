// Lights that are not where the file says are told, and those that are right raise no suspicion.
#include "bake/light_check.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>

namespace brdfit::bake {
namespace {

constexpr int kSide = 48;

// A dome of lights in two rings and one above.
std::vector<Vec3> dome() {
  std::vector<Vec3> lights = {{0.0, 0.0, 1.0}};
  for (int k = 0; k < 20; ++k) {
    const double z = k % 2 == 0 ? 0.85 : 0.6;
    const double azimuth = 2.399963 * k;
    const double r = std::sqrt(1.0 - z * z);
    lights.push_back({r * std::cos(azimuth), r * std::sin(azimuth), z});
  }
  return lights;
}

// Slopes of a bumpy hump (or of bumps alone), x right and y up in pixels.
std::pair<double, double> slope_at(double x, double y, double hump) {
  const double p =
      -hump * x / kSide + 0.3 * std::cos(0.4 * x + 0.25 * y) + 0.1 * std::sin(0.3 * y) * std::cos(0.5 * x);
  const double q = -hump * y / kSide + 0.3 * 0.25 / 0.4 * std::cos(0.4 * x + 0.25 * y) +
                   0.1 * 0.3 / 0.5 * std::cos(0.3 * y) * std::sin(0.5 * x);
  return {p, q};
}

struct Scene {
  StackInfo info;
  TexelBlock block;
};

// Pictures under the dome with shadows, highlights and noise; the file may then say something else.
Scene scene(double hump = 1.5) {
  Scene made;
  made.info.width = made.info.height = kSide;
  for (std::size_t l = 0; l < dome().size(); ++l) {
    made.info.lights.push_back({"light" + std::to_string(l + 1) + ".png", dome()[l], {}, {1.0, 1.0, 1.0}});
  }
  made.block.texels = light_check_texels(made.info, 700);
  made.block.lights = made.info.lights.size();
  std::uint32_t state = 7;
  for (const Vec3& light : dome()) {
    std::vector<float> plane;
    for (const std::uint32_t texel : made.block.texels) {
      const double x = static_cast<double>(texel % kSide) - 0.5 * kSide;
      const double y = 0.5 * kSide - static_cast<double>(texel / kSide);
      const auto [p, q] = slope_at(x, y, hump);
      const double length = std::sqrt(p * p + q * q + 1.0);
      const double cosine = std::max(0.0, (-p * light.x - q * light.y + light.z) / length);
      const double albedo = 0.5 + 0.2 * std::sin(0.9 * x);
      state = state * 1664525U + 1013904223U;
      const double noise = 0.01 * (static_cast<double>(state >> 8) / 16777216.0 - 0.5);
      plane.push_back(static_cast<float>(albedo * cosine + std::pow(cosine, 60.0) + noise));
    }
    for (int c = 0; c < 3; ++c) made.block.rgb.insert(made.block.rgb.end(), plane.begin(), plane.end());
  }
  return made;
}

std::vector<std::string> kinds(const LightCheck& check) {
  std::vector<std::string> all;
  for (const LightSuspicion& suspicion : check.suspicions) all.push_back(suspicion.kind);
  return all;
}

void map_directions(Scene& made, const std::function<Vec3(const Vec3&)>& map) {
  for (StackLight& light : made.info.lights) light.direction = map(light.direction);
}

TEST(LightCheck, RightLightsRaiseNoSuspicion) {
  for (const double hump : {0.0, 1.5}) {
    const Scene made = scene(hump);
    const LightCheck check = check_lights(made.info, made.block);
    EXPECT_THAT(kinds(check), testing::IsEmpty()) << check.suspicions.front().text;
    EXPECT_LT(check.lambert_residual, 0.25);
    EXPECT_EQ(check.of_light.size(), made.info.lights.size());
  }
}

TEST(LightCheck, MirrorsAreToldWithTheirAxis) {
  Scene made = scene();
  map_directions(made, [](const Vec3& d) { return Vec3{d.x, -d.y, d.z}; });
  LightCheck check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::ElementsAre("mirrored"));
  EXPECT_THAT(check.suspicions[0].text, testing::HasSubstr("y of the light directions seems upside down"));
  made = scene();
  map_directions(made, [](const Vec3& d) { return Vec3{-d.x, d.y, d.z}; });
  check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::ElementsAre("mirrored"));
  EXPECT_THAT(check.suspicions[0].text, testing::HasSubstr("x of the light directions seems mirrored"));
  // Without a hump nobody can tell which.
  made = scene(0.0);
  map_directions(made, [](const Vec3& d) { return Vec3{-d.x, d.y, d.z}; });
  check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::ElementsAre("mirrored"));
  EXPECT_THAT(check.suspicions[0].text, testing::HasSubstr("x or y"));
}

TEST(LightCheck, SwappedAxesTurnsAndWrongSignsAreTold) {
  const std::vector<std::pair<std::string, std::function<Vec3(const Vec3&)>>> maps = {
      {"transposed",
       [](const Vec3& d) {
         return Vec3{d.y, d.x, d.z};
       }},
      {"turned by 90 deg",
       [](const Vec3& d) {
         return Vec3{-d.y, d.x, d.z};
       }},
      {"opposite side", [](const Vec3& d) {
         return Vec3{-d.x, -d.y, d.z};
       }}};
  for (const auto& [kind, map] : maps) {
    Scene made = scene();
    map_directions(made, map);
    EXPECT_THAT(kinds(check_lights(made.info, made.block)), testing::ElementsAre(kind));
  }
}

TEST(LightCheck, SwappedLightsAreFound) {
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>(3, 12), {1, 20}}) {
    Scene made = scene();
    std::swap(made.info.lights[a].direction, made.info.lights[b].direction);
    const LightCheck check = check_lights(made.info, made.block);
    ASSERT_THAT(kinds(check), testing::ElementsAre("swapped lights"));
    EXPECT_THAT(check.suspicions[0].lights, testing::ElementsAre(a, b));
  }
}

TEST(LightCheck, TwoSwappedPairsAreFound) {
  Scene made = scene();
  std::swap(made.info.lights[2].direction, made.info.lights[9].direction);
  std::swap(made.info.lights[5].direction, made.info.lights[16].direction);
  EXPECT_THAT(kinds(check_lights(made.info, made.block)),
              testing::ElementsAre("swapped lights", "swapped lights"));
}

TEST(LightCheck, OrdersOfTheWholeListAreTold) {
  Scene made = scene();
  for (std::size_t l = 0; l < 21; ++l) made.info.lights[l].direction = dome()[(l + 1) % 21];
  LightCheck check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::Contains("wrong order"));
  EXPECT_THAT(check.suspicions[0].text, testing::HasSubstr("one place earlier"));
  // light1, light10, light11, ... with the directions of light1, light2, light3, ...
  made = scene();
  std::vector<std::size_t> by_alphabet(21);
  std::iota(by_alphabet.begin(), by_alphabet.end(), std::size_t{0});
  std::sort(by_alphabet.begin(), by_alphabet.end(), [&](std::size_t a, std::size_t b) {
    return made.info.lights[a].name < made.info.lights[b].name;
  });
  StackInfo info = made.info;
  TexelBlock block = made.block;
  for (std::size_t l = 0; l < 21; ++l) {
    info.lights[l].name = made.info.lights[by_alphabet[l]].name;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto from = made.block.plane(by_alphabet[l], c);
      std::copy(from.begin(), from.end(), block.plane(l, c).begin());
    }
  }
  check = check_lights(info, block);
  ASSERT_THAT(kinds(check), testing::Contains("wrong order"));
  EXPECT_THAT(check.suspicions[0].text, testing::HasSubstr("sorted by"));
}

TEST(LightCheck, ALightElsewhereOrOfOtherStrengthIsTold) {
  Scene made = scene();
  made.info.lights[6].direction = {0.0, 0.8, 0.6};
  const Vec3 truth = dome()[6];
  LightCheck check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::ElementsAre("misplaced light"));
  EXPECT_THAT(check.suspicions[0].lights, testing::ElementsAre(6));
  EXPECT_GT(std::acos(0.8 * truth.y + 0.6 * truth.z), 0.5) << "the test moves it far";
  made = scene();
  for (std::size_t c = 0; c < 3; ++c) {
    for (float& value : made.block.plane(9, c)) value *= 0.4F;
  }
  check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::ElementsAre("other strength"));
  EXPECT_THAT(check.suspicions[0].lights, testing::ElementsAre(9));
}

TEST(LightCheck, TwiceTheSameIsTold) {
  Scene made = scene();
  made.info.lights[4].direction = made.info.lights[0].direction;
  EXPECT_THAT(kinds(check_lights(made.info, made.block)), testing::Contains("same direction"));
  made = scene();
  for (std::size_t c = 0; c < 3; ++c) {
    const auto from = made.block.plane(3, c);
    std::copy(from.begin(), from.end(), made.block.plane(8, c).begin());
  }
  const LightCheck check = check_lights(made.info, made.block);
  ASSERT_THAT(kinds(check), testing::Contains("same picture"));
  EXPECT_THAT(check.suspicions[0].lights, testing::ElementsAre(3, 8));
}

TEST(LightCheck, SaysNothingOfTooLittle) {
  Scene made = scene();
  std::fill(made.block.rgb.begin(), made.block.rgb.end(), 0.0F);
  EXPECT_THAT(kinds(check_lights(made.info, made.block)), testing::IsEmpty());
  StackInfo tiny;
  tiny.width = tiny.height = 1;
  EXPECT_TRUE(light_check_texels(tiny, 100).empty());
}

}  // namespace
}  // namespace brdfit::bake
