// Weights of a bake from the outside: maps, noise, saturation and shadow contours change what they should,
// and nothing else.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "data/synthetic/stack.h"
#include "io/exr_rows.h"
#include "io/image_reader.h"
#include "tests/cli_stack_fixture.h"
#include "tests/json_schema.h"
#include "tests/stack_files.h"

namespace brdfit::cli {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 24;
constexpr int kHeight = 20;

class CliBakeWeights : public tests::CliStackFixture {
 protected:
  // Normals and albedo given.
  static synthetic::StackRecipe recipe() {
    synthetic::StackRecipe recipe = matte_bumps(kWidth, kHeight, 24);
    recipe.files.give_normals = true;
    recipe.files.give_albedo = true;
    return recipe;
  }

  static std::string picture_of(const io::Json& manifest, std::size_t image) {
    return manifest["images"][image]["file"].get<std::string>();
  }
  io::Json manifest() const { return io::read_json(path("stack/bumps.olat.json")); }
  void change_manifest(const std::function<void(io::Json&)>& change) {
    io::Json json = manifest();
    change(json);
    io::write_json(path("stack/bumps.olat.json"), json);
  }

  // Changes the values of one picture, as floats of their full range.
  void change_picture(std::size_t image, const std::function<float(int x, int y, float value)>& change) {
    const std::filesystem::path file = path("stack/" + picture_of(manifest(), image));
    io::ImageHeader header;
    std::vector<float> values;
    {
      io::ImageReader reader(file);
      header = reader.header();
      values.resize(header.row_samples() * static_cast<std::size_t>(header.height));
      reader.read_floats(0, header.height, values);
    }
    tests::write_picture(
        file, header.width, header.height, header.channels, header.type, [&](int x, int y, int c) {
          const std::size_t at = (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)) *
                                     static_cast<std::size_t>(header.channels) +
                                 static_cast<std::size_t>(c);
          return change(x, y, values[at]);
        });
  }

  // A map of one channel beside the pictures.
  void write_map(const std::string& name, const std::function<float(int x, int y)>& value,
                 io::SampleType type = io::SampleType::kUint8) {
    tests::write_picture(path("stack/" + name), kWidth, kHeight, 1, type,
                         [&](int x, int y, int) { return value(x, y); });
  }

  tests::ProgramResult bake(const std::string& options = "") {
    return run("bake -q --force --lobes 4 --base lambert --no-evidence -o " + quoted("baked") + " " +
               options + " " + quoted("stack/bumps.olat.json"));
  }
  // The textures that hold the correction, byte by byte.
  std::string baked_bytes(const std::string& options = "") {
    const tests::ProgramResult baked = bake(options);
    EXPECT_EQ(baked.exit_code, 0) << baked.err;
    return tests::read_text(path("baked/bumps.amplitudes.exr")) +
           tests::read_text(path("baked/bumps.codes0.png")) +
           tests::read_text(path("baked/bumps.surface.exr")) +
           tests::read_text(path("baked/bumps.confidence.png"));
  }
  io::Json description() const { return io::read_json(path("baked/bumps.realis.json"))["bake"]; }

  // Root of the mean squared difference to the true amplitudes' sums under all lights of the recipe.
  double error_of(const synthetic::StackRecipe& recipe) {
    const synthetic::SyntheticStack truth(recipe);
    double squares = 0.0;
    int count = 0;
    for (std::size_t light = 0; light < truth.info().lights.size(); light += 5) {
      const Vec3 d = truth.info().lights[light].direction;
      const tests::ProgramResult relit = run(
          "relight -q --force --unpacked -o " + quoted("relit.exr") + " --light=" + std::to_string(d.x) +
          "," + std::to_string(d.y) + "," + std::to_string(d.z) + " " + quoted("baked/bumps.realis.json"));
      EXPECT_EQ(relit.exit_code, 0) << relit.err;
      const std::vector<float> found = io::ExrRowReader(path("relit.exr"), {"G"}).read(0, kHeight);
      std::vector<std::uint32_t> texels(found.size());
      for (std::uint32_t k = 0; k < texels.size(); ++k) texels[k] = k;
      const std::vector<float> expected = truth.picture(light, texels);
      for (std::size_t k = 0; k < found.size(); ++k) {
        squares += std::pow(static_cast<double>(found[k] - expected[found.size() + k]), 2);
        ++count;
      }
    }
    return 255.0 * std::sqrt(squares / count);
  }
};

