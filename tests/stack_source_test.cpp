// Manifests and light files: what they say is kept, and what is wrong in them is told in one line.
#include "io/stack_source.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "tests/json_schema.h"
#include "tests/stack_files.h"

namespace brdfit::io {
namespace {

using testing::HasSubstr;
using tests::input_error_of;
using tests::two_lights;
using tests::write_grey;
using tests::write_text;

class StackSourceTest : public testing::Test {
 protected:
  StackSourceTest() {
    for (const char* name : {"a.png", "b.png", "with space.png", "extra.png"}) write_grey(folder_ / name);
  }
  std::filesystem::path write(const Json& manifest) {
    write_json(folder_ / "olat.json", manifest);
    return folder_ / "olat.json";
  }
  std::string error_of(const Json& manifest) {
    return input_error_of([&] { read_stack_source(write(manifest)); });
  }
  std::string error_of_lights(const std::string& text) {
    write_text(folder_ / "lights.lp", text);
    return input_error_of([&] { read_stack_source(folder_ / "lights.lp"); });
  }
  // Whether the schema and the reader are of one mind about a manifest.
  void expect_agreement(const Json& manifest, bool is_valid) {
    static const tests::JsonSchema schema(read_json(BRDFIT_SOURCE_DIR "/docs/schema/olat.schema.json"));
    EXPECT_EQ(schema.complaint(manifest).empty(), is_valid) << manifest << schema.complaint(manifest);
    EXPECT_EQ(error_of(manifest) == "no error", is_valid) << manifest << error_of(manifest);
  }
  tests::TempFolder folder_;
};

// As a person would write it, with everything in it.
Json full_manifest() {
  Json manifest = Json::parse(R"({"version": 1,
    "images": [
      {"file": "a.png", "position": [0, 0, 400], "intensity": [1, 0.9, 0.8], "exposure_seconds": 0.01,
       "weight": "extra.png", "shadow": "extra.png"},
      {"file": "b.png", "direction": [0.6, 0, 0.8], "exposure_seconds": 0.02}],
    "dark": "extra.png", "flat": "extra.png", "mask": "extra.png", "normals": "extra.png", "albedo": "extra.png",
    "noise": {"read_deviation": 0.01, "shot": 0.001},
    "transfer": "gamma 2.2", "color_matrix": [[1.5, -0.4, -0.1], [-0.2, 1.4, -0.2], [0, -0.5, 1.5]],
    "view": [0, 0, 1], "pixel_size": 0.1, "origin": [-0.2, 0.1, 0], "units": "mm"})");
  return manifest;
}

Json chart_of(const std::function<Rgb(const Rgb&)>& camera) {
  Json chart = Json::array();
  for (const Rgb& patch : chart_reference()) chart.push_back(camera(patch));
  return chart;
}

TEST_F(StackSourceTest, KeepsAllThatAManifestSays) {
  const StackSource source = read_olat(write(full_manifest()));
  ASSERT_EQ(source.pictures.size(), 2U);
  EXPECT_EQ(source.name, "olat");
  EXPECT_EQ(source.pictures[0].light.name, "a.png");
  EXPECT_EQ(source.pictures[0].light.position->z, 400.0);
  EXPECT_EQ(source.pictures[0].light.intensity, (Rgb{1.0, 0.9, 0.8}));
  EXPECT_EQ(source.pictures[1].exposure_seconds, 0.02);
  EXPECT_EQ(source.pictures[1].light.direction.x, 0.6);
  EXPECT_EQ(source.pictures[0].weight, folder_ / "extra.png");
  EXPECT_EQ(source.pictures[0].shadow, folder_ / "extra.png");
  EXPECT_FALSE(source.pictures[1].weight || source.pictures[1].shadow);
  EXPECT_EQ(source.noise, (StatedNoise{0.01, 0.001}));
  EXPECT_EQ(source.transfer, (Transfer{Transfer::Kind::kGamma, 2.2}));
  EXPECT_EQ(source.color_matrix[0][1], -0.4);
  EXPECT_EQ(source.plane.pixel_size, 0.1);
  EXPECT_EQ(source.plane.origin.y, 0.1);
  EXPECT_EQ(source.units, "mm");
  for (const auto& file : {source.dark, source.flat, source.mask, source.normals, source.albedo}) {
    EXPECT_EQ(file, folder_ / "extra.png");
  }
}

TEST_F(StackSourceTest, OrderDoesNotMatter) {
  Json reversed = two_lights();
  std::reverse(reversed["images"].begin(), reversed["images"].end());
  const StackSource one = read_olat(write(two_lights()));
  const StackSource other = read_olat(write(reversed));
  write_text(folder_ / "lights.lp", "2\nb.png 0.6 0 0.8\na.png 0 0 1\n");
  const StackSource lights = read_light_positions(folder_ / "lights.lp");
  for (std::size_t k = 0; k < 2; ++k) {
    for (const StackSource* source : {&other, &lights}) {
      EXPECT_EQ(source->pictures[k].file, one.pictures[k].file);
      EXPECT_EQ(source->pictures[k].light.direction.x, one.pictures[k].light.direction.x);
    }
  }
}

TEST_F(StackSourceTest, AChartGivesTheMatrixThatUndoesTheCamera) {
  Json manifest = two_lights();
  // A camera that mixes its channels, at half the brightness.
  const Matrix3 camera = {{{0.4, 0.1, 0.0}, {0.05, 0.4, 0.05}, {0.0, 0.1, 0.4}}};
  manifest["chart"] = chart_of([&](const Rgb& patch) { return camera * patch; });
  const StackSource source = read_olat(write(manifest));
  const Rgb back = source.color_matrix * (camera * Rgb{0.2, 0.5, 0.7});
  EXPECT_NEAR(back[0], 0.2, 1e-9);
  EXPECT_NEAR(back[1], 0.5, 1e-9);
  EXPECT_NEAR(back[2], 0.7, 1e-9);
  EXPECT_LT(*source.chart_rms, 1e-9);
}

TEST_F(StackSourceTest, SchemaAndReaderAgree) {
  expect_agreement(two_lights(), true);
  expect_agreement(full_manifest(), true);
  Json with_chart = two_lights();
  with_chart["chart"] = chart_of([](const Rgb& patch) { return patch; });
  expect_agreement(with_chart, true);

  const auto broken = [](const std::function<void(Json&)>& change) {
    Json manifest = full_manifest();
    change(manifest);
    return manifest;
  };
  const std::vector<std::function<void(Json&)>> changes = {
      [](Json& m) { m.erase("version"); },
      [](Json& m) { m["version"] = 2; },
      [](Json& m) { m.erase("images"); },
      [](Json& m) { m["images"] = Json::array(); },
      [](Json& m) { m["images"][0].erase("file"); },
      [](Json& m) { m["images"][0].erase("position"); },
      [](Json& m) {
        m["images"][0]["direction"] = {0, 0, 1};
      },
      [](Json& m) {
        m["images"][0]["intensity"] = {1, 0, 1};
      },
      [](Json& m) { m["images"][0]["intensity"] = 1; },
      [](Json& m) { m["images"][0]["exposure_seconds"] = 0; },
      [](Json& m) { m["images"][0]["exposure_seconds"] = "1/60"; },
      [](Json& m) { m["images"][0]["colour"] = 1; },
      [](Json& m) { m["images"][0]["weight"] = 0.5; },
      [](Json& m) { m["images"][0]["shadow"] = false; },
      [](Json& m) { m["noise"] = 0.1; },
      [](Json& m) { m["noise"]["shot"] = -1; },
      [](Json& m) { m["noise"]["read_deviation"] = "0.1"; },
      [](Json& m) { m["noise"]["dark"] = 1; },
      [](Json& m) {
        m["images"][1]["direction"] = {0, 1};
      },
      [](Json& m) { m["unknown"] = 1; },
      [](Json& m) { m["dark"] = 1; },
      [](Json& m) { m["transfer"] = "log"; },
      [](Json& m) { m["transfer"] = "gamma"; },
      [](Json& m) {
        m["color_matrix"] = {{1, 0, 0}, {0, 1, 0}};
      },
      [](Json& m) { m["chart"] = chart_of([](const Rgb& patch) { return patch; }); },
      [](Json& m) { m["view"] = "z"; },
      [](Json& m) { m["pixel_size"] = 0; },
      [](Json& m) {
        m["origin"] = {0, 0};
      },
      [](Json& m) { m["units"] = 1; },
  };
  for (const auto& change : changes) expect_agreement(broken(change), false);
}

TEST_F(StackSourceTest, EveryMistakeInAManifestIsNamed) {
  const auto with = [](const std::function<void(Json&)>& change) {
    Json manifest = full_manifest();
    change(manifest);
    return manifest;
  };
  const std::vector<std::pair<std::function<void(Json&)>, std::string>> mistakes = {
      {[](Json& m) { m["images"][1]["file"] = "none.png"; }, "none.png is not there"},
      {[](Json& m) { m["mask"] = "none.png"; }, "'mask': the mask"},
      {[](Json& m) { m["images"][0]["weight"] = "none.png"; }, "'images[0].weight': the weight map"},
      {[](Json& m) { m["images"][1]["shadow"] = "none.png"; }, "'images[1].shadow': the shadow map"},
      {[](Json& m) { m["images"][1]["file"] = "./a.png"; }, "a.png is listed twice"},
      {[](Json& m) { m["images"][1]["file"] = std::string("b.png\0", 6); }, "b.png? is not there"},
      {[](Json& m) {
         m["images"][1]["direction"] = {0.6, 0, -0.8};
       },
       "below the surface plane"},
      {[](Json& m) {
         m["images"][0]["position"] = {0, 0, -1};
       },
       "below the surface plane"},
      {[](Json& m) {
         m["images"][0]["position"] = {0, 0, 1e-170};
       },
       "a position above it"},
      {[](Json& m) {
         m["images"][1]["direction"] = {30, 20, 400};
       },
       "has length"},
      {[](Json& m) {
         m["images"][1]["direction"] = {0, 0, 0};
       },
       "has length 0"},
      {[](Json& m) { m["images"][1].erase("exposure_seconds"); }, "b.png has no exposure_seconds"},
      {[](Json& m) { m.erase("pixel_size"); }, "'pixel_size' is missing"},
      {[](Json& m) { m["transfer"] = "gamma 9"; }, "linear, srgb, rec709 or gamma"},
      {[](Json& m) {
         m.erase("color_matrix");
         m["chart"] = chart_of([](const Rgb& patch) { return Rgb{patch[0], patch[0], patch[0]}; });
       },
       "do not span three colours"},
      {[](Json& m) { m["imgaes"] = 1; }, "'imgaes' is unknown"},
  };
  for (const auto& [change, part] : mistakes) EXPECT_THAT(error_of(with(change)), HasSubstr(part));
  write_text(folder_ / "olat.json", R"({"version": 1, "images": [})");
  EXPECT_THAT(input_error_of([&] { read_stack_source(folder_ / "olat.json"); }),
              HasSubstr("no JSON: line 1"));
  EXPECT_THAT(input_error_of([&] { read_stack_source(folder_ / "none.json"); }), HasSubstr("no such file"));
}

TEST_F(StackSourceTest, LightFilesAreReadAsTheyAreFound) {
  // Windows paths and line ends, a byte order mark, names with spaces, lengths that are not 1, blank lines.
  write_text(folder_ / "lights.lp",
             "\xEF\xBB\xBF 3\r\nC:\\capture\\b.png 3 0 4\r\nwith space.png 0 0 1e0\r\n\r\na.png\t0 +0.6 "
             "0.8\r\n\r\n");
  const StackSource source = read_stack_source(folder_ / "lights.lp");
  ASSERT_EQ(source.pictures.size(), 3U);
  EXPECT_EQ(source.pictures[0].light.direction.y, 0.6);
  EXPECT_EQ(source.pictures[1].file, folder_ / "b.png");
  EXPECT_DOUBLE_EQ(source.pictures[1].light.direction.x, 0.6);
  EXPECT_EQ(source.pictures[2].file, folder_ / "with space.png");
  EXPECT_FALSE(source.transfer);
}

TEST_F(StackSourceTest, EveryMistakeInALightFileIsNamed) {
  const std::map<std::string, std::string> mistakes = {
      {"", "it is empty"},
      {"a.png 0 0 1\n", "the first line is 'a.png 0 0 1'"},
      {"-1\n", "the number of pictures"},
      {"3\na.png 0 0 1\nb.png 0 0 1\n", "says 3 pictures, and 2 follow"},
      {"1\na.png 0 0 1\nb.png 0 0 1\n", "says 1 pictures, and 2 follow"},
      {"1\na.png 0 1\n", "line 2 is 'a.png 0 1'"},
      {"1\n0 0 1\n", "line 2"},
      {"1\na.png 0 0 one\n", "line 2"},
      {"1\na.png 0 0 nan\n", "line 2 is (0, 0, nan)"},
      {"1\na.png 0 0 0\n", "a direction towards the light"},
      {"1\na.png 0.6 0 -0.8\n", "below the surface plane"},
      {"1\nnone.png 0 0 1\n", "none.png is not there"},
      {"2\na.png 0 0 1\na.png 0.6 0 0.8\n", "a.png is listed twice"},
  };
  for (const auto& [text, part] : mistakes) {
    const std::string error = error_of_lights(text);
    EXPECT_THAT(error, HasSubstr(part)) << text;
    EXPECT_THAT(error, HasSubstr("lights.lp")) << text;
  }
}

}  // namespace
}  // namespace brdfit::io
