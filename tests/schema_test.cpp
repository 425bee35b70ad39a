// docs/schema: every file that the program writes is valid, and a member that is wrong is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "tests/json_schema.h"
#include "tests/program.h"
#include "tests/schema_tools.h"
#include "tests/temp_folder.h"

namespace brdfit {
namespace {

using io::Json;
using synthetic::Recipe;
using tests::complaint_with;
using tests::expect_all_members_are_described;
using tests::expect_all_numbers_are_bounded;
using tests::JsonSchema;
using tests::members_of;
using tests::without;

const std::filesystem::path kSource = BRDFIT_SOURCE_DIR;

JsonSchema material_schema() {
  return JsonSchema(io::read_json(kSource / "docs/schema/material.schema.json"));
}

JsonSchema recipe_schema() {
  return JsonSchema(io::read_json(kSource / "docs/schema/recipe.schema.json"),
                    {{"material.schema.json", material_schema()}});
}

Recipe small_recipe(Model model) {
  Recipe recipe;
  recipe.name = name_of(model);
  recipe.material = synthetic::random_material(model, Tier::kFull, effects_of(model), {}, 3);
  recipe.grid = {20, 20, 24, CellAnchor::kLowerEdge};
  return recipe;
}

// Recipes at the ends of their ranges, and materials with options that are not the defaults.
std::vector<Recipe> odd_recipes() {
  std::vector<Recipe> recipes;
  for (const Model model : all_models()) {
    Recipe least = small_recipe(model);
    least.material = Material(model);
    least.grid = {1, 1, 1, CellAnchor::kCentre};
    least.invalid = {0.0, 0, 1, 0.001};
    least.seed = 0;
    Recipe most = small_recipe(model);
    most.source = "\"quoted\", \u00e9\n";
    most.material.set_effects(effects_of(model));
    most.material.options() = {Masking::kCorrelated, BurleyG::k2017, Diffuse::kProxima};
    most.grid.n_phi_d = Recipe::kMaxDimension;
    most.noise = {1.0, 1000.0};
    most.invalid = {1.0 - 0x1p-53, 1000, 64, 90.0};
    most.seed = std::numeric_limits<std::uint64_t>::max();
    recipes.insert(recipes.end(), {least, most});
  }
  return recipes;
}

TEST(RecipeSchema, EveryShippedRecipeIsValid) {
  const JsonSchema schema = recipe_schema();
  int recipes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "data/synthetic/recipes")) {
    EXPECT_EQ(schema.complaint(io::read_json(entry.path())), "") << entry.path();
    ++recipes;
  }
  EXPECT_GE(recipes, 20);
}

TEST(RecipeSchema, EveryRecipeThatIsWrittenIsValidWithNoMemberLeftUndescribed) {
  const JsonSchema schema = recipe_schema();
  const tests::TempFolder folder;
  for (const Recipe& recipe : odd_recipes()) {
    synthetic::write_recipe(folder / "odd.json", recipe);
    const Json written = io::read_json(folder / "odd.json");
    EXPECT_EQ(schema.complaint(written), "") << written;
    expect_all_members_are_described(schema, written);
    expect_all_numbers_are_bounded(schema, written);
  }
}

bool is_read(const Json& recipe) {
  try {
    synthetic::recipe_from_json(recipe, "r.json");
    return true;
  } catch (const io::IoError&) {
    return false;
  }
}

TEST(RecipeSchema, AllowsToLeaveOutWhatTheReaderDoes) {
  const JsonSchema schema = recipe_schema();
  const Json sound = Json::parse(synthetic::recipe_to_json(small_recipe(Model::kCallisto)).dump());
  for (const Json::json_pointer& member : members_of(sound)) {
    const Json json = without(sound, member);
    EXPECT_EQ(schema.complaint(json).empty(), is_read(json)) << member;
  }
}

