// Recipes: JSON round trip, defaults, hostile input, and the ten published materials that are shipped.
#include "data/synthetic/recipe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "io/material_json.h"

namespace brdfit::synthetic {
namespace {

io::Json minimal() {
  return {
      {"brdfit_recipe", 1}, {"name", "least"}, {"material", io::material_to_json(Material(Model::kBurley))}};
}

TEST(Recipe, EveryMemberComesBackBitForBit) {
  Recipe recipe;
  recipe.name = "all of it";
  recipe.source = "a \"source\", \u00e9";
  recipe.grid = {9, 8, 7, CellAnchor::kCentre};
  recipe.noise = {0.1, 1.0 / 3.0};
  recipe.invalid = {0.7, 3, 5, 81.3};
  recipe.seed = std::numeric_limits<std::uint64_t>::max();
  for (const Model model : all_models()) {
    recipe.material = random_material(model, Tier::kFull, effects_of(model), {}, 8);
    // Through text, as through a file.
    const std::string text = recipe_to_json(recipe).dump();
    EXPECT_EQ(recipe_from_json(io::Json::parse(text), "x.json"), recipe) << name_of(model);
  }
}

TEST(Recipe, FileComesBackBitForBit) {
  Recipe recipe;
  recipe.name = "file";
  recipe.material = random_material(Model::kCallisto, Tier::kFull, effects_of(Model::kCallisto), {}, 9);
  recipe.seed = 123456789012345678;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "brdfit_recipe_round_trip.json";
  write_recipe(file, recipe);
  EXPECT_EQ(read_recipe(file), recipe);
  std::filesystem::remove(file);
}

TEST(Recipe, WhatIsAbsentIsAtItsDefault) {
  Recipe expected;
  expected.name = "least";
  expected.material = Material(Model::kBurley);
  EXPECT_EQ(expected.grid, (Grid{90, 90, 180, CellAnchor::kLowerEdge}));
  EXPECT_EQ(recipe_from_json(minimal(), "x.json"), expected);
  io::Json empty_groups = minimal();
  for (const char* group : {"grid", "noise", "invalid"}) empty_groups[group] = io::Json::object();
  EXPECT_EQ(recipe_from_json(empty_groups, "x.json"), expected);
}

// An edit of a good recipe, and the member that the error must name.
struct Hostile {
  std::string name;
  std::function<void(io::Json&)> edit;
  std::string member;
};

void PrintTo(const Hostile& hostile, std::ostream* out) {
  *out << hostile.name;
}

class HostileRecipe : public ::testing::TestWithParam<Hostile> {};

TEST_P(HostileRecipe, ErrorNamesFileAndMember) {
  io::Json json = minimal();
  ASSERT_NO_THROW(recipe_from_json(json, "folder/bad.json"));
  GetParam().edit(json);
  try {
    recipe_from_json(json, "folder/bad.json");
    ADD_FAILURE() << "accepted";
  } catch (const io::IoError& error) {
    EXPECT_EQ(error.file(), "folder/bad.json");
    EXPECT_EQ(error.side(), io::IoError::Side::kInput);
    EXPECT_NE(error.found().find("'" + GetParam().member + "'"), std::string::npos) << error.what();
    EXPECT_FALSE(error.expected().empty());
  }
}

// Sets a member by its path.
std::function<void(io::Json&)> set(const std::string& pointer, const io::Json& value) {
  return [=](io::Json& json) { json[io::Json::json_pointer(pointer)] = value; };
}

std::function<void(io::Json&)> erase(const std::string& key) {
  return [=](io::Json& json) { json.erase(key); };
}

const std::vector<Hostile>& hostile_recipes() {
  using io::Json;
  static const std::vector<Hostile> all = {
      {"NoVersion", erase("brdfit_recipe"), "brdfit_recipe"},
      {"OtherVersion", set("/brdfit_recipe", 2), "brdfit_recipe"},
      {"VersionAsText", set("/brdfit_recipe", "1"), "brdfit_recipe"},
      {"UnknownKey", set("/colour", 1), "colour"},
      {"UnknownKeyInGrid", set("/grid/theta", 90), "grid.theta"},
      {"UnknownKeyInNoise", set("/noise/sigma", 0.1), "noise.sigma"},
      {"UnknownKeyInInvalid", set("/invalid/holes", 1), "invalid.holes"},
      {"NoName", erase("name"), "name"},
      {"EmptyName", set("/name", ""), "name"},
      {"NameAsNumber", set("/name", 3), "name"},
      {"SourceAsList", set("/source", Json::array()), "source"},
      {"NoMaterial", erase("material"), "material"},
      {"MaterialAsText", set("/material", "blue"), "material"},
      {"UnknownModel", set("/material/model", "phong"), "material.model"},
      {"RoughnessOutOfRange", set("/material/parameters/roughness", 0.0), "material.parameters.roughness"},
      {"UnknownParameter", set("/material/parameters/shine", 0.5), "material.parameters.shine"},
      {"GridAsNumber", set("/grid", 90), "grid"},
      {"GridZero", set("/grid/theta_h", 0), "grid.theta_h"},
      {"GridNegative", set("/grid/theta_d", -90), "grid.theta_d"},
      {"GridFraction", set("/grid/phi_d", 180.5), "grid.phi_d"},
      {"GridDimensionTooLarge", set("/grid/phi_d", 1'000'000), "grid.phi_d"},
      {"GridTooManyCells",
       set("/grid", {{"theta_h", Recipe::kMaxDimension}, {"theta_d", Recipe::kMaxDimension}, {"phi_d", 180}}),
       "grid"},
      {"UnknownAnchor", set("/grid/anchor", "upper-edge"), "grid.anchor"},
      {"AnchorAsNumber", set("/grid/anchor", 0), "grid.anchor"},
      {"NoiseNegative", set("/noise/multiplicative", -0.01), "noise.multiplicative"},
      {"NoiseTooLarge", set("/noise/multiplicative", 1.5), "noise.multiplicative"},
      {"AdditiveAsText", set("/noise/additive", "0.1"), "noise.additive"},
      {"AdditiveNotFinite", set("/noise/additive", std::numeric_limits<double>::infinity()),
       "noise.additive"},
      {"FractionOne", set("/invalid/fraction", 1.0), "invalid.fraction"},
      {"FractionNegative", set("/invalid/fraction", -0.5), "invalid.fraction"},
      {"BlocksNegative", set("/invalid/blocks", -1), "invalid.blocks"},
      {"BlockCellsZero", set("/invalid/block_cells", 0), "invalid.block_cells"},
      {"ThetaZero", set("/invalid/max_theta_deg", 0), "invalid.max_theta_deg"},
      {"ThetaPastTheHorizon", set("/invalid/max_theta_deg", 91), "invalid.max_theta_deg"},
      {"SeedNegative", set("/seed", -1), "seed"},
      {"SeedFraction", set("/seed", 1.5), "seed"},
      {"SeedAsText", set("/seed", "1"), "seed"},
  };
  return all;
}

INSTANTIATE_TEST_SUITE_P(Inputs, HostileRecipe, ::testing::ValuesIn(hostile_recipes()),
                         [](const auto& test) { return test.param.name; });

TEST(Recipe, SeedBeyondSixtyFourBitsIsRefused) {
  io::Json json = minimal();
  json["seed"] = io::Json::parse("18446744073709551616");
  EXPECT_THROW(recipe_from_json(json, "x.json"), io::IoError);
}

TEST(Recipe, DocumentThatIsNoObjectIsRefused) {
  EXPECT_THROW(recipe_from_json(io::Json::array(), "x.json"), io::IoError);
  EXPECT_THROW(recipe_from_json(io::Json("recipe"), "x.json"), io::IoError);
}

TEST(Recipe, FileThatIsNotThereIsAnErrorThatNamesIt) {
  try {
    read_recipe("no/such/recipe.json");
    ADD_FAILURE() << "accepted";
  } catch (const io::IoError& error) {
    EXPECT_EQ(error.file(), "no/such/recipe.json");
  }
}

std::vector<std::filesystem::path> shipped_recipes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(BRDFIT_RECIPES)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

class ShippedRecipe : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedRecipe, IsAValidMaterialWithItsSource) {
  const Recipe recipe = read_recipe(GetParam());
  std::string why;
  EXPECT_TRUE(recipe.is_valid(&why)) << why;
  EXPECT_EQ(recipe.name, GetParam().stem().string());
  EXPECT_EQ(GetParam().stem().extension().string(), "." + std::string(name_of(recipe.material.model())));
  EXPECT_NE(recipe.source.find("Jimenez et al. 2023"), std::string::npos);
  EXPECT_EQ(recipe.material.effects(), effects_in_use(recipe.material));
}

TEST_P(ShippedRecipe, IsAnExactTableOfTheUsualSize) {
  const Recipe recipe = read_recipe(GetParam());
  EXPECT_EQ(recipe.grid, Grid{});
  EXPECT_EQ(recipe.noise, Noise{});
  EXPECT_EQ(recipe.invalid, Invalid{});
  EXPECT_EQ(recipe.seed, 1U);
}

TEST_P(ShippedRecipe, LinearColoursAreExactlyThoseOfThePublishedBytes) {
  const io::Json json = io::read_json(GetParam());
  const io::Json& parameters = json["material"]["parameters"];
  int colours = 0;
  for (const auto& [name, value] : parameters.items()) {
    if (!value.is_array() || name.ends_with("_srgb8")) continue;
    ++colours;
    for (std::size_t c = 0; c < 3; ++c) {
      const int published = parameters[name + "_srgb8"][c].get<int>();
      // pow may round the last bit differently from one library to another.
      EXPECT_DOUBLE_EQ(value[c].get<double>(), io::linear_from_srgb8(published)) << name;
    }
  }
  EXPECT_GE(colours, 1);
}

TEST_P(ShippedRecipe, IsWrittenAsThisProgramWritesIt) {
  EXPECT_EQ(recipe_to_json(read_recipe(GetParam())), io::read_json(GetParam()));
}

TEST_P(ShippedRecipe, GeneratesATable) {
  Recipe recipe = read_recipe(GetParam());
  recipe.grid = {10, 11, 12, CellAnchor::kCentre};
  GenerateReport report;
  const MeasuredTable table = generate_table(recipe, &report);
  EXPECT_GT(report.valid, recipe.grid.cell_count() / 2);
  EXPECT_LT(report.valid, recipe.grid.cell_count());
  EXPECT_EQ(table.valid_count(), report.valid);
  EXPECT_EQ(report.dropped, 0U);
  EXPECT_EQ(report.floored_at_zero, 0U);
  EXPECT_GT(table.largest(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Talk, ShippedRecipe, ::testing::ValuesIn(shipped_recipes()), [](const auto& test) {
  std::string name = test.param.stem().string();
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '.'; }, '_');
  return name;
});

TEST(ShippedRecipes, AreTheTenMaterialsOfTheTalkTwice) {
  std::vector<std::string> names;
  for (const auto& file : shipped_recipes()) {
    EXPECT_EQ(file.extension(), ".json");
    if (file.stem().extension() == ".callisto") {
      names.push_back(file.stem().stem().string());
      EXPECT_TRUE(std::filesystem::exists(file.parent_path() / (names.back() + ".burley.json")))
          << names.back();
    }
  }
  EXPECT_EQ(shipped_recipes().size(), 20U);
  EXPECT_EQ(names, (std::vector<std::string>{"black-soft-plastic", "blue-fabric", "gold-metallic-paint2",
                                             "light-red-paint", "red-fabric2", "specular-red-phenolic",
                                             "two-layer-silver", "yellow-matte-plastic", "yellow-phenolic",
                                             "yellow-plastic"}));
}

}  // namespace
}  // namespace brdfit::synthetic
