// Pictures of a bake: panels of lights that were held out, and the map of where the correction helps.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/panel_lights.h"
#include "data/synthetic/stack.h"
#include "io/image_reader.h"
#include "io/realis_json.h"
#include "render/image.h"
#include "render/view.h"
#include "tests/cli_stack_fixture.h"
#include "tests/json_schema.h"
#include "tests/picture_tools.h"

namespace brdfit::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kLights = 30;

class CliBakePictures : public tests::CliStackFixture {
 protected:
  static synthetic::StackRecipe recipe() {
    synthetic::StackRecipe recipe = matte_bumps(24, 16, kLights);
    recipe.materials[0].set("base_color", Rgb{0.6, 0.4, 0.2});
    recipe.shape.wavelength_px = 12;
    recipe.residual.strength = 0.3;
    return recipe;
  }

  tests::ProgramResult bake(const std::string& folder, const std::string& options) {
    return run("bake -q --lobes 6 --uniform --base lambert --folds 4 -o " + quoted(folder) + " " + options +
               " " + quoted("stack/bumps.olat.json"));
  }

  // What the asset says of its pictures.
  io::Json pictures(const std::string& folder) const {
    return io::read_json(path(folder + "/bumps.realis.json"))["bake"]["pictures"];
  }

  render::Picture picture(const std::string& name) const {
    io::ImageReader reader(path(name));
    render::Picture picture(reader.header().width, reader.header().height);
    EXPECT_EQ(reader.header().channels, 3);
    reader.read_native(0, picture.height, std::as_writable_bytes(std::span(picture.rgb)));
    return picture;
  }

  // A tile of a panel, by the place that the asset gives it.
  render::Picture tile(const std::string& folder, const io::Json& all, const io::Json& panel,
                       const std::string& name) const {
    const render::Picture whole = picture(folder + "/" + panel["file"].get<std::string>());
    for (const io::Json& found : panel["tiles"]) {
      if (found["name"] != name) continue;
      const int x = found["x"];
      const int y = found["y"];
      return tests::cut(whole, {{x, y}, {x + all["tile"][0].get<int>(), y + all["tile"][1].get<int>()}});
    }
    ADD_FAILURE() << "no tile " << name;
    return render::Picture(1, 1);
  }

  // Gives every pixel of a light's picture to another texel: the same exposure, nothing else in common.
  void shuffle_picture(std::size_t light) {
    synthetic::SyntheticStack truth(recipe());
    const TexelBlock block = truth.read_rows(0, truth.info().height);
    std::vector<std::size_t> order(block.count());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(5));
    std::vector<float> samples;
    for (const std::size_t k : order) {
      for (std::size_t c = 0; c < 3; ++c) samples.push_back(block.plane(light, c)[k]);
    }
    io::write_image(path("stack") / truth.info().lights[light].name,
                    {truth.info().width, truth.info().height, 3, io::SampleType::kFloat,
                     std::as_bytes(std::span<const float>(samples))},
                    {io::SampleType::kFloat, 95, {}});
  }
};

TEST_F(CliBakePictures, ShowTheWorstTheMedianAndTheBestLight) {
  synth(recipe());
  ASSERT_EQ(bake("baked", "").exit_code, 0);
  const io::Json json = io::read_json(path("baked/bumps.realis.json"));
  const std::vector<double> errors =
      json["bake"]["evidence"]["realis"]["held_out_per_light_255"].get<std::vector<double>>();
  std::vector<std::string> words;
  for (const io::Json& panel : json["bake"]["pictures"]["panels"]) {
    const double error = errors[panel["place"].get<std::size_t>()];
    for (const std::string word : panel["chosen_as"]) {
      words.push_back(word);
      const auto below =
          std::count_if(errors.begin(), errors.end(), [&](double other) { return other < error; });
      EXPECT_EQ(below, word == "worst" ? kLights - 1 : word == "best" ? 0 : kLights / 2) << word;
    }
    EXPECT_TRUE(std::filesystem::exists(path("baked/" + panel["file"].get<std::string>())));
    EXPECT_EQ(panel["tiles"].size(), 5U) << "other sizes are for those who ask";
  }
  EXPECT_THAT(words, testing::UnorderedElementsAre("worst", "median", "best"));
  EXPECT_EQ(files_in("baked/bumps.panels"), 3U);
}