TEST(RecipeSchema, RefusesWhatTheReaderRefuses) {
  const JsonSchema schema = recipe_schema();
  const Json sound = Json::parse(synthetic::recipe_to_json(small_recipe(Model::kBurley)).dump());
  ASSERT_TRUE(is_read(sound));
  EXPECT_NE(schema.complaint(Json::array()), "");
  const Json changes = Json::parse(R"([
    {"brdfit_recipe": 2}, {"name": ""}, {"name": 3}, {"source": []}, {"material": "blue"}, {"extra": 1},
    {"material": {"model": "phong"}}, {"material": {"parameters": {"roughness": 0}}},
    {"grid": 90}, {"grid": {"theta_h": 0}}, {"grid": {"theta_h": 4097}}, {"grid": {"theta_d": 0}},
    {"grid": {"theta_d": 4097}}, {"grid": {"phi_d": 0}}, {"grid": {"phi_d": 4097}}, {"grid": {"phi_d": 1.5}},
    {"grid": {"anchor": "middle"}}, {"grid": {"theta": 1}},
    {"noise": {"multiplicative": -0.1}}, {"noise": {"multiplicative": 1.1}}, {"noise": {"additive": 1001}},
    {"invalid": {"fraction": 1}}, {"invalid": {"fraction": -0.1}}, {"invalid": {"blocks": 1001}},
    {"invalid": {"block_cells": 0}}, {"invalid": {"block_cells": 65}},
    {"invalid": {"max_theta_deg": 0}}, {"invalid": {"max_theta_deg": 91}},
    {"seed": -1}, {"seed": 0.5}, {"seed": "1"}
  ])");
  for (const Json& change : changes) {
    Json json = sound;
    json.merge_patch(change);
    EXPECT_FALSE(is_read(json)) << change;
    EXPECT_NE(schema.complaint(json), "") << change;
  }
}

// A folder with a small table, and the materials that the program fits to it.
class FitSchema : public testing::Test {
 protected:
  FitSchema() { synthetic::generate(small_recipe(Model::kCallisto), folder_ / "small.binary"); }

  std::string quoted(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }

  // The material files of one run, which must succeed.
  std::vector<Json> fit(const std::string& options, const std::string& table = "small.binary") {
    std::filesystem::remove_all(folder_ / "fits");
    std::filesystem::create_directories(folder_ / "streams");
    const tests::ProgramResult result = tests::run_brdfit(
        "fit " + quoted(table) + " -q --threads 2 -o " + quoted("fits") + " " + options, folder_ / "streams");
    EXPECT_EQ(result.exit_code, 0) << options << "\n" << result.err;
    std::vector<Json> written;
    if (result.exit_code != 0) return written;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "fits")) {
      written.push_back(io::read_json(entry.path()));
    }
    return written;
  }

  // One file for each model that is asked for, all of them valid.
  void expect_valid(const std::string& options, std::size_t models,
                    const std::string& table = "small.binary") {
    const std::vector<Json> written = fit(options, table);
    EXPECT_EQ(written.size(), models) << options;
    for (const Json& material : written) {
      EXPECT_TRUE(material.contains("fit")) << options;
      EXPECT_EQ(schema_.complaint(material), "") << options << "\n" << material.dump(2);
    }
  }

  tests::TempFolder folder_;
  const JsonSchema schema_ = material_schema();
};

TEST_F(FitSchema, WhatIsWrittenIsValidForEveryChoiceOfSamples) {
  expect_valid("--samples 500", 3);
  expect_valid("--samples all", 3);
  expect_valid("--on slices --phi-d 0,90", 3);
  expect_valid("--samples 500 --max-theta 70 --cell centre --starts 2 --seed 18446744073709551615", 3);
}

// A table that is large enough for a choice, and one that is fitted whole.
TEST_F(FitSchema, WhatIsWrittenIsValidWithAChosenSizeAndHeldOutErrors) {
  Recipe large = small_recipe(Model::kCallisto);
  large.grid = {30, 30, 36, CellAnchor::kLowerEdge};
  synthetic::generate(large, folder_ / "large.binary");
  for (const char* table : {"small.binary", "large.binary"}) {
    for (const Json& material : fit("--held-out=2 --starts 2 --effects none", table)) {
      EXPECT_EQ(schema_.complaint(material), "") << material.dump(2);
      EXPECT_EQ(material["fit"].contains("sample_size"), table == std::string("large.binary"));
      EXPECT_EQ(material["fit"]["held_out"]["folds"].size(), 2U);
      expect_all_members_are_described(schema_, material);
      expect_all_numbers_are_bounded(schema_, material);
    }
  }
}

