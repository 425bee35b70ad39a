// The drawing commands from outside: what they write, what they refuse, and what they say about bad cells.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "brdf/models.h"
#include "io/image_file.h"
#include "io/material_json.h"
#include "io/merl.h"
#include "render/report/html.h"
#include "render/slice.h"
#include "render/sphere.h"
#include "render/view.h"
#include "tests/cli_fixture.h"

namespace brdfit {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using tests::ProgramResult;

class CliPictures : public tests::CliFixture {
 protected:
  Material write_material(const std::string& name, Model model, std::uint64_t seed) {
    const Material material = synthetic::random_material(model, Tier::kFull, effects_of(model), {}, seed);
    std::filesystem::create_directories(path(name).parent_path());
    io::write_material(path(name), material);
    return material;
  }

  OIIO::ImageBuf image(const std::string& name) const {
    OIIO::ImageBuf result(path(name).string());
    EXPECT_TRUE(result.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << name << result.geterror();
    return result;
  }

  // Overwrites one stored value of a table.
  void plant(const std::string& name, std::size_t value_index, double value) {
    std::fstream file(path(name), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(12 + 8 * value_index));
    file.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
};

TEST_F(CliPictures, SliceOfAMaterialHoldsItsValues) {
  const Material material = write_material("m.json", Model::kCallisto, 3);
  const ProgramResult result =
      run("slice " + quoted("m.json") + " --size 64 --phi-d 60 --json -o " + quoted("s.exr"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto printed = json::parse(result.out);
  EXPECT_EQ(printed["width"], 64);
  const OIIO::ImageBuf exr = image("s.exr");
  ASSERT_EQ(exr.nchannels(), 4);
  EXPECT_EQ(exr.spec().channelnames[3], "A");
  render::SliceOptions options;
  options.size = 64;
  options.phi_d_deg = 60.0;
  std::size_t with_value = 0;
  for (int y = 0; y < 64; y += 3) {
    for (int x = 0; x < 64; x += 3) {
      const auto [wi, wo] = directions_from_half_diff(render::slice_angles(options, x, y));
      const bool above = wi.z > 0.0 && wo.z > 0.0;
      EXPECT_EQ(exr.getchannel(x, y, 0, 3), above ? 1.0F : 0.0F);
      if (!above) continue;
      ++with_value;
      const Rgb f = eval(material, wi, wo);
      for (int c = 0; c < 3; ++c) {
        const double expected = f[static_cast<std::size_t>(c)];
        EXPECT_NEAR(static_cast<double>(exr.getchannel(x, y, 0, c)), expected, 1e-6 * expected);
      }
    }
  }
  EXPECT_GT(with_value, 200U);
}

TEST_F(CliPictures, ExrSaysWhatItHoldsAndPngHowItIsShown) {
  make_table("soft", Model::kLambertGgx, 1);
  ASSERT_EQ(run("slice " + quoted("soft.binary") + " --size 64 -o " + quoted("s.exr")).exit_code, 0);
  EXPECT_EQ(image("s.exr").spec().get_string_attribute("brdfit:units"), "sr^-1");
  EXPECT_THAT(std::string(image("s.exr").spec().get_string_attribute("ImageDescription")),
              HasSubstr("BRDF slice at phi_d = 90 deg"));
  ASSERT_EQ(run("sphere " + quoted("soft.binary") + " --light 120 --size 64 --exposure 1.5 --view gt -o " +
                quoted("s.png"))
                .exit_code,
            0);
  const OIIO::ImageBuf png = image("s.png");
  EXPECT_GE(png.spec().width, 64);
  EXPECT_EQ(png.spec().get_string_attribute("brdfit:exposure_stops"), "1.5");
  EXPECT_EQ(png.spec().get_string_attribute("brdfit:view"), "gt");
}

TEST_F(CliPictures, PlainPicturesHaveTheSizeAskedFor) {
  make_table("soft", Model::kLambertGgx, 1);
  int count = 0;
  for (const char* command : {"slice", "sphere", "sphere --shape patch --light 90",
                              "sphere --environment uniform", "sphere --environment gradient"}) {
    // OpenImageIO remembers files by name.
    std::string name = std::to_string(count++);
    name += ".png";
    const ProgramResult result = run(std::string(command) + " " + quoted("soft.binary") +
                                     " --plain --size 48 --force -q -o " + quoted(name));
    ASSERT_EQ(result.exit_code, 0) << command << result.err;
    EXPECT_EQ(image(name).spec().width, 48) << command;
    EXPECT_EQ(image(name).spec().height, 48) << command;
  }
}

TEST_F(CliPictures, DifferenceToItselfIsZero) {
  make_table("soft", Model::kBurley, 1);
  for (const char* kind : {"signed", "absolute", "log-ratio"}) {
    ASSERT_EQ(run("slice " + quoted("soft.binary") + " --minus " + quoted("soft.binary") + " --difference " +
                  kind + " --size 32 --force -o " + quoted(std::string(kind) + ".exr"))
                  .exit_code,
              0);
    const OIIO::ImageBuf d = image(std::string(kind) + ".exr");
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) EXPECT_EQ(d.getchannel(x, y, 0, 0), 0.0F);
    }
  }
}

TEST_F(CliPictures, ADifferenceForEyesHasRoomForItsTitleAndBar) {
  make_table("soft", Model::kBurley, 1);
  write_material("m.json", Model::kCallisto, 2);
  const std::string slice =
      "slice " + quoted("soft.binary") + " --minus " + quoted("m.json") + " --size 64 -o ";
  ASSERT_EQ(run(slice + quoted("plain.png") + " --plain").exit_code, 0);
  EXPECT_EQ(image("plain.png").spec().width, 64);
  const ProgramResult drawn = run(slice + quoted("figure.png"));
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const OIIO::ImageBuf figure = image("figure.png");
  ASSERT_GT(figure.spec().width, 64 + 64 / 4);
  ASSERT_GT(figure.spec().height, 64 + 40);
  float darkest_in_title = 1.0F;
  for (int x = 0; x < figure.spec().width; ++x) {
    for (int y = 0; y < 40; ++y) darkest_in_title = std::min(darkest_in_title, figure.getchannel(x, y, 0, 0));
  }
  EXPECT_LT(darkest_in_title, 0.3F);
}

TEST_F(CliPictures, BadValuesAreRefusedOrCountedAndNamed) {
  make_table("soft", Model::kLambertGgx, 1);
  const std::size_t cells = 30 * 30 * 36;
  const std::size_t row = 36;  // of phi_d
  for (std::size_t k = 0; k < 5; ++k) plant("soft.binary", (10 * 30 + 3 + k) * row + 18, std::nan(""));
  plant("soft.binary", (12 * 30 + 3) * row + 18, std::numeric_limits<double>::infinity());
  plant("soft.binary", cells + (14 * 30 + 3) * row + 18, -0.5);
  const std::string slice = "slice " + quoted("soft.binary") + " --size 60 -o " + quoted("s.png");
  EXPECT_EQ(run(slice).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(path("s.png")));
  const ProgramResult lenient = run(slice + " --lenient --json");
  ASSERT_EQ(lenient.exit_code, 0) << lenient.err;
  EXPECT_THAT(lenient.err, HasSubstr("6 cells hold NaN or infinity"));
  EXPECT_THAT(lenient.err, HasSubstr("1 cells are negative in some channels only"));
  const auto pixels = json::parse(lenient.out)["pixels"];
  EXPECT_GT(pixels["not_finite"].get<int>(), 0);
  EXPECT_GT(pixels["negative"].get<int>(), 0);
}

TEST_F(CliPictures, CompareWritesEveryPictureOrThoseAskedFor) {
  make_table("soft", Model::kCallisto, 1);
  write_material("a.json", Model::kLambertGgx, 1);
  write_material("b.json", Model::kCallisto, 2);
  const std::string compare = "compare " + quoted("soft.binary") + " " + quoted("a.json") + " " +
                              quoted("b.json") + " --size 64 --sphere-size 32 -q -o " + quoted("out");
  ASSERT_EQ(run(compare).exit_code, 0);
  for (const char* file : {"soft.slices.png", "soft.spheres.png", "soft.patches.png", "soft.environments.png",
                           "soft.lobes.svg", "soft.polar.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(path("out") / file)) << file;
  }
  EXPECT_EQ(files_in("out"), 6U);
  EXPECT_EQ(run(compare).exit_code, 2) << "files exist";
  const ProgramResult one = run("compare " + quoted("soft.binary") + " " + quoted("a.json") +
                                " --pictures slices --size 64 --json -o " + quoted("one"));
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(files_in("one"), 1U);
  EXPECT_TRUE(std::filesystem::exists(json::parse(one.out)["pictures"]["slices"].get<std::string>()));
}

TEST_F(CliPictures, ReportFindsTheTableThatWasFitted) {
  make_table("soft", Model::kLambertGgx, 1);
  ASSERT_EQ(run("fit " + quoted("soft.binary") + " --samples 500 -q -o " + quoted("fits")).exit_code, 0);
  const std::string report = "report " + quoted("fits") + " --size 64 --force --json -q";
  const ProgramResult found = run(report);
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(json::parse(found.out)["materials"], 1);
  EXPECT_TRUE(json::parse(found.out)["warnings"].empty()) << found.out;
  const std::string html = tests::read_text(path("fits/report.html"));
  for (const char* text :
       {"Lambert + GGX", "Burley", "Callisto", "data:image/png;base64,", "<svg", "soft.binary"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
  // Another table of the same name is not taken for it.
  make_table("soft", Model::kBurley, 2);
  EXPECT_THAT(json::parse(run(report).out)["warnings"].dump(), HasSubstr("soft.binary"));
}

// A slice as the report shows it, as the data URI has it.
std::string shown_slice(const render::Subject& subject, const Grid& grid) {
  render::SliceOptions options;
  options.size = 128;
  options.grid = grid;
  const render::Picture picture = render::to_picture(render::draw_slice(subject, options), {});
  return "base64," + render::base64(io::encode_png({picture.width, picture.height, 3, picture.rgb}));
}

TEST_F(CliPictures, ReportShowsTheMaterialOfEveryRungAsTheFileHoldsIt) {
  make_table("full", Model::kCallisto, 4);
  ASSERT_EQ(run("fit " + quoted("full.binary") + " --samples 500 --model callisto --loss auto -q -o " +
                quoted("fits"))
                .exit_code,
            0);
  const std::string report = "report " + quoted("fits") + " --size 64 --force --json -q";
  ASSERT_EQ(run(report).exit_code, 0);
  std::string html = tests::read_text(path("fits/report.html"));
  const Material material = io::read_material(path("fits/full.callisto.json"));
  io::Json file = io::read_json(path("fits/full.callisto.json"));
  std::vector<io::Json> rungs = {file["fit"]["ladder_start"]};
  for (const io::Json& step : file["fit"]["ladder"]) rungs.push_back(step["material"]);
  ASSERT_GT(rungs.size(), 1U);
  const MeasuredTable table = io::read_merl(path("full.binary"));
  for (const io::Json& rung : rungs) {
    const Material of_rung = io::material_from_effects_and_values(material, rung, "m.json");
    EXPECT_THAT(html, HasSubstr(shown_slice(of_rung, table.grid())));
  }
  EXPECT_THAT(html, HasSubstr(shown_slice(table, table.grid())));
  for (const char* text : {"class=\"sure", "class=\"losses\"", " was kept", "ns per evaluation"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
  // A file without them, or with one that is not sound, is shown without.
  file["fit"].erase("ladder_start");
  for (io::Json& step : file["fit"]["ladder"]) step["material"]["parameters"]["roughness"] = -1;
  io::write_json(path("fits/full.callisto.json"), file);
  ASSERT_EQ(run(report).exit_code, 0);
  html = tests::read_text(path("fits/report.html"));
  EXPECT_THAT(html, HasSubstr("their slices are not drawn"));
  EXPECT_THAT(html, HasSubstr("ns per evaluation"));
}

TEST_F(CliPictures, ReportGoesOnWhenAFileIsBadAndExitsWith4) {
  write_material("fits/good.callisto.json", Model::kCallisto, 1);
  write_bytes("fits/bad.callisto.json",
              R"({"brdfit": 1, "model": "callisto", "parameters": {"roughness": 7}})");
  write_bytes("fits/other.json", R"({"something": "else"})");
  const ProgramResult result = run("report " + quoted("fits") + " --size 64 --json -q");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(json::parse(result.out)["warnings"].dump(), HasSubstr("bad.callisto.json"));
  EXPECT_THAT(json::parse(result.out)["warnings"].dump(), testing::Not(HasSubstr("other.json")));
  std::filesystem::create_directories(path("empty"));
  EXPECT_EQ(run("report " + quoted("empty")).exit_code, 3);
}

TEST_F(CliPictures, WrongUsageIsRefusedBeforeAnythingIsRead) {
  make_table("soft", Model::kLambertGgx, 1);
  for (const std::string& arguments :
       {"slice " + quoted("soft.binary") + " -o " + quoted("s.gif"),
        "slice " + quoted("soft.binary") + " --size 1", "slice " + quoted("soft.binary") + " --view film",
        "sphere " + quoted("soft.binary") + " --light 180",
        "sphere " + quoted("soft.binary") + " --shape patch --environment uniform",
        "compare " + quoted("soft.binary"), "slice " + quoted("soft.binary") + " --phi-d nan",
        "report " + quoted("nowhere")}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments << result.err;
  }
}

}  // namespace
}  // namespace brdfit
