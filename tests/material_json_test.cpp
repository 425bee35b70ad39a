// Material JSON: round trips bit for bit, and everything that is refused.
#include "io/material_json.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::read_text;
using tests::TempFolder;

// A material with every one of some effects, and values that no short decimal holds.
Material random_material(Model model, Effects effects, std::mt19937& random) {
  Material material(model);
  material.set_effects(effects);
  for (const ParameterInfo& info : parameters_of(model)) {
    if (!effects.has(info.effect)) continue;
    std::uniform_real_distribution<double> value(info.lower, info.upper);
    for (int k = 0; k < info.components; ++k) {
      material.values()[static_cast<std::size_t>(info.offset + k)] = value(random);
    }
  }
  return material;
}

// Each model with no, each single, and all effects, and every option that it has.
std::vector<Material> many_materials() {
  std::mt19937 random(15);
  std::vector<Material> materials;
  for (const Model model : all_models()) {
    std::vector<Effects> sets = {Effects(), effects_of(model)};
    for (const Effect effect : all_effects()) {
      if (effects_of(model).has(effect)) sets.push_back(Effects().with(effect));
    }
    for (const Effects effects : sets) {
      materials.push_back(random_material(model, effects, random));
      Material other = random_material(model, effects, random);
      if (model == Model::kBurley) {
        other.options().burley_g = BurleyG::k2017;
      } else {
        other.options().masking = Masking::kCorrelated;
        other.options().diffuse = Diffuse::kProxima;
      }
      materials.push_back(other);
    }
  }
  return materials;
}

// A document that a test then spoils.
Json sound_document() {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(Effect::kRetroreflection));
  return material_to_json(material);
}

std::string complaint(const Json& json) {
  try {
    material_from_json(json, "m.json");
  } catch (const IoError& error) {
    EXPECT_EQ(error.side(), IoError::Side::kInput);
    return error.what();
  }
  return "no error";
}

TEST(MaterialJson, EveryMaterialSurvivesAFileBitForBit) {
  const TempFolder folder;
  const auto file = folder / "m.json";
  for (const Material& material : many_materials()) {
    write_material(file, material);
    const Material back = read_material(file);
    EXPECT_EQ(back, material);
    const std::string text = read_text(file);
    write_material(file, back);
    EXPECT_EQ(read_text(file), text);
  }
}

TEST(MaterialJson, EffectsAndValuesAloneComeBackBitForBitWithModelAndOptionsOfAnother) {
  for (const Material& material : many_materials()) {
    const Json json = Json::parse(effects_and_values_to_json(material).dump());
    EXPECT_EQ(json.size(), 2U);
    EXPECT_FALSE(json["parameters"].contains("base_color_srgb8"));
    Material like(material.model());
    like.options() = material.options();
    EXPECT_EQ(material_from_effects_and_values(like, json, "m.json"), material);
  }
}

TEST(MaterialJson, WrongEffectsAndValuesAloneAreRefused) {
  Material material(Model::kBurley);
  material.set_effects(Effects().with(Effect::kSheen));
  const Json sound = effects_and_values_to_json(material);
  for (const char* change : {R"({"extra": 1})", R"({"effects": null})", R"({"effects": []})",
                             R"({"effects": ["dual_specular"]})", R"({"parameters": null})",
                             R"({"parameters": {"roughness": 2}})", R"({"parameters": {"clearcoat": 1}})"}) {
    Json json = sound;
    json.merge_patch(Json::parse(change));
    EXPECT_THROW(material_from_effects_and_values(material, json, "m.json"), IoError) << change;
  }
}

TEST(MaterialJson, EvidenceIsWrittenAndIgnoredWhenRead) {
  const TempFolder folder;
  const Material material(Model::kBurley);
  write_material(folder / "m.json", material, {{"anything", {1, 2, 3}}});
  EXPECT_EQ(read_json(folder / "m.json")["fit"]["anything"][2], 3);
  EXPECT_EQ(read_material(folder / "m.json"), material);
  write_material(folder / "n.json", material);
  EXPECT_FALSE(read_json(folder / "n.json").contains("fit"));
}

TEST(MaterialJson, HasTheMembersOfTheFormat) {
  const Json json = sound_document();
  EXPECT_EQ(json["brdfit"], 1);
  EXPECT_EQ(json["model"], "callisto");
  EXPECT_EQ(json["effects"], Json({"retroreflection"}));
  EXPECT_EQ(json["options"], Json({{"masking", "separable"}, {"diffuse", "lambert"}}));
  EXPECT_EQ(json["parameters"]["base_color"], Json({0.18, 0.18, 0.18}));
  EXPECT_EQ(json["parameters"]["base_color_srgb8"], Json({118, 118, 118}));
  EXPECT_EQ(json["parameters"]["retroreflection_tint_srgb8"], Json({255, 255, 255}));
  EXPECT_EQ(material_to_json(Material(Model::kBurley))["options"], Json({{"burley_g", "2012"}}));
}

