// brdfit info on stacks.
#include "cli/stack_info.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/program.h"
#include "tests/stack_files.h"

namespace brdfit::cli {
namespace {

using testing::HasSubstr;

std::vector<Vec3> ring(int count, double z) {
  std::vector<Vec3> lights;
  for (int k = 0; k < count; ++k) {
    const double azimuth = 2.0 * 3.141592653589793 * k / count, r = std::sqrt(1.0 - z * z);
    lights.push_back({r * std::cos(azimuth), r * std::sin(azimuth), z});
  }
  return lights;
}

TEST(LobeCondition, FewOrCrowdedLightsAreWorse) {
  std::vector<Vec3> dome = ring(12, 0.3);
  for (const double z : {0.6, 0.9}) {
    for (const Vec3& light : ring(12, z)) dome.push_back(light);
  }
  const double spread = *lobe_condition(4, dome);
  EXPECT_GE(spread, 1.0);
  EXPECT_LT(spread, 100.0);
  EXPECT_GT(*lobe_condition(8, dome), spread);
  EXPECT_GT(*lobe_condition(4, ring(12, 0.99)), 100.0 * spread);
  EXPECT_FALSE(lobe_condition(4, ring(3, 0.5)));
  EXPECT_FALSE(lobe_condition(4, std::vector<Vec3>(10, Vec3{0.0, 0.0, 1.0})));
}

// Bumps under a ring of lights and one above.
class StackInfoTest : public testing::Test {
 protected:
  StackInfoTest() {
    std::vector<Vec3> lights = ring(9, 0.7);
    lights.push_back({0.0, 0.0, 1.0});
    std::string list = "10\n";
    for (std::size_t l = 0; l < lights.size(); ++l) {
      const Vec3 light = lights[l];
      const std::string name = "p" + std::to_string(l) + ".png";
      tests::write_picture(folder_ / name, 48, 40, 3, io::SampleType::kUint8, [light](int x, int y, int) {
        const double p = 0.4 * std::cos(0.4 * x - 0.2 * y) - 0.02 * (x - 24);
        const double q = 0.2 * std::cos(0.4 * x - 0.2 * y) + 0.02 * (y - 20);
        const double cosine = (light.z - p * light.x - q * light.y) / std::sqrt(1.0 + p * p + q * q);
        // One lamp is too bright for the camera.
        return static_cast<float>(std::max(0.0, cosine) * (x == 0 && y < 20 ? 2.0 : 0.9));
      });
      list += name + " " + std::to_string(light.x) + " " + std::to_string(light.y) + " " +
              std::to_string(light.z) + "\n";
      flipped_ += name + " " + std::to_string(light.x) + " " + std::to_string(-light.y) + " " +
                  std::to_string(light.z) + "\n";
    }
    tests::write_text(folder_ / "lights.lp", list);
    tests::write_text(folder_ / "flipped.lp", "10\n" + flipped_);
    std::filesystem::create_directories(folder_ / "streams");
  }
  tests::ProgramResult info(const std::string& arguments) {
    return tests::run_brdfit("info " + arguments, folder_ / "streams");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  tests::TempFolder folder_;
  std::string flipped_;
};

TEST_F(StackInfoTest, SaysWhatIsThere) {
  const auto result = info(path("lights.lp") + " --transfer linear --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const io::Json json = io::Json::parse(result.out);
  EXPECT_EQ(json["kind"], "stack");
  EXPECT_EQ(json["width"], 48);
  EXPECT_EQ(json["height"], 40);
  EXPECT_EQ(json["lights"], 10);
  EXPECT_EQ(json["depth"], "8 bit");
  EXPECT_EQ(json["transfer"], "linear");
  EXPECT_EQ(json["transfer_from"], "asked for");
  EXPECT_GT(json["saturated_pct"], 0.5);
  EXPECT_LT(json["saturated_pct"], 1.1);
  EXPECT_EQ(json["coverage"]["texels"], 48 * 40);
  EXPECT_GE(json["coverage"]["lights_of_half"], 9);
  EXPECT_GT(json["lobe_condition"]["4"], 1.0);
  EXPECT_THAT(json["suspicions"], testing::IsEmpty()) << json["suspicions"];
  EXPECT_THAT(info(path("lights.lp")).out, HasSubstr("transfer: srgb (the usual for 8 bit)"));
}

TEST_F(StackInfoTest, TellsOfAnUpsideDownY) {
  const auto result = info(path("flipped.lp") + " --transfer linear");
  EXPECT_THAT(result.out, HasSubstr("suspicious: y of the light directions seems upside down"));
}

TEST_F(StackInfoTest, DrawsTheLights) {
  for (const std::string name : {"map.png", "map.svg"}) {
    const std::string arguments = path("lights.lp") + " --lights " + path(name);
    ASSERT_EQ(info(arguments).exit_code, 0);
    EXPECT_GT(std::filesystem::file_size(folder_ / name), 1000U);
    EXPECT_EQ(info(arguments).exit_code, 2) << "not overwritten without --force";
    EXPECT_EQ(info(arguments + " --force").exit_code, 0);
  }
  EXPECT_EQ(info(path("lights.lp") + " --lights " + path("map.jpg")).exit_code, 2);
}

TEST_F(StackInfoTest, UnusableStacksEndIn3WithOneLine) {
  tests::write_text(folder_ / "short.lp", "11\n" + flipped_);
  tests::write_text(folder_ / "broken.json", R"({"version": 1, "images": )");
  tests::write_text(folder_ / "unknown.json", R"({"version": 1, "images": [], "picture": 1})");
  tests::write_text(folder_ / "missing.json",
                    R"({"version": 1, "images": [{"file": "none.png", "direction": [0, 0, 1]}]})");
  for (const char* name : {"short.lp", "broken.json", "unknown.json", "missing.json", "none.lp"}) {
    const auto result = info(path(name));
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr(name));
  }
  EXPECT_EQ(info(path("lights.lp") + " --transfer log").exit_code, 2);
}

}  // namespace
}  // namespace brdfit::cli