TEST_F(FitSchema, WrongSizesAndHeldOutErrorsAreRefused) {
  Recipe large = small_recipe(Model::kCallisto);
  large.grid = {30, 30, 36, CellAnchor::kLowerEdge};
  synthetic::generate(large, folder_ / "large.binary");
  const std::vector<Json> written = fit("--held-out=2 --model lambert-ggx", "large.binary");
  ASSERT_EQ(written.size(), 1U);
  const Json wrong = Json::parse(R"([
    ["/options/samples", 500], ["/options/sample_threshold", -1], ["/options/held_out_folds", 1],
    ["/sample_size/trials", []], ["/sample_size/trials/0/samples", 0], ["/sample_size/trials/0/held_out_pct", -1],
    ["/sample_size/trials/1/standard_error_pct", -1], ["/sample_size/check_cells", 0],
    ["/sample_size/converged", 1], ["/held_out/folds", []], ["/held_out/folds/0/observations", 0],
    ["/held_out/folds/0/groups", ["shine"]], ["/held_out/folds/0/loss", "auto"],
    ["/held_out/table/log_ratio_pct", 5], ["/held_out/table/log_ratio_pct/deviation", -1],
    ["/held_out/slice/cells", -1], ["/timings_seconds/held_out", -1]
  ])");
  for (const Json& change : wrong) {
    const std::string place = "/fit" + change[0].get<std::string>();
    EXPECT_NE(complaint_with(schema_, written[0], place, change[1]), "") << change;
  }
}

TEST_F(FitSchema, WhatIsWrittenIsValidForEveryChoiceOfModel) {
  expect_valid("--samples 500 --effects none", 3);
  expect_valid("--samples 500 --effects sheen,dual_specular", 3);
  expect_valid("--samples 500 --masking correlated --diffuse proxima --burley-g 2017", 3);
  for (const char* tier : {"base", "advanced"}) {
    expect_valid("--samples 500 --tier " + std::string(tier), 3);
  }
  for (const char* loss : {"cube-root", "linear", "srgb", "slice", "auto"}) {
    expect_valid("--samples 500 --model lambert-ggx --loss " + std::string(loss), 1);
  }
}

TEST_F(FitSchema, WhatIsWrittenIsValidWithFixedParameters) {
  expect_valid("--samples 500 --fix roughness=0.3 --fix base_color=0.1,0.2,0.3", 3);
  // An intensity whose tint is fixed, by one number for three channels; a tint whose intensity is.
  expect_valid(
      "--samples 500 --model callisto --fix diffuse_fresnel_tint=1 --fix retroreflection=2 "
      "--fix smooth_terminator=-0.5",
      1);
  const std::string all = "--fix base_color=0.1,0.2,0.3 --fix metallic=0 --fix specular=0.5";
  expect_valid("--samples 500 --model lambert-ggx --fix roughness=0.3 " + all, 1);
}

TEST_F(FitSchema, WhatIsWrittenIsValidWithAStartingMaterial) {
  ASSERT_EQ(fit("--samples 500 --model callisto").size(), 1U);
  std::filesystem::copy(folder_ / "fits/small.callisto.json", folder_ / "init.json");
  expect_valid("--samples 500 --model callisto --init " + quoted("init.json"), 1);
}

TEST_F(FitSchema, WhatIsWrittenIsValidForATableWithNotANumberReadLeniently) {
  std::string bytes = tests::read_text(folder_ / "small.binary");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::copy_n(reinterpret_cast<const char*>(&nan), sizeof nan, bytes.begin() + 12);
  tests::write_text(folder_ / "nan.binary", bytes);
  expect_valid("--samples 500 --lenient", 3, "nan.binary");
}

TEST_F(FitSchema, NoMemberOfWhatIsWrittenIsLeftUndescribed) {
  for (const char* options :
       {"--samples 500", "--on slices --model burley --fix sheen=0.5 --fix base_color=0.2 --lenient"}) {
    for (const Json& material : fit(options)) {
      expect_all_members_are_described(schema_, material);
      expect_all_numbers_are_bounded(schema_, material);
    }
  }
}

