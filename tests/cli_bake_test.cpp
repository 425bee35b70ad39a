// The way from a recipe to a relit picture: synth, info, bake, relight.
#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "cli/asset_files.h"
#include "data/synthetic/stack.h"
#include "io/exr_rows.h"
#include "io/image_stack_file.h"
#include "io/realis_json.h"
#include "tests/cli_stack_fixture.h"
#include "tests/json_schema.h"

namespace brdfit::cli {
namespace {

using testing::HasSubstr;

class CliBake : public tests::CliStackFixture {
 protected:
  // Normals and albedo given.
  static synthetic::StackRecipe recipe() {
    synthetic::StackRecipe recipe = matte_bumps(24, 20, 30);
    recipe.files.give_normals = true;
    recipe.files.give_albedo = true;
    return recipe;
  }

  tests::ProgramResult bake(const std::string& options) {
    return run("bake -q --force -o " + quoted("baked") + " " + options + " " +
               quoted("stack/bumps.olat.json"));
  }
};

TEST_F(CliBake, TheStackOnDiskIsTheOneOfTheRecipe) {
  synth(recipe());
  synthetic::SyntheticStack truth(recipe());
  io::FileStack stack(io::read_stack_source(path("stack/bumps.olat.json")));
  const TexelBlock expected = truth.read_rows(3, 5);
  const TexelBlock found = stack.read_rows(3, 5);
  ASSERT_EQ(found.rgb.size(), expected.rgb.size());
  for (std::size_t k = 0; k < found.rgb.size(); ++k) EXPECT_NEAR(found.rgb[k], expected.rgb[k], 1e-6);
  ASSERT_EQ(found.normals.size(), expected.normals.size());
  for (std::size_t k = 0; k < found.normals.size(); ++k)
    EXPECT_NEAR(found.normals[k], expected.normals[k], 1e-6);
  for (std::size_t light = 0; light < 30; ++light) {
    EXPECT_NEAR(stack.info().lights[light].direction.x, truth.info().lights[light].direction.x, 1e-9);
  }
}

TEST_F(CliBake, CorrectsWhatTheModelMissesUnderLightsThatItHasNotSeen) {
  synth(recipe());
  const tests::ProgramResult baked = bake("--lobes 4 --base lambert --folds 5 --json");
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  const io::Json json = io::Json::parse(baked.out);
  const io::Json& evidence = json["evidence"];
  const double lambert = evidence["lambert"]["held_out_rmse_255"];
  const double realis = evidence["realis"]["held_out_rmse_255"];
  EXPECT_GT(lambert, 3.0);
  EXPECT_LT(realis, 0.35 * lambert);
  // Rounding to 8 bits costs less than a quarter of a display code.
  EXPECT_LT(evidence["realis-8bit"]["train_rmse_255"].get<double>(),
            evidence["realis"]["train_rmse_255"].get<double>() + 0.25);
  EXPECT_EQ(json["lobes"], 4);
  EXPECT_EQ(json["bytes_per_texel"], 4.0);
}

TEST_F(CliBake, SaysWhatColourIsWorthWhereColourIsBaked) {
  synth(recipe());
  const std::string options = "bake --force --lobes 2 --uniform --base lambert --folds 2 --sample 100 -o " +
                              quoted("baked") + " --colour ";
  const tests::ProgramResult plain = run(options + "luminance " + quoted("stack/bumps.olat.json"));
  EXPECT_THAT(plain.out, testing::Not(HasSubstr("RGB")));
  const tests::ProgramResult coloured = run(options + "rgb " + quoted("stack/bumps.olat.json"));
  EXPECT_THAT(coloured.out, HasSubstr("RGB RMSE in 1/255"));
  const io::Json evidence = io::read_json(path("baked/bumps.realis.json"))["bake"]["evidence"];
  for (const auto& [name, method] : evidence.items()) {
    EXPECT_THAT(coloured.out, HasSubstr("\n" + name + " "));
    EXPECT_EQ(method["rgb_held_out_per_light_255"].size(), 30U) << name;
    EXPECT_GE(method["rgb_worst_light_rmse_255"], method["rgb_held_out_rmse_255"]) << name;
  }
  EXPECT_LT(evidence["realis"]["rgb_held_out_rmse_255"], evidence["lambert"]["rgb_held_out_rmse_255"]);
}

TEST_F(CliBake, WhatIsWrittenFitsItsSchema) {
  synth(recipe());
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/realis.schema.json"));
  for (const std::string& options :
       {std::string("--base auto --model lambert-ggx --gains --folds 2 --lobes 2 --sample 100"),
        std::string("--base lambert --no-evidence --lobes 2 --uniform --colour rgb"),
        std::string("--base lambert --folds 2 --lobes 2 --uniform --sample 100 --colour scaled-chroma")}) {
    const tests::ProgramResult baked = bake(options);
    ASSERT_EQ(baked.exit_code, 0) << baked.err;
    const io::Json json = io::read_json(path("baked/bumps.realis.json"));
    EXPECT_EQ(schema.complaint(json), "") << options;
    io::Json unknown = json;
    unknown["bake"]["plan"]["extra"] = 1;
    EXPECT_NE(schema.complaint(unknown), "");
  }
}

TEST_F(CliBake, TakesLobesRidgeAndRangesOfAnotherAsset) {
  synth(recipe());
  ASSERT_EQ(bake("--lobes 4 --base lambert --no-evidence").exit_code, 0);
  const io::Json first = io::read_json(path("baked/bumps.realis.json"));
  const std::string again = "bake -q --force --base lambert --no-evidence --lobe-set " +
                            quoted("baked/bumps.realis.json") + " -o " + quoted("again") + " " +
                            quoted("stack/bumps.olat.json");
  ASSERT_EQ(run(again + " --timings").exit_code, 0);
  const io::Json second = io::read_json(path("again/bumps.realis.json"));
  EXPECT_EQ(second["penalty"], first["penalty"]);
  EXPECT_EQ(second["packing"], first["packing"]);
  EXPECT_FALSE(second["bake"].contains("sample_texels"));
  EXPECT_GT(second["bake"]["timings"]["phases"]["total"][0].get<double>(), 0.0);
  const tests::JsonSchema schema(
      io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/realis.schema.json"));
  EXPECT_EQ(schema.complaint(second), "");
  const auto amplitudes = [&](const std::string& file) {
    return io::ExrRowReader(path(file), {"lobe00.Y", "lobe01.Y", "lobe02.Y", "lobe03.Y"}).read(0, 20);
  };
  const std::vector<float> expected = amplitudes("baked/bumps.amplitudes.exr");
  const std::vector<float> found = amplitudes("again/bumps.amplitudes.exr");
  for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], expected[k], 1e-4) << k;