bool in_region(int x, int y) {
  return x >= 6 && x < 13 && y >= 4 && y < 11;
}

TEST_F(CliBakeWeights, AMapOfOnesChangesNoByte) {
  synth(recipe());
  const std::string plain = baked_bytes();
  EXPECT_FALSE(description().contains("weights"));
  write_map("ones.png", [](int, int) { return 1.0F; });
  change_manifest([](io::Json& m) { m["images"][4]["weight"] = "ones.png"; });
  EXPECT_EQ(baked_bytes(), plain);
  EXPECT_EQ(description()["weights"]["maps"], 1);
  EXPECT_THAT(run("info " + quoted("stack/bumps.olat.json")).out,
              HasSubstr("beside them: normals, albedo, weights"));
}

TEST_F(CliBakeWeights, WeightZeroOnADamagedRegionIsAsIfItHadNotBeenSeen) {
  synth(recipe());
  const std::string sound = baked_bytes();
  change_picture(5, [](int x, int y, float v) { return in_region(x, y) ? 0.9F : v; });
  const std::string damaged = baked_bytes();
  EXPECT_NE(damaged, sound);
  const double damaged_error = error_of(recipe());
  write_map("region.png", [](int x, int y) { return in_region(x, y) ? 0.0F : 1.0F; });
  change_manifest([](io::Json& m) { m["images"][5]["weight"] = "region.png"; });
  const std::string weighted = baked_bytes();
  EXPECT_LT(error_of(recipe()), 0.5 * damaged_error);
  change_manifest([](io::Json& m) { m["images"][5].erase("weight"); });
  change_picture(
      5, [](int x, int y, float v) { return in_region(x, y) ? std::numeric_limits<float>::quiet_NaN() : v; });
  EXPECT_EQ(baked_bytes(), weighted);
  EXPECT_EQ(description()["pixels"]["non_finite"], 49);
}

TEST_F(CliBakeWeights, SaturatedPixelsAreCountedAndNotSolvedFor) {
  synthetic::StackRecipe of_integers = recipe();
  of_integers.files.format = "png";
  synth(of_integers);
  change_picture(7, [](int x, int y, float v) { return in_region(x, y) ? 1.0F : std::min(v, 0.99F); });
  const std::string saturated = baked_bytes();
  EXPECT_EQ(description()["pixels"]["saturated"], 49);
  change_picture(7, [](int x, int y, float v) { return in_region(x, y) ? 0.2F : v; });
  EXPECT_NE(baked_bytes(), saturated);
  EXPECT_EQ(description()["pixels"]["saturated"], 0);
  write_map(
      "region.exr", [](int x, int y) { return in_region(x, y) ? 0.0F : 1.0F; }, io::SampleType::kHalf);
  change_manifest([](io::Json& m) { m["images"][7]["weight"] = "region.exr"; });
  EXPECT_EQ(baked_bytes(), saturated);
}

TEST_F(CliBakeWeights, NoiseWeightsMakeGoodForShortExposures) {
  synth(recipe());
  // Half of the lights were seen a tenth as long by a sensor with noise in darkness.
  const double read = 0.004;
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(read));
  for (std::size_t image = 0; image < 24; ++image) {
    const float exposure = image % 2 == 0 ? 1.0F : 0.1F;
    change_picture(image, [&](int, int, float v) { return exposure * v + noise(random); });
    change_manifest(
        [&](io::Json& m) { m["images"][image]["exposure_seconds"] = image % 2 == 0 ? 1.0 : 0.1; });
  }
  const std::string plain = baked_bytes();
  const double without = error_of(recipe());
  const std::string asked = baked_bytes("--noise 0.004,0");
  const double with = error_of(recipe());
  EXPECT_LT(with, 0.7 * without);
  EXPECT_EQ(description()["weights"]["noise"]["read_deviation"], read);
  // The same where the manifest says so, and the command line has the last word.
  change_manifest([](io::Json& m) { m["noise"] = {{"read_deviation", 0.004}}; });
  EXPECT_EQ(baked_bytes(), asked);
  change_manifest([](io::Json& m) { m["noise"] = {{"read_deviation", 0.5}, {"shot", 1.0}}; });
  EXPECT_EQ(baked_bytes("--noise 0.004,0"), asked);
  EXPECT_NE(plain, asked);
}