TEST(MaterialJson, HoldsTheParametersOfEffectsInUseAndNoOthers) {
  for (const Material& material : many_materials()) {
    std::set<std::string> expected;
    for (const ParameterInfo& info : parameters_of(material.model())) {
      if (!material.effects().has(info.effect)) continue;
      expected.insert(std::string(info.name));
      if (info.components == 3) expected.insert(std::string(info.name) + "_srgb8");
    }
    std::set<std::string> found;
    const Json json = material_to_json(material);
    for (const auto& [key, value] : json["parameters"].items()) found.insert(key);
    EXPECT_EQ(found, expected);
  }
}

TEST(MaterialJson, WithoutAListTheEffectsAreThoseInUse) {
  Json json = {
      {"brdfit", 1},
      {"model", "callisto"},
      {"parameters", {{"roughness", 0.25}, {"retroreflection", 2.0}, {"dual_specular_opacity", 0.0}}}};
  const Material material = material_from_json(json, "m.json");
  EXPECT_EQ(material.effects(), Effects().with(Effect::kRetroreflection));
  EXPECT_EQ(material.number("roughness"), 0.25);
  EXPECT_EQ(material.number("metallic"), 0.0);  // its default
  EXPECT_EQ(material.options(), MaterialOptions());
}

TEST(MaterialJson, WithoutAListWhatBelongsToEffectsThatAreOffIsAtItsDefault) {
  Material burley(Model::kBurley);
  Json json = material_to_json(burley);
  json.erase("effects");
  json["parameters"]["sheen"] = 0.5;
  json["parameters"]["clearcoat"] = 0.0;
  json["parameters"]["clearcoat_gloss"] = 0.75;
  const Material read = material_from_json(json, "x.json");
  EXPECT_EQ(read.number("sheen"), 0.5);
  EXPECT_EQ(read.number("clearcoat_gloss"), burley.number("clearcoat_gloss"));
  EXPECT_EQ(material_from_json(material_to_json(read), "x.json"), read);
}

TEST(MaterialJson, AMaterialInsideAnotherDocumentNamesItsPlace) {
  Json json = sound_document();
  json["parameters"]["roughness"] = 3;
  try {
    material_from_json(json, "recipe.json", "material");
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(),
                 "recipe.json: 'material.parameters.roughness' is 3 (expected a number in [0.01, 1])");
  }
}

TEST(MaterialJson, WrongVersionsModelsAndOptionsAreRefused) {
  Json json = sound_document();
  json["brdfit"] = 2;
  EXPECT_EQ(complaint(json), "m.json: 'brdfit' is 2 (expected an integer in [1, 1])");
  json.erase("brdfit");
  EXPECT_EQ(complaint(json), "m.json: 'brdfit' is missing (expected an integer in [1, 1])");
  json = sound_document();
  json["model"] = "phong";
  EXPECT_EQ(complaint(json), "m.json: 'model' is \"phong\" (expected one of lambert-ggx, burley, callisto)");
  json = sound_document();
  json["options"]["masking"] = "none";
  EXPECT_EQ(complaint(json),
            "m.json: 'options.masking' is \"none\" (expected \"separable\" or \"correlated\")");
  json = sound_document();
  json["options"]["burley_g"] = "2012";
  EXPECT_EQ(complaint(json), "m.json: 'options.burley_g' is unknown (expected only diffuse, masking)");
  EXPECT_EQ(complaint(Json::array()), "m.json: the document is an array (expected an object)");
}

TEST(MaterialJson, WrongEffectsAreRefused) {
  Json json = sound_document();
  json["effects"] = {"clearcoat"};
  EXPECT_THAT(complaint(json), HasSubstr("'effects' names \"clearcoat\" (expected effects of callisto: ["));
  json["effects"] = {"none"};
  EXPECT_THAT(complaint(json), HasSubstr("'effects' names \"none\" (expected effects of callisto: ["));
  json["effects"] = {"retroreflection", "retroreflection"};
  EXPECT_EQ(complaint(json), "m.json: 'effects' names \"retroreflection\" twice (expected each once)");
  json["effects"] = "all";
  EXPECT_EQ(complaint(json), "m.json: 'effects' is \"all\" (expected an array of strings)");
  json["effects"] = Json::array();
  EXPECT_EQ(
      complaint(json),
      "m.json: 'parameters.retroreflection' belongs to the effect retroreflection, which is off (expected "
      "\"retroreflection\" among the effects)");
}