TEST_F(FitSchema, OnlyWhatIsWrittenForSomeOptionsAloneMayBeMissingFromTheEvidence) {
  for (const Json& material : fit("--samples 500 --fix roughness=0.3 --lenient")) {
    std::vector<std::string> optional;
    for (const Json::json_pointer& member : members_of(material["fit"])) {
      const Json::json_pointer place = Json::json_pointer("/fit") / member;
      if (schema_.complaint(without(material, place)).empty()) optional.push_back(member.to_string());
    }
    EXPECT_THAT(optional, testing::UnorderedElementsAre("/input/non_finite_values", "/options/fixed"));
  }
}

TEST_F(FitSchema, WrongValuesInTheEvidenceAreRefused) {
  const std::vector<Json> written = fit("--samples 500 --model callisto --fix roughness=0.3");
  ASSERT_EQ(written.size(), 1U);
  const Json wrong = Json::parse(R"([
    ["/version", "one"], ["/input/name", ""], ["/input/sha256", "12ab"], ["/input/cell", "middle"],
    ["/options/tier", "best"], ["/options/on", "slices"], ["/options/samples", 0],
    ["/options/samples", "most"], ["/options/phi_d_deg", [90]], ["/options/max_theta_deg", 0], ["/options/max_theta_deg", 91],
    ["/options/loss", "L2"], ["/options/starts", -1], ["/options/seed", -1], ["/options/fixed", {}],
    ["/options/fixed/roughness", [2]], ["/options/fixed/metallic", [0, 0, 0]],
    ["/options/fixed/base_color", [0, 0]], ["/options/fixed/sheen", [0]], ["/options/init", "yes"],
    ["/observations", 0], ["/weights", ""], ["/cost", -1], ["/searched", 0], ["/iterations", 0.5],
    ["/converged", "yes"], ["/termination", "done"], ["/slice/log_ratio_pct", -1], ["/table/srgb", 1.5], ["/slice/slice_pct", 101],
    ["/table/cells", -1], ["/reciprocity_gap_pct", -1], ["/parameters/roughness/value", 2],
    ["/parameters/metallic/status", "fine"], ["/parameters/metallic/channel_status", ["ok", "ok", "ok"]],
    ["/parameters/metallic/standard_error", -1], ["/parameters/metallic/standard_error", "small"],
    ["/parameters/base_color/standard_error", [0, 0]], ["/parameters/base_color/standard_error", 0.1],
    ["/parameters/base_color/standard_error", [0, -1, 0]], ["/parameters/base_color/standard_error", null],
    ["/parameters/roughness/reason", "it is fixed"],
    ["/parameters/metallic", {"value": 0, "status": "ok"}],
    ["/parameters/metallic", {"value": 0, "status": "unidentifiable", "standard_error": null}],
    ["/parameters/metallic", {"value": 0, "status": "unidentifiable", "standard_error": null, "reason": ""}],
    ["/parameters/metallic", {"value": 0, "status": "ok", "standard_error": null, "reason": "tied"}],
    ["/parameters/base_color/value", [0, 0]], ["/parameters/base_color/status", "fixed"],
    ["/parameters/base_color/channel_status", ["ok", "ok", "fixed"]],
    ["/parameters/sheen", {"value": 0, "status": "ok"}],
    ["/correlated", [{"first": "base_color.r", "second": "metallic", "correlation": 1.5}]],
    ["/correlated", [{"first": "base_color.x", "second": "metallic", "correlation": 0.99}]],
    ["/correlated", [{"first": "metallic", "second": "a b", "correlation": -0.99}]],
    ["/correlated", [{"first": "metallic", "second": "specular", "correlation": -1.5}]],
    ["/correlated", [{"first": "metallic", "second": "specular"}]], ["/correlated", ["metallic"]],
    ["/correlated", [{"first": "metallic", "second": "specular", "correlation": 0.99, "extra": 1}]],
    ["/options/fixed/metallic", []], ["/options/fixed/base_color", []],
    ["/options/fixed/base_color", [0, 0, 0, 0]], ["/parameters/base_color/channel_status", ["ok", "ok"]],
    ["/parameters/base_color/channel_status", ["ok", "ok", "ok", "ok"]], ["/notes", [1]],
    ["/sphere_delta_e", -1], ["/sphere_delta_e_by_light", {}], ["/sphere_delta_e_by_light/90", -1],
    ["/sphere_delta_e_by_light/45", 1], ["/sphere_pixels_skipped", 0.5], ["/timings_seconds/sphere", -1],
    ["/notes", [""]], ["/timings_seconds/fit", -1],
    ["/ladder_start", null], ["/ladder_start/effects", ["sheen"]],
    ["/ladder_start/effects", ["dual_specular"]], ["/ladder_start/parameters/roughness", 2],
    ["/ladder_start/parameters/dual_specular_opacity", 0.5], ["/ladder_start/parameters/base_color", 0.5],
    ["/ladder/0/material", {}], ["/ladder/0/material/effects", ["clearcoat"]],
    ["/ladder/0/material/parameters/roughness", 0], ["/ladder/0/material/parameters", {"roughness": 0.5}]
  ])");
  ASSERT_FALSE(written[0]["fit"]["ladder"].empty());
  for (const Json& change : wrong) {
    const std::string place = "/fit" + change[0].get<std::string>();
    EXPECT_NE(complaint_with(schema_, written[0], place, change[1]), "") << change;
  }
  // Sound values in the same places pass.
  const Json sound = Json::parse(R"([
    ["/parameters/metallic", {"value": 0, "status": "unidentifiable", "standard_error": null, "reason": "tied"}],
    ["/parameters/metallic", {"value": 0, "status": "ok", "standard_error": 0.1}],
    ["/parameters/base_color/standard_error", [0.1, null, 0]],
    ["/options/samples", "all"], ["/options/fixed/metallic", [0]], ["/options/fixed/base_color", [0, 0, 0]],
    ["/correlated", [{"first": "base_color.r", "second": "metallic", "correlation": -0.99}]]
  ])");
  for (const Json& change : sound) {
    const std::string place = "/fit" + change[0].get<std::string>();
    EXPECT_EQ(complaint_with(schema_, written[0], place, change[1]), "") << change;
  }
}

