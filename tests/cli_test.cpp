// The program from outside: exit codes, one-line errors, nothing left behind, and the round trip of a fit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli_fixture.h"

namespace brdfit {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;
using tests::ProgramResult;

using Cli = tests::CliFixture;

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST_F(Cli, HelpGoesToStandardOutputWithAnExampleAndTheDefaultsOfTheCode) {
  for (const char* command : {"fit", "table", "info", "slice", "sphere", "compare", "report", "bake",
                              "relight", "synth", "export", "verify", "demo"}) {
    const ProgramResult help = run(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("Example: brdfit ")) << command;
    EXPECT_EQ(help.err, "") << command;
    const ProgramResult version = run(std::string(command) + " --version");
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, StartsWith("brdfit "));
  }
  EXPECT_THAT(run("fit --help").out, HasSubstr("=log-ratio"));
}

TEST_F(Cli, WrongUsageExitsWith2AndOneLineOnStandardError) {
  make_table("soft", Model::kLambertGgx, 1);
  for (const std::string& arguments :
       {std::string(), std::string("fly"), std::string("fit"), "fit --model phong " + quoted("soft.binary"),
        "fit --samples none " + quoted("soft.binary"), "fit --held-out=1 " + quoted("soft.binary"),
        "fit --fix roughness " + quoted("soft.binary"), "fit --fix shine=1 " + quoted("soft.binary"),
        "fit --fix roughness=7 " + quoted("soft.binary"),
        "fit --model burley --effects dual_specular " + quoted("soft.binary"),
        "fit --max-theta 100 " + quoted("soft.binary"),
        "fit --on slices --phi-d 200 " + quoted("soft.binary")}) {
    const ProgramResult result =
        run(arguments + (arguments.starts_with("fit -") ? " -o " + quoted("out") : ""));
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(lines_of(result.err), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr("--help")) << arguments;
  }
  EXPECT_EQ(files_in("out"), 0U);
}

TEST_F(Cli, ADamagedFileExitsWith3AndOneLineAndLeavesNoOutput) {
  make_table("sound", Model::kLambertGgx, 1);
  const std::string sound = tests::read_text(path("sound.binary"));
  const auto with_value = [&](double value) {
    std::string bytes = sound;
    std::copy_n(reinterpret_cast<const char*>(&value), sizeof value, bytes.begin() + 12);
    return bytes;
  };
  const auto with_dimension = [&](std::int32_t dimension) {
    std::string bytes = sound;
    std::copy_n(reinterpret_cast<const char*>(&dimension), sizeof dimension, bytes.begin());
    return bytes;
  };
  std::string swapped = sound;
  for (std::size_t k = 0; k < 12; k += 4) std::reverse(swapped.begin() + k, swapped.begin() + k + 4);
  write_bytes("empty.binary", "");
  write_bytes("short-header.binary", sound.substr(0, 7));
  write_bytes("truncated.binary", sound.substr(0, sound.size() - 9));
  write_bytes("trailing.binary", sound + "x");
  write_bytes("zero.binary", with_dimension(0));
  write_bytes("negative.binary", with_dimension(-90));
  write_bytes("huge.binary", with_dimension(std::numeric_limits<std::int32_t>::max()));
  write_bytes("big-endian.binary", swapped);
  write_bytes("nan.binary", with_value(std::numeric_limits<double>::quiet_NaN()));
  write_bytes("infinite.binary", with_value(std::numeric_limits<double>::infinity()));
  std::filesystem::create_directory(path("folder.binary"));
  for (const char* name : {"empty", "short-header", "truncated", "trailing", "zero", "negative", "huge",
                           "big-endian", "nan", "infinite", "folder", "missing"}) {
    const std::string file = std::string(name) + ".binary";
    const ProgramResult result = run("fit " + quoted(file) + " -q -o " + quoted("out"));
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_EQ(result.out, "") << name;
    EXPECT_EQ(lines_of(result.err), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(file)) << name;
    EXPECT_THAT(result.err, HasSubstr("expected")) << name;
    EXPECT_EQ(files_in("out"), 0U) << name;
  }
}