TEST_F(CliBakePictures, ShowTheCaptureAsItIsAndThePredictionBesideIt) {
  synth(recipe());
  ASSERT_EQ(bake("baked", "--no-evidence --panels 7").exit_code, 0);
  const io::Json all = pictures("baked");
  ASSERT_EQ(all["panels"].size(), 1U);
  const io::Json& panel = all["panels"][0];
  EXPECT_EQ(panel["file"], "bumps.panels/bumps.0007.png");
  const int scale = all["tile"][0].get<int>() / 24;
  EXPECT_EQ(all["tile"], io::Json({24 * scale, 16 * scale}));
  synthetic::SyntheticStack truth(recipe());
  const TexelBlock block = truth.read_rows(0, 16);
  render::Image image(24, 16);
  std::fill(image.state.begin(), image.state.end(), render::PixelState::kValue);
  for (std::size_t k = 0; k < block.count(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * k + c] = block.plane(7, c)[k];
  }
  render::ViewOptions view;
  view.exposure_stops = panel["exposure_stops"];
  const render::Picture expected = render::to_picture(image, view);
  const render::Picture capture = tile("baked", all, panel, "capture");
  const render::Picture realis = tile("baked", all, panel, "realis");
  double largest = 0.0;
  double squares = 0.0;
  for (int y = 0; y < 16 * scale; ++y) {
    for (int x = 0; x < 24 * scale; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double truth_here = tests::pixel_at(expected, x / scale, y / scale)[c];
        largest = std::max(largest, std::abs(tests::pixel_at(capture, x, y)[c] - truth_here));
        squares += std::pow(tests::pixel_at(realis, x, y)[c] - truth_here, 2);
      }
    }
  }
  EXPECT_LE(largest, 1.0);
  // Upright and alike, though not the same: turned either way it is off by more than 30.
  const double rmse = std::sqrt(squares / (3.0 * 24 * 16 * scale * scale));
  EXPECT_GT(rmse, 0.5);
  EXPECT_LT(rmse, 15.0);
}

TEST_F(CliBakePictures, ReportTheErrorsOfTheEvidence) {
  synth(recipe());
  ASSERT_EQ(bake("baked", "--panels all").exit_code, 0);
  const io::Json bake = io::read_json(path("baked/bumps.realis.json"))["bake"];
  ASSERT_EQ(bake["pictures"]["panels"].size(), std::size_t{kLights});
  std::size_t compared = 0;
  for (const io::Json& panel : bake["pictures"]["panels"]) {
    const auto place = panel["place"].get<std::size_t>();
    for (const io::Json& shown : panel["tiles"]) {
      const std::string name = shown["name"] == "model" ? "lambert" : shown["name"].get<std::string>();
      if (!bake["evidence"].contains(name)) continue;
      ++compared;
      const double expected = bake["evidence"][name]["held_out_per_light_255"][place];
      EXPECT_NEAR(shown["rmse_255"].get<double>(), expected, 1e-4 * expected) << name << " " << place;
    }
  }
  // Lambert, Realis, with 8 and 4 bits, three of six lobes, and that with 8 bits; 4 lobes where they help.
  EXPECT_GE(compared, 6U * kLights);
  // The map sees the same errors.
  const io::Json& benefit = bake["pictures"]["benefit"];
  const double with = bake["evidence"]["realis"]["held_out_rmse_255"];
  const double without = bake["evidence"]["lambert"]["held_out_rmse_255"];
  EXPECT_NEAR(benefit["rmse_255_with"].get<double>(), with, 1e-4 * with);
  EXPECT_NEAR(benefit["rmse_255_without"].get<double>(), without, 1e-4 * without);
  EXPECT_EQ(benefit["lights"], kLights);
  const double shares = benefit["helps"].get<double>() + benefit["same"].get<double>() +
                        benefit["harms"].get<double>() + benefit["not_corrected"].get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_GT(benefit["helps"].get<double>(), 0.5);
  EXPECT_TRUE(std::filesystem::exists(path("baked/bumps.benefit.png")));
}

