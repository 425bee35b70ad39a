// docs/schema/stack_recipe.schema.json says of recipes what their reader does.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "data/synthetic/stack_recipe.h"
#include "tests/json_schema.h"
#include "tests/schema_tools.h"

namespace brdfit {
namespace {

using io::Json;
using synthetic::StackRecipe;
using tests::JsonSchema;

const std::filesystem::path kSource = BRDFIT_SOURCE_DIR;

JsonSchema stack_recipe_schema() {
  return JsonSchema(
      io::read_json(kSource / "docs/schema/stack_recipe.schema.json"),
      {{"material.schema.json", JsonSchema(io::read_json(kSource / "docs/schema/material.schema.json"))}});
}

StackRecipe plain_recipe() {
  StackRecipe recipe;
  recipe.name = "plain";
  recipe.materials = {Material(Model::kLambertGgx)};
  return recipe;
}

// With every fault, and every member away from its default.
StackRecipe odd_recipe() {
  StackRecipe recipe = plain_recipe();
  recipe.source = "\"quoted\", \u00e9\n";
  recipe.width = 16384;
  recipe.height = 1;
  recipe.shape = {synthetic::Relief::kSphere, 10.0, 4096.0};
  recipe.materials = {Material(Model::kBurley), Material(Model::kCallisto)};
  recipe.patch_px = 16384;
  recipe.lights = {synthetic::Arrangement::kSparse, 10000, 90.0, 1e6, 1e6};
  recipe.cast_shadows = false;
  recipe.residual = {32, 1e6, 1e-6, 1000.0};
  recipe.noise = {1.0, 1000.0};
  recipe.faults.gains = {{0, 0.5}, {9999, 100.0}};
  recipe.faults.swapped = {{3, 4}, {9999, 0}};
  recipe.faults.upside_down = true;
  recipe.faults.hot_pixels = 1000000;
  recipe.files = {"tif", "srgb", 100, "4:4:4", "json", true, true};
  recipe.seed = std::numeric_limits<std::uint64_t>::max();
  return recipe;
}

Json document_of(const StackRecipe& recipe) {
  // Through text, as a file's numbers come.
  return Json::parse(synthetic::stack_recipe_to_json(recipe).dump());
}

bool is_read(const Json& json) {
  try {
    synthetic::stack_recipe_from_json(json, "r.json");
    return true;
  } catch (const io::IoError&) {
    return false;
  }
}

TEST(StackRecipeSchema, EveryShippedRecipeIsValid) {
  const JsonSchema schema = stack_recipe_schema();
  int recipes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "data/synthetic/stacks")) {
    EXPECT_EQ(schema.complaint(io::read_json(entry.path())), "") << entry.path();
    ++recipes;
  }
  EXPECT_GE(recipes, 1);
}

TEST(StackRecipeSchema, EveryRecipeThatIsWrittenIsValidWithNoMemberLeftUndescribed) {
  const JsonSchema schema = stack_recipe_schema();
  for (const StackRecipe& recipe : {plain_recipe(), odd_recipe()}) {
    std::string why;
    ASSERT_TRUE(recipe.is_valid(&why)) << why;
    const Json written = document_of(recipe);
    EXPECT_EQ(schema.complaint(written), "") << written;
    tests::expect_all_members_are_described(schema, written);
    tests::expect_all_numbers_are_bounded(schema, written);
  }
}

TEST(StackRecipeSchema, AllowsToLeaveOutWhatTheReaderDoes) {
  const JsonSchema schema = stack_recipe_schema();
  const Json sound = document_of(odd_recipe());
  for (const Json::json_pointer& member : tests::members_of(sound)) {
    // Without so many lights the faults would name some that are not there, which no schema can say.
    if (member.to_string().starts_with("/lights")) continue;
    const Json json = tests::without(sound, member);
    EXPECT_EQ(schema.complaint(json).empty(), is_read(json)) << member;
  }
  EXPECT_TRUE(is_read(
      Json::parse(R"({"brdfit_stack_recipe": 1, "name": "x", "materials": [{"brdfit": 1, "model": "burley",
    "parameters": {}, "effects": [], "options": {}}]})")));
}