  ASSERT_EQ(run(again + " --lobes-only").exit_code, 0);
  EXPECT_TRUE(io::read_json(path("again/bumps.realis.json"))["bake"].contains("sample_texels"));
  EXPECT_EQ(bake("--lobes-only").exit_code, 2);
}

TEST_F(CliBake, RelightsAsTheStackWasLit) {
  synth(recipe());
  ASSERT_EQ(bake("--lobes 4 --base lambert --no-evidence").exit_code, 0);
  synthetic::SyntheticStack truth(recipe());
  const std::size_t light = 11;
  const Vec3 d = truth.info().lights[light].direction;
  const std::string direction =
      " --light " + std::to_string(d.x) + "," + std::to_string(d.y) + "," + std::to_string(d.z);
  for (const std::string& codes : {std::string(), std::string(" --unpacked")}) {
    const tests::ProgramResult relit = run("relight -q --force -o " + quoted("relit.exr") + direction +
                                           codes + " " + quoted("baked/bumps.realis.json"));
    ASSERT_EQ(relit.exit_code, 0) << relit.err;
    const std::vector<float> found = io::ExrRowReader(path("relit.exr"), {"R", "G", "B"}).read(0, 20);
    const TexelBlock expected = truth.read_rows(0, 20);
    double squares = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < expected.count(); ++k) {
        squares +=
            std::pow(static_cast<double>(found[c * expected.count() + k] - expected.plane(light, c)[k]), 2);
      }
    }
    EXPECT_LT(255.0 * std::sqrt(squares / static_cast<double>(found.size())), 2.0) << codes;
  }
}

TEST_F(CliBake, EveryColourAndPackingIsReadBack) {
  synth(recipe());
  for (const std::string& colour :
       {std::string("luminance"), std::string("scaled-chroma"), std::string("rgb")}) {
    for (const std::string& packing :
         {std::string("--bits 8"), std::string("--bits 4 --dominant 2 --half")}) {
      const tests::ProgramResult baked =
          bake("--lobes 4 --base lambert --no-evidence --colour " + colour + " " + packing);
      ASSERT_EQ(baked.exit_code, 0) << baked.err;
      const tests::ProgramResult relit =
          run("relight -q --force -o " + quoted("relit.png") + " " + quoted("baked/bumps.realis.json"));
      EXPECT_EQ(relit.exit_code, 0) << colour << packing << relit.err;
      EXPECT_TRUE(std::filesystem::exists(path("relit.png")));
    }
  }
}

TEST_F(CliBake, TheResultDoesNotDependOnThreadsOrStrips) {
  synth(recipe());
  ASSERT_EQ(bake("--lobes 4 --base lambert --no-evidence --threads 1 --memory 16").exit_code, 0);
  const std::string one = tests::read_text(path("baked/bumps.amplitudes.exr"));
  ASSERT_EQ(bake("--lobes 4 --base lambert --no-evidence --threads 2").exit_code, 0);
  EXPECT_EQ(tests::read_text(path("baked/bumps.amplitudes.exr")), one);
}

TEST_F(CliBake, OverwritesNoTextureUnlessTold) {
  synth(recipe());
  write_bytes("bumps.albedo.png", "mine");
  const tests::ProgramResult baked = run("bake -q --lobes 2 --base lambert --no-evidence -o " + quoted("") +
                                         " " + quoted("stack/bumps.olat.json"));
  EXPECT_EQ(baked.exit_code, 2);
  EXPECT_THAT(baked.err, HasSubstr("bumps.albedo.png"));
  EXPECT_EQ(tests::read_text(path("bumps.albedo.png")), "mine");
  EXPECT_FALSE(std::filesystem::exists(path("bumps.realis.json")));
}

TEST_F(CliBake, RefusesInOneLine) {
  synth(recipe());
  EXPECT_EQ(bake("--lobes 99").exit_code, 2);
  EXPECT_EQ(bake("--transfer log").exit_code, 2);
  std::filesystem::remove(path("stack/bumps.0003.exr"));
  const tests::ProgramResult missing = bake("--lobes 4");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("bumps.0003.exr"));
  EXPECT_FALSE(std::filesystem::exists(path("baked/bumps.realis.json")));
  const tests::ProgramResult damaged = run("relight -o " + quoted("x.png") + " " + quoted("recipe.json"));
  EXPECT_EQ(damaged.exit_code, 3);
}

}  // namespace
}  // namespace brdfit::cli
