// docs/schema/material.schema.json: says what the reader accepts and what the parameter tables hold.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "io/material_json.h"
#include "tests/json_schema.h"

namespace brdfit {
namespace {

using io::Json;

Json schema_json() {
  return io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema/material.schema.json");
}

const Json& parameters_in(const Json& schema, Model model) {
  return schema["$defs"][std::string(name_of(model)) + "_parameters"]["properties"];
}

Material random_material(Model model, std::mt19937& random) {
  Material material(model);
  for (const Effect effect : all_effects()) {
    if (effects_of(model).has(effect) && random() % 2 == 0) {
      material.set_effects(material.effects().with(effect));
    }
  }
  for (const ParameterInfo& info : parameters_of(model)) {
    if (!material.effects().has(info.effect)) continue;
    std::uniform_real_distribution<double> value(info.lower, info.upper);
    for (int k = 0; k < info.components; ++k) {
      material.values()[static_cast<std::size_t>(info.offset + k)] = value(random);
    }
  }
  return material;
}

bool is_read(const Json& json) {
  try {
    io::material_from_json(json, "m.json");
    return true;
  } catch (const io::IoError&) {
    return false;
  }
}

TEST(MaterialSchema, EveryMaterialThatIsWrittenIsValid) {
  const tests::JsonSchema schema(schema_json());
  std::mt19937 random(16);
  for (const Model model : all_models()) {
    for (int k = 0; k < 50; ++k) {
      EXPECT_EQ(schema.complaint(io::material_to_json(random_material(model, random))), "");
    }
  }
}

TEST(MaterialSchema, RefusesWhatTheReaderRefuses) {
  const tests::JsonSchema schema(schema_json());
  Material material(Model::kCallisto);
  material.set_effects(effects_of(Model::kCallisto));
  const Json sound = io::material_to_json(material);
  const Json changes = Json::parse(R"([
    {"brdfit": 2}, {"brdfit": null}, {"model": "phong"}, {"model": "burley"}, {"extra": 1}, {"fit": 3},
    {"effects": ["clearcoat"]}, {"effects": ["dual_specular", "dual_specular"]}, {"effects": "all"},
    {"options": {"burley_g": "2012"}}, {"options": {"masking": "none"}},
    {"parameters": {"roughness": 0}}, {"parameters": {"roughness": "0.5"}}, {"parameters": {"sheen": 0}},
    {"parameters": {"base_color": [0, 0]}}, {"parameters": {"base_color": [0, 0, 1.5]}},
    {"parameters": {"base_color": 0.5}}, {"parameters": {"base_color": null}},
    {"parameters": {"base_color_srgb8": [0, 0, 256]}}, {"parameters": {"base_color_srgb8": [0, 0, 0.5]}}
  ])");
  EXPECT_TRUE(is_read(sound));
  for (const Json& change : changes) {
    Json json = sound;
    json.merge_patch(change);  // null takes a member away
    EXPECT_FALSE(is_read(json)) << change;
    EXPECT_NE(schema.complaint(json), "") << change;
  }
  for (const char* member : {"brdfit", "model", "parameters"}) {
    Json json = sound;
    json.erase(member);
    EXPECT_FALSE(is_read(json)) << member;
    EXPECT_NE(schema.complaint(json), "") << member;
  }
}

TEST(MaterialSchema, RefusesParametersOfEffectsThatAreOffAsTheReaderDoes) {
  const tests::JsonSchema schema(schema_json());
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      if (info.effect == Effect::kNone) continue;
      Material material(model);
      material.set_effects(Effects().with(info.effect));
      Json json = io::material_to_json(material);
      ASSERT_EQ(schema.complaint(json), "") << info.name;
      json["effects"] = Json::array();
      EXPECT_FALSE(is_read(json)) << info.name;
      EXPECT_NE(schema.complaint(json), "") << info.name;
      json.erase("effects");  // then the parameters tell
      EXPECT_TRUE(is_read(json)) << info.name;
      EXPECT_EQ(schema.complaint(json), "") << info.name;
    }
  }
}

TEST(MaterialSchema, HoldsTheRangesAndDefaultsOfTheParameterTables) {
  const Json schema = schema_json();
  for (const Model model : all_models()) {
    const Json& members = parameters_in(schema, model);
    std::size_t expected_members = 0;
    for (const ParameterInfo& info : parameters_of(model)) {
      ASSERT_TRUE(members.contains(info.name)) << info.name;
      const Json& member = members[std::string(info.name)];
      const Json& range = info.components == 3 ? member["items"] : member;
      EXPECT_EQ(range["minimum"].get<double>(), info.lower) << info.name;
      EXPECT_EQ(range["maximum"].get<double>(), info.upper) << info.name;
      const Json& default_value = info.components == 3 ? member["default"][0] : member["default"];
      EXPECT_EQ(default_value.get<double>(), info.default_value) << info.name;
      expected_members += info.components == 3 ? 2 : 1;  // the sRGB triple
    }
    EXPECT_EQ(members.size(), expected_members) << name_of(model);
  }
}

}  // namespace
}  // namespace brdfit