TEST(MaterialJson, UnknownAndMissingMembersAreRefused) {
  Json json = sound_document();
  json["paramters"] = 1;
  EXPECT_THAT(complaint(json), HasSubstr("m.json: 'paramters' is unknown (expected only "));
  json = sound_document();
  json["parameters"]["rougness"] = 0.5;
  EXPECT_THAT(complaint(json), HasSubstr("m.json: 'parameters.rougness' is unknown (expected only "));
  json = sound_document();
  json["parameters"]["sheen"] = 0.5;  // another model's
  EXPECT_THAT(complaint(json), HasSubstr("m.json: 'parameters.sheen' is unknown (expected only "));
  json = sound_document();
  json.erase("parameters");
  EXPECT_EQ(complaint(json), "m.json: 'parameters' is missing (expected an object)");
  json = sound_document();
  json.erase("model");
  EXPECT_EQ(complaint(json), "m.json: 'model' is missing (expected a string)");
}

TEST(MaterialJson, ValuesOutOfRangeOrOfTheWrongTypeAreRefused) {
  const auto with = [](const char* name, const Json& value) {
    Json json = sound_document();
    json["parameters"][name] = value;
    return complaint(json);
  };
  EXPECT_EQ(with("roughness", 0.0), "m.json: 'parameters.roughness' is 0.0 (expected a number in [0.01, 1])");
  EXPECT_EQ(with("roughness", "0.5"),
            "m.json: 'parameters.roughness' is \"0.5\" (expected a number in [0.01, 1])");
  EXPECT_EQ(with("roughness", std::numeric_limits<double>::quiet_NaN()),
            "m.json: 'parameters.roughness' is null (expected a number in [0.01, 1])");
  EXPECT_EQ(with("base_color", {0.1, 1.5, 0.1}),
            "m.json: 'parameters.base_color' holds 1.5 (expected 3 numbers in [0, 1])");
  EXPECT_EQ(with("base_color", {0.1, "x", 0.1}),
            "m.json: 'parameters.base_color' holds \"x\" (expected 3 numbers in [0, 1])");
  EXPECT_EQ(with("base_color", {0.1, 0.1}),
            "m.json: 'parameters.base_color' has 2 items (expected 3 numbers in [0, 1])");
  EXPECT_EQ(with("base_color", 0.1),
            "m.json: 'parameters.base_color' is no array (expected 3 numbers in [0, 1])");
  EXPECT_EQ(with("base_color_srgb8", {1, 2}),
            "m.json: 'parameters.base_color_srgb8' is no sRGB triple (expected 3 integers in [0, 255])");
  EXPECT_EQ(with("base_color_srgb8", {1, 2, 256}),
            "m.json: 'parameters.base_color_srgb8' is no sRGB triple (expected 3 integers in [0, 255])");
}

TEST(MaterialJson, AnSrgbTripleDoesNotReplaceTheLinearColour) {
  Json json = sound_document();
  json["parameters"]["base_color_srgb8"] = {1, 2, 3};
  EXPECT_EQ(material_from_json(json, "m.json").colour("base_color"), (Rgb{0.18, 0.18, 0.18}));
  json["parameters"].erase("base_color");
  EXPECT_EQ(complaint(json),
            "m.json: 'parameters.base_color_srgb8' stands alone (expected the linear colour 'base_color' "
            "beside it)");
}

TEST(MaterialJson, AMaterialOutOfRangeIsNotWritten) {
  const TempFolder folder;
  Material material(Model::kLambertGgx);
  material.set("roughness", std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(write_material(folder / "m.json", material), std::invalid_argument);
  material.set("roughness", 1.5);
  EXPECT_THROW(write_material(folder / "m.json", material), std::invalid_argument);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Srgb8, EveryCodeSurvives) {
  for (int code = 0; code < 256; ++code) EXPECT_EQ(srgb8_from_linear(linear_from_srgb8(code)), code);
}

TEST(Srgb8, CodesAreThoseOfTheStandard) {
  EXPECT_EQ(srgb8_from_linear(0.0), 0);
  EXPECT_EQ(srgb8_from_linear(1.0), 255);
  EXPECT_EQ(srgb8_from_linear(0.18), 118);
  EXPECT_EQ(srgb8_from_linear(0.5), 188);
  EXPECT_NEAR(linear_from_srgb8(128), 0.215861, 1e-6);
  EXPECT_NEAR(linear_from_srgb8(5), 5.0 / 255.0 / 12.92, 1e-12);
}

TEST(Srgb8, WhatIsOutOfRangeIsRefused) {
  EXPECT_THROW(srgb8_from_linear(-1e-9), std::invalid_argument);
  EXPECT_THROW(srgb8_from_linear(1.001), std::invalid_argument);
  EXPECT_THROW(srgb8_from_linear(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(linear_from_srgb8(-1), std::invalid_argument);
  EXPECT_THROW(linear_from_srgb8(256), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::io