// Photographs with cast shadows, and a renderer's shadows a pixel or two beside them.
class CliBakeContours : public CliBakeWeights {
 protected:
  void synth_shadows(bool with_maps) {
    synthetic::StackRecipe shadowed = recipe();
    shadowed.shape.slope = 2.0;
    shadowed.lights.theta_deg = 75;
    shadowed.cast_shadows = true;
    synth(shadowed);
    if (!with_maps) return;
    const synthetic::SyntheticStack truth(shadowed);
    for (std::size_t light = 0; light < 24; ++light) {
      const std::string name = "shadow" + std::to_string(light) + ".png";
      const Vec3 d = truth.true_lights()[light].direction;
      write_map(name, [&](int x, int y) {
        const int beside = std::min(x + 2, kWidth - 1);
        return truth.in_cast_shadow(static_cast<std::uint32_t>(y * kWidth + beside), d) ? 0.0F : 1.0F;
      });
      change_manifest([&](io::Json& m) { m["images"][light]["shadow"] = name; });
    }
  }
};

TEST_F(CliBakeContours, LowerWeightsBetweenShadowsThatDiffer) {
  synth_shadows(true);
  const std::string plain = baked_bytes();
  const std::string weighted = baked_bytes("--contours");
  EXPECT_NE(weighted, plain);
  const io::Json contours = description()["weights"]["contours"];
  EXPECT_EQ(contours["shadow_maps"], 24);
  EXPECT_GT(contours["lowered_values"].get<int>(), 50);
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/realis.schema.json"));
  EXPECT_EQ(schema.complaint(io::read_json(path("baked/bumps.realis.json"))), "");
  // Neither threads nor strips change a byte.
  EXPECT_EQ(baked_bytes("--contours --threads 1 --memory 16"), weighted);
  EXPECT_EQ(baked_bytes("--contours --spill on"), weighted);
}

TEST_F(CliBakeContours, WithoutShadowMapsThereIsLittleToCompare) {
  synth_shadows(false);
  const std::string plain = baked_bytes();
  const std::string weighted = baked_bytes("--contours");
  const io::Json contours = description()["weights"]["contours"];
  EXPECT_EQ(contours["shadow_maps"], 0);
  EXPECT_EQ(weighted == plain, contours["lowered_values"] == 0);
}

TEST_F(CliBakeWeights, WhatCannotBeAWeightIsToldInOneLine) {
  synth(recipe());
  const auto refused = [&](int exit_code, const std::string& options, const std::vector<std::string>& parts) {
    const tests::ProgramResult result = bake(options);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
    EXPECT_FALSE(std::filesystem::exists(path("baked/bumps.realis.json")));
  };
  change_manifest([](io::Json& m) { m["images"][2]["weight"] = "none.png"; });
  refused(3, "", {"'images[2].weight'", "none.png", "is not there"});
  tests::write_grey(path("stack/small.png"), 7, 5);
  change_manifest([](io::Json& m) { m["images"][2]["weight"] = "small.png"; });
  refused(3, "", {"small.png", "is 7 x 5 pixels", "expected 24 x 20"});
  write_map(
      "loud.exr", [](int x, int y) { return x == 3 && y == 2 ? 2.0F : 1.0F; }, io::SampleType::kFloat);
  change_manifest([](io::Json& m) { m["images"][2]["weight"] = "loud.exr"; });
  refused(3, "", {"loud.exr", "pixel (3, 2) holds 2", "expected values from 0 to 1"});
  write_bytes("stack/text.png", "no picture");
  change_manifest([](io::Json& m) { m["images"][2]["weight"] = "text.png"; });
  refused(3, "", {"text.png"});
  change_manifest([](io::Json& m) {
    m["images"][2].erase("weight");
    m["images"][2]["shadow"] = "loud.exr";
  });
  refused(3, "--contours", {"loud.exr", "expected values from 0 to 1"});
  change_manifest([](io::Json& m) { m["images"][2].erase("shadow"); });
  refused(2, "--noise 0.1", {"--noise"});
  refused(2, "--noise -0.1,0", {"--noise", "read_deviation must not be negative"});
  refused(2, "--noise=0,nan", {"--noise", "shot"});
  change_manifest([](io::Json& m) { m["noise"] = {{"shot", -1}}; });
  refused(3, "", {"'noise.shot'"});
}

}  // namespace
}  // namespace brdfit::cli