TEST_F(Cli, OptionsThatTakeListsLeaveTheFileBehindThem) {
  make_table("soft", Model::kLambertGgx, 1);
  const ProgramResult result =
      run("fit -q -o " + quoted("out") + " --phi-d 45,90 --on slices --effects none --model " +
          "lambert-ggx,burley " + quoted("soft.binary"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(files_in("out"), 2U);
}

TEST_F(Cli, LenientTakesNonFiniteValuesAsUnmeasuredAndSaysHowMany) {
  make_table("sound", Model::kLambertGgx, 1);
  std::string bytes = tests::read_text(path("sound.binary"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::copy_n(reinterpret_cast<const char*>(&nan), sizeof nan, bytes.begin() + 12);
  write_bytes("nan.binary", bytes);
  const ProgramResult result =
      run("fit " + quoted("nan.binary") + " --model lambert-ggx --lenient -o " + quoted("out"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("1 values are not finite"));
}

TEST_F(Cli, RefusesToOverwriteBeforeItWorksAndObeysForce) {
  make_table("soft", Model::kLambertGgx, 1);
  const std::string fit = "fit " + quoted("soft.binary") + " --model lambert-ggx -o " + quoted("out");
  ASSERT_EQ(run(fit).exit_code, 0);
  const std::string before = tests::read_text(path("out/soft.lambert-ggx.json"));
  const ProgramResult again = run(fit);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  EXPECT_EQ(tests::read_text(path("out/soft.lambert-ggx.json")), before);
  EXPECT_EQ(run(fit + " --force").exit_code, 0);
}

TEST_F(Cli, AResultIsTheSameToTheByteButForItsTimings) {
  make_table("soft", Model::kCallisto, 3);
  const std::string fit = "fit " + quoted("soft.binary") + " --model callisto --samples 800 -q -o ";
  ASSERT_EQ(run(fit + quoted("one") + " --threads 1").exit_code, 0);
  ASSERT_EQ(run(fit + quoted("two") + " --threads 2").exit_code, 0);
  auto one = json::parse(tests::read_text(path("one/soft.callisto.json")));
  auto two = json::parse(tests::read_text(path("two/soft.callisto.json")));
  ASSERT_TRUE(one["fit"].contains("timings_seconds"));
  one["fit"].erase("timings_seconds");
  two["fit"].erase("timings_seconds");
  // The two command lines name different folders and threads.
  EXPECT_THAT(one["fit"]["command"].get<std::string>(), HasSubstr("--threads 1"));
  one["fit"].erase("command");
  two["fit"].erase("command");
  EXPECT_EQ(one.dump(), two.dump());
}

TEST_F(Cli, JsonOfFitHasTheNamesThatScriptsRelyOn) {
  make_table("soft", Model::kLambertGgx, 1);
  const ProgramResult result = run("fit " + quoted("soft.binary") + " --json -q -o " + quoted("out"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto printed = json::parse(result.out);
  for (const char* model : {"lambert-ggx", "burley", "callisto"}) {
    const auto& entry = printed.at("models").at(model);
    EXPECT_TRUE(std::filesystem::exists(entry.at("material").get<std::string>()));
    for (const char* place : {"slice", "table"}) {
      for (const char* measure :
           {"log_ratio_pct", "slice_pct", "relative", "cube_root", "srgb", "cosine_l2"}) {
        EXPECT_TRUE(entry.at(place).at(measure).is_number()) << model << place << measure;
      }
    }
    EXPECT_GE(entry.at("sphere_delta_e").get<double>(), 0.0);
    double by_light = 0.0;
    for (const char* light : {"0", "90", "120", "140"}) {
      by_light += entry.at("sphere_delta_e_by_light").at(light).get<double>();
    }
    EXPECT_GE(by_light, 4.0 * 0.9 * entry.at("sphere_delta_e").get<double>());
    EXPECT_TRUE(entry.at("sphere_pixels_skipped").is_number_unsigned());
    EXPECT_GT(entry.at("free_parameters").get<int>(), 0);
    EXPECT_GT(entry.at("timings_seconds").at("load").get<double>(), 0.0);
    EXPECT_GT(entry.at("timings_seconds").at("sphere").get<double>(), 0.0);
    EXPECT_GT(entry.at("timings_seconds").at("fit").get<double>(),
              entry.at("timings_seconds").at("sphere").get<double>());
  }
}

// The errors by which effects were chosen and those of blocks that nothing saw have different names.
TEST_F(Cli, HeldOutErrorsAndTheSizeOfTheSampleAreToldOnRequest) {
  make_table("soft", Model::kCallisto, 3);
  const std::string fit =
      "fit " + quoted("soft.binary") + " --model callisto --starts 2 --force -o " + quoted("out") + " ";
  const auto plain = json::parse(run(fit + "--json -q").out)["models"]["callisto"];
  EXPECT_FALSE(plain.contains("held_out"));
  EXPECT_TRUE(plain.contains("selection"));
  EXPECT_GE(plain.at("sample_size").at("trials").size(), 2U);
  // The option takes no file behind it.
  const auto held_out = json::parse(run("fit --held-out=2 -q --json --model callisto --starts 2 --force -o " +
                                        quoted("out") + " " + quoted("soft.binary"))
                                        .out)["models"]["callisto"];
  EXPECT_EQ(held_out.at("held_out").at("folds").size(), 2U);
  EXPECT_GT(held_out.at("held_out").at("table").at("log_ratio_pct").at("mean").get<double>(), 0.0);
  EXPECT_EQ(held_out.at("table"), plain.at("table"));
  const std::string text = run(fit + "--held-out --effects none -q").out;
  EXPECT_THAT(text, HasSubstr("held out (blocks of angles, 5 folds"));
  EXPECT_THAT(text, HasSubstr("the last doubling changes it by"));
}

TEST_F(Cli, ExportsShadersUnderTheirOwnNames) {
  make_table("soft", Model::kLambertGgx, 5);
  ASSERT_EQ(run("fit " + quoted("soft.binary") + " --model lambert-ggx --samples 500 -q -o " + quoted("out"))
                .exit_code,
            0);
  const std::string material = quoted("out/soft.lambert-ggx.json");
  ASSERT_EQ(run("export " + material + " --to glsl --prefix oak -o " + quoted("oak.glsl")).exit_code, 0);
  EXPECT_THAT(tests::read_text(folder_.path() / "oak.glsl"),
              HasSubstr("vec3 oak_eval_cos(vec3 wi, vec3 wo) {"));
  ASSERT_EQ(run("export " + material + " --to hlsl --parameters struct -o " + quoted("oak.hlsl")).exit_code,
            0);
  EXPECT_THAT(tests::read_text(folder_.path() / "oak.hlsl"),
              HasSubstr("float3 brdf_eval_cos(brdf_Material m, float3 wi, float3 wo) {"));
  EXPECT_EQ(run("export " + material + " --to glsl -o " + quoted("oak.glsl")).exit_code, 2);
  EXPECT_EQ(run("export " + material + " --to glsl --prefix 2x -o " + quoted("x.glsl")).exit_code, 2);
}

TEST_F(Cli, AnExportedFitHasTheErrorsThatTheFitPrinted) {
  // A table that no model fits exactly: Callisto's, fitted by all three.
  make_table("soft", Model::kCallisto, 5);
  const ProgramResult fit =
      run("fit " + quoted("soft.binary") + " --samples 2000 --json -q -o " + quoted("out"));
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const auto fitted = json::parse(fit.out)["models"];
  for (const char* model : {"lambert-ggx", "burley", "callisto"}) {
    const std::string material = "out/soft." + std::string(model) + ".json";
    ASSERT_EQ(
        run("export " + quoted(material) + " --to merl --grid 30,30,36 --force -o " + quoted("again.binary"))
            .exit_code,
        0);
    const ProgramResult table = run("table " + quoted("soft.binary") + " --json -q --against " +
                                    quoted("again.binary") + " " + quoted(material));
    ASSERT_EQ(table.exit_code, 0) << table.err;
    const auto compared = json::parse(table.out);
    for (const auto& row : compared["rows"]) {
      const double expected_delta_e = fitted[model]["sphere_delta_e"].get<double>();
      if (row["candidate"].get<std::string>().ends_with(".json")) {
        EXPECT_NEAR(row["sphere_delta_e"].get<double>(), expected_delta_e, 1e-4 * expected_delta_e) << model;
      } else {
        // Interpolated between cells now, as the reference is.
        EXPECT_GT(row["sphere_delta_e"].get<double>(), 0.0) << model;
      }
      for (const char* place : {"slice", "table"}) {
        for (const auto& [measure, value] : fitted[model][place].items()) {
          const double expected = value.get<double>();
          // Float storage of a table: 6e-8 of each value.
          EXPECT_NEAR(row[place][measure].get<double>(), expected, 1e-4 + 1e-5 * expected)
              << model << " " << place << " " << measure;
        }
      }
    }
  }
}

TEST_F(Cli, TableDoesTheRestWhenOneFileIsBadAndExitsWith4) {
  make_table("good", Model::kLambertGgx, 1);
  write_bytes("bad.binary", "not a table");
  const ProgramResult result =
      run("table " + quoted("bad.binary") + " " + quoted("good.binary") + " --model lambert-ggx --json -q");
  EXPECT_EQ(result.exit_code, 4);
  const auto printed = json::parse(result.out);
  EXPECT_EQ(printed["rows"].size(), 1U);
  EXPECT_EQ(printed["failures"].size(), 1U);
  EXPECT_EQ(run("table " + quoted("bad.binary") + " -q").exit_code, 3);
}

TEST_F(Cli, SynthInfoAndExportAgreeOnWhatATableHolds) {
  synthetic::Recipe recipe;
  recipe.name = "made";
  recipe.material =
      synthetic::random_material(Model::kBurley, Tier::kFull, effects_of(Model::kBurley), {}, 2);
  recipe.grid.n_theta_h = 20;
  recipe.invalid.fraction = 0.1;
  synthetic::write_recipe(path("made.json"), recipe);
  const ProgramResult synth = run("synth " + quoted("made.json") + " --json -o " + quoted("tables"));
  ASSERT_EQ(synth.exit_code, 0) << synth.err;
  const ProgramResult info = run("info " + quoted("tables/made.binary") + " --json");
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(json::parse(info.out)["valid_cells"], json::parse(synth.out)[0]["valid"]);
  EXPECT_EQ(json::parse(info.out)["grid"]["theta_h"], 20);
}

TEST_F(Cli, FixAndInitReachTheFit) {
  make_table("soft", Model::kLambertGgx, 4);
  ASSERT_EQ(
      run("fit " + quoted("soft.binary") +
          " --model lambert-ggx --fix roughness=0.25 --fix base_color=0.1,0.2,0.3 -q -o " + quoted("out"))
          .exit_code,
      0);
  const auto material = json::parse(tests::read_text(path("out/soft.lambert-ggx.json")));
  EXPECT_EQ(material["parameters"]["roughness"], 0.25);
  EXPECT_EQ(material["parameters"]["base_color"], json({0.1, 0.2, 0.3}));
  EXPECT_EQ(material["fit"]["parameters"]["roughness"]["status"], "fixed");
  const ProgramResult result = run("fit " + quoted("soft.binary") + " --model lambert-ggx --init " +
                                   quoted("out/soft.lambert-ggx.json") + " -q -o " + quoted("again"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(tests::read_text(path("again/soft.lambert-ggx.json")))["fit"]["options"]["init"],
            true);
}

}  // namespace
}  // namespace brdfit