TEST_F(CliBakePictures, ReportTheErrorsOfTheEvidenceOfColourToo) {
  synth(recipe());
  for (const std::string colour : {"scaled-chroma", "rgb"}) {
    ASSERT_EQ(bake(colour, "--panels 4 --colour " + colour).exit_code, 0);
    const io::Json bake = io::read_json(path(colour + "/bumps.realis.json"))["bake"];
    std::size_t compared = 0;
    for (const io::Json& shown : bake["pictures"]["panels"][0]["tiles"]) {
      const std::string name = shown["name"];
      if (!bake["evidence"].contains(name)) continue;
      ++compared;
      const double expected = bake["evidence"][name]["held_out_per_light_255"][4];
      EXPECT_NEAR(shown["rmse_255"].get<double>(), expected, 1e-4 * expected) << colour << " " << name;
    }
    EXPECT_GE(compared, 5U);
  }
}

TEST_F(CliBakePictures, NothingLooksAtTheLightThatIsHeldOut) {
  synth(recipe());
  const std::vector<std::string> kinds = {"", "--no-evidence --colour rgb ",
                                          "--no-evidence --colour scaled-chroma --gains "};
  const auto folder = [](const char* when, std::size_t k) { return when + std::to_string(k); };
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const tests::ProgramResult baked = bake(folder("before", k), kinds[k] + "--panels bumps.0009");
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
  }
  shuffle_picture(9);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const std::string before = folder("before", k);
    const std::string after = folder("after", k);
    ASSERT_EQ(bake(after, kinds[k] + "--panels bumps.0009").exit_code, 0);
    const io::Json was = pictures(before);
    const io::Json is = pictures(after);
    const auto changes = [&](const std::string& name) {
      return tile(before, was, was["panels"][0], name).rgb != tile(after, is, is["panels"][0], name).rgb;
    };
    EXPECT_TRUE(changes("capture"));
    EXPECT_TRUE(changes("realis-error"));
    EXPECT_FALSE(changes("model")) << kinds[k];
    EXPECT_FALSE(changes("realis")) << kinds[k];
  }
  // A light of another fold is looked at.
  synth(recipe());
  shuffle_picture(8);
  ASSERT_EQ(bake("other", kinds[1] + "--panels bumps.0009").exit_code, 0);
  const io::Json was = pictures("before1");
  const io::Json is = pictures("other");
  for (const std::string name : {"model", "realis"}) {
    EXPECT_NE(tile("before1", was, was["panels"][0], name).rgb, tile("other", is, is["panels"][0], name).rgb)
        << name;
  }
}

TEST_F(CliBakePictures, AreTheSameForAnyStripsPassesAndThreads) {
  synthetic::StackRecipe large = recipe();
  large.width = 520;  // every second texel is drawn
  large.height = 200;
  large.lights.count = 6;
  synth(large);
  const std::string all = "--no-evidence --sample 300 --panels all ";
  ASSERT_EQ(bake("one", all + "--threads 1 --memory 16").exit_code, 0);
  ASSERT_EQ(bake("two", all + "--threads 2 --memory 1024").exit_code, 0);
  const io::Json json = pictures("one");
  EXPECT_EQ(json, pictures("two"));
  EXPECT_EQ(json["step"], 2);
  EXPECT_EQ(json["tile"], io::Json({260, 100}));
  ASSERT_EQ(json["panels"].size(), 6U);
  for (const io::Json& panel : json["panels"]) {
    const std::string file = "/" + panel["file"].get<std::string>();
    EXPECT_EQ(picture("one" + file).rgb, picture("two" + file).rgb) << file;
  }
  EXPECT_EQ(picture("one/bumps.benefit.png").rgb, picture("two/bumps.benefit.png").rgb);
}