TEST_F(FitSchema, GroupsAreThoseOfTheModel) {
  const std::vector<Json> written = fit("--samples 500 --starts 1");
  ASSERT_EQ(written.size(), 3U);
  const std::vector<std::pair<std::string, std::string>> groups = {
      {"burley", "clearcoat"}, {"callisto", "dual_specular"}, {"callisto", "smooth_terminator_length"}};
  const Json step = Json::parse(R"({"action": "added", "held_out_before_pct": 2, "held_out_after_pct": 1,
                                    "standard_error_pct": 0.1, "parameters": 1})");
  for (const Json& material : written) {
    for (const auto& [model, group] : groups) {
      const bool is_own = material["model"] == model;
      Json ladder = Json::array({step});
      ladder[0]["groups"] = {group};
      if (material["fit"].contains("ladder")) ladder[0]["material"] = material["fit"]["ladder_start"];
      std::vector<std::pair<std::string, Json>> places = {{"/fit/groups", {group}},
                                                          {"/fit/options/effects", {group}}};
      if (material["fit"].contains("ladder")) places.emplace_back("/fit/ladder", ladder);
      for (const auto& [place, value] : places) {
        Json changed = material;
        if (place == "/fit/options/effects") changed["fit"]["options"].erase("group_threshold");
        EXPECT_EQ(complaint_with(schema_, changed, place, value).empty(), is_own)
            << material["model"] << place << group;
      }
    }
  }
}

TEST_F(FitSchema, WrongSlicesInTheEvidenceAreRefused) {
  const std::vector<Json> written = fit("--on slices --phi-d 45,90 --model lambert-ggx");
  ASSERT_EQ(written.size(), 1U);
  const std::string place = "/fit/options/phi_d_deg";
  EXPECT_EQ(complaint_with(schema_, written[0], place, {0, 179.9}), "");
  for (const Json& angles : Json::parse(R"([[], [180], [-1], ["90"], 90])")) {
    EXPECT_NE(complaint_with(schema_, written[0], place, angles), "") << angles;
  }
  EXPECT_NE(schema_.complaint(without(written[0], Json::json_pointer(place))), "");
  EXPECT_NE(complaint_with(schema_, written[0], "/fit/options/samples", 500), "");
}

}  // namespace
}  // namespace brdfit
