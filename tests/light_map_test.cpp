// Lights stand on the map where their directions say.
#include "render/light_map.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace brdfit::render {
namespace {

const std::vector<MappedLight> kLights = {{{0.0, 0.0, 1.0}, "top.jpg", false, false},
                                          {{0.6, 0.0, 0.8}, "right.jpg", true, false},
                                          {{0.0, 0.8, 0.6}, "up.jpg", false, true}};

bool is_red(const Picture& picture, double x, double y) {
  const auto place = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                          static_cast<std::size_t>(x));
  return picture.rgb[place] > picture.rgb[place + 2] + 100;
}

TEST(LightMap, AnUpperLightIsAboveTheCentreAndSuspectsStandOut) {
  const Picture picture = light_map_picture(kLights, {"lion", "3 lights", 640});
  const double radius = 280.0, cx = 320.0, cy = 56.0 + radius;
  EXPECT_TRUE(is_red(picture, cx, cy - 0.8 * radius));
  EXPECT_FALSE(is_red(picture, cx, cy + 0.8 * radius));
  EXPECT_FALSE(is_red(picture, cx, cy));
}

TEST(LightMap, SvgHoldsEveryLight) {
  const std::string svg = light_map_svg(kLights, {"lion & <co>", "", 640});
  for (const char* part : {"lion &amp; &lt;co&gt;", "top.jpg", "right.jpg", "up.jpg"}) {
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(svg, light_map_svg(kLights, {"lion & <co>", "", 640}));
}

TEST(LightMap, ManyLightsHaveNoLabelsButTooltips) {
  std::vector<MappedLight> many(50, kLights[0]);
  const std::string svg = light_map_svg(many, {"", "", 640});
  EXPECT_NE(svg.find("<title>top.jpg"), std::string::npos);
  EXPECT_EQ(svg.find(">top.jpg</text>"), std::string::npos);
}

TEST(LightMap, RefusesTooSmallAPicture) {
  EXPECT_THROW(light_map_svg(kLights, {"", "", 100}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::render