TEST(StackRecipeSchema, RefusesWhatTheReaderRefuses) {
  const JsonSchema schema = stack_recipe_schema();
  const Json sound = document_of(plain_recipe());
  ASSERT_TRUE(is_read(sound));
  EXPECT_NE(schema.complaint(Json::array()), "");
  const Json changes = Json::parse(R"([
    {"brdfit_stack_recipe": 2}, {"name": ""}, {"name": "a/b"}, {"name": 3}, {"source": []}, {"extra": 1},
    {"width": 0}, {"width": 16385}, {"height": 1.5}, {"shape": {"relief": "cube"}}, {"shape": {"slope": 11}},
    {"shape": {"wavelength_px": 3}}, {"shape": {"bumps": 1}}, {"materials": []}, {"materials": {}},
    {"materials": [{"model": "phong"}]}, {"patch_px": -1}, {"albedo_variation": 1.1},
    {"lights": {"arrangement": "grid"}}, {"lights": {"count": 0}}, {"lights": {"count": 10001}},
    {"lights": {"theta_deg": 91}}, {"lights": {"intensity": 0}}, {"lights": {"distance": -1}},
    {"cast_shadows": 1}, {"residual": {"lobes": 33}}, {"residual": {"sharpness": -1}},
    {"residual": {"cut_off_deg": 0}}, {"residual": {"strength": 1001}}, {"residual": {"axis": 1}},
    {"noise": {"multiplicative": 1.1}}, {"noise": {"additive": -1}},
    {"faults": {"gains": [1]}}, {"faults": {"gains": [[1]]}}, {"faults": {"gains": [[1, 2, 3]]}},
    {"faults": {"gains": [[1.5, 2]]}}, {"faults": {"gains": [[1, 0]]}}, {"faults": {"gains": [[1, 101]]}},
    {"faults": {"gains": [[-1, 2]]}}, {"faults": {"gains": {}}}, {"faults": {"swapped": [[1, 2.5]]}},
    {"faults": {"swapped": [[1]]}}, {"faults": {"swapped": [[10000, 1]]}}, {"faults": {"upside_down": 0}},
    {"faults": {"hot_pixels": -1}}, {"faults": {"hot_pixels": 1000001}}, {"faults": {"dust": 1}},
    {"files": {"format": 1}}, {"files": {"format": "../exr"}}, {"files": {"transfer": "log"}},
    {"files": {"jpeg_quality": 0}}, {"files": {"jpeg_quality": 101}}, {"files": {"jpeg_subsampling": "4:2:1"}}, {"files": {"manifest": "xml"}},
    {"files": {"give_normals": "yes"}}, {"files": {"depth": 8}},
    {"files": {"manifest": "lp"}, "lights": {"distance": 2}}, {"seed": -1}, {"seed": 0.5}
  ])");
  for (const Json& change : changes) {
    Json json = sound;
    json.merge_patch(change);
    EXPECT_FALSE(is_read(json)) << change;
    EXPECT_NE(schema.complaint(json), "") << change;
  }
}

TEST(StackRecipeSchema, DefaultsAreThoseOfTheReader) {
  const Json schema = io::read_json(kSource / "docs/schema/stack_recipe.schema.json");
  const Json defaults = document_of(plain_recipe());
  for (const Json::json_pointer& member : tests::members_of(defaults)) {
    const std::string place = member.to_string();
    if (place.starts_with("/materials") || place == "/name" || place == "/brdfit_stack_recipe") continue;
    Json::json_pointer described("/properties");
    described /= place.substr(1, place.find('/', 1) - 1);
    if (place.find('/', 1) != std::string::npos) described = described / "properties" / member.back();
    ASSERT_TRUE(schema.contains(described)) << member;
    if (schema[described].contains("properties")) continue;
    EXPECT_EQ(schema[described]["default"], defaults[member]) << member;
  }
}

}  // namespace
}  // namespace brdfit