TEST_F(CliBakePictures, AreDrawnWhereThereIsNothingToCorrectAndLeftOutWhereNotWanted) {
  synthetic::StackRecipe plain = recipe();
  plain.lights.count = 2;  // one tells nothing of what lobes would do under the other
  synth(plain);
  ASSERT_EQ(bake("baked", "--no-evidence --panels 0").exit_code, 0);
  const io::Json json = pictures("baked");
  EXPECT_EQ(json["benefit"]["not_corrected"], 1.0);
  EXPECT_EQ(tile("baked", json, json["panels"][0], "model").rgb,
            tile("baked", json, json["panels"][0], "realis").rgb);
  for (const std::string none : {"--no-panels", "--no-evidence"}) {
    ASSERT_EQ(bake("none" + none, none).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(path("none" + none + "/bumps.panels")));
    EXPECT_FALSE(std::filesystem::exists(path("none" + none + "/bumps.benefit.png")));
  }
}

TEST_F(CliBakePictures, FitTheSchema) {
  synth(recipe());
  ASSERT_EQ(bake("baked", "--panels 3 --panels worst").exit_code, 0);
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/realis.schema.json"));
  io::Json json = io::read_json(path("baked/bumps.realis.json"));
  EXPECT_EQ(schema.complaint(json), "");
  json["bake"]["pictures"]["panels"][0]["extra"] = 1;
  EXPECT_NE(schema.complaint(json), "");
}

TEST_F(CliBakePictures, RefuseUnknownLightsAndPicturesThatAreThere) {
  synth(recipe());
  const tests::ProgramResult unknown = bake("baked", "--panels bumps.0030");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("bumps.0030"));
  EXPECT_EQ(bake("baked", "--panels worst --no-evidence").exit_code, 2);
  EXPECT_EQ(bake("baked", "--panels 0 --no-panels").exit_code, 2);
  EXPECT_EQ(files_in("baked"), 0U);
  std::filesystem::create_directories(path("baked/bumps.panels"));
  write_bytes("baked/bumps.panels/bumps.0003.png", "mine");
  const tests::ProgramResult there = bake("baked", "--panels 3 --no-evidence");
  EXPECT_EQ(there.exit_code, 2);
  EXPECT_THAT(there.err, HasSubstr("bumps.0003.png"));
  EXPECT_EQ(tests::read_text(path("baked/bumps.panels/bumps.0003.png")), "mine");
  EXPECT_FALSE(std::filesystem::exists(path("baked/bumps.realis.json")));
}

std::vector<std::uint32_t> lights_of(const std::vector<std::string>& asked,
                                     const std::vector<std::string>& names,
                                     const std::vector<double>& errors = {}) {
  std::vector<std::uint32_t> lights;
  for (const PanelLight& panel : panel_lights(asked, names, errors)) lights.push_back(panel.light);
  return lights;
}

TEST(PanelLights, AreFoundByNameByPlaceAndByError) {
  const std::vector<std::string> names = {"1.jpg", "3.jpg", "a.jpg", "b.png"};
  EXPECT_THAT(lights_of({"a", "b.png"}, names), ElementsAre(2, 3));
  // A name before a place.
  EXPECT_THAT(lights_of({"1"}, names), ElementsAre(0));
  EXPECT_THAT(lights_of({"2", "2", "0"}, names), ElementsAre(0, 2));
  EXPECT_THAT(lights_of({"all"}, names), ElementsAre(0, 1, 2, 3));
  const std::vector<double> errors = {3.0, 9.0, 1.0, 5.0};
  EXPECT_THAT(lights_of({"worst"}, names, errors), ElementsAre(1));
  EXPECT_THAT(lights_of({"best", "median"}, names, errors), ElementsAre(2, 3));
  const std::vector<std::string> asked = {"worst", "best", "worst"};
  const std::vector<PanelLight> one =
      panel_lights(asked, std::span(names).first(1), std::span(errors).first(1));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_THAT(one[0].words, ElementsAre("worst", "best"));
}

TEST(PanelLights, WithNamesThatEndDifferentlyHavePanelsOfTheirOwn) {
  const std::vector<std::string> names = {"a.jpg", "a.png"};
  EXPECT_THROW(lights_of({"a"}, names), UsageError);
  EXPECT_THAT(lights_of({"a.png"}, names), ElementsAre(1));
  const std::vector<std::string> all = {"all"};
  const std::vector<PanelLight> panels = panel_lights(all, names, {});
  EXPECT_NE(panels[0].file, panels[1].file);
}

}  // namespace
}  // namespace brdfit::cli
