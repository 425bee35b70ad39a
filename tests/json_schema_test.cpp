// The validator that other tests trust: every keyword refuses something, and none is passed over unknown.
#include "tests/json_schema.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace brdfit::tests {
namespace {

using io::Json;

// A schema, values that it allows and values that it refuses.
struct Rule {
  const char* schema;
  const char* allowed;
  const char* refused;
};

TEST(JsonSchema, EveryKeywordAllowsAndRefusesWhatTheStandardSays) {
  const Rule rules[] = {
      {R"(false)", R"([])", R"([1, {}])"},
      {R"({"type": "integer"})", R"([1, -1])", R"([1.5, "1", true, null])"},
      {R"({"type": "number"})", R"([1, 1.5])", R"(["1", null])"},
      {R"({"const": 1})", R"([1])", R"([2, "1"])"},
      {R"({"enum": ["a", "b"]})", R"(["a", "b"])", R"(["c", 1])"},
      {R"({"minimum": 0})", R"([0, "x"])", R"([-1, -0.5])"},
      {R"({"maximum": 18446744073709551615})", R"([0, 18446744073709551615])", R"([36893488147419103232])"},
      {R"({"exclusiveMinimum": 0})", R"([0.1, "x"])", R"([0, -1])"},
      {R"({"exclusiveMaximum": 180})", R"([179.9, "x"])", R"([180])"},
      {R"({"minLength": 1})", R"(["x", 1])", R"([""])"},
      {R"({"pattern": "^[0-9]+$"})", R"(["12", 1])", R"(["", "1x"])"},
      {R"({"minProperties": 1})", R"([{"a": 1}, 1])", R"([{}])"},
      {R"({"minItems": 1, "maxItems": 2})", R"([[1], [1, 1], 1])", R"([[], [1, 1, 1]])"},
      {R"({"uniqueItems": true})", R"([[1, 2], 1])", R"([[1, 2, 1]])"},
      {R"({"prefixItems": [{"const": 1}, {"const": 2}]})", R"([[], [1], [1, 2], [1, 2, 3], 2])",
       R"([[2], [1, 3]])"},
      {R"({"items": {"const": 1}})", R"([[], [1, 1], 2])", R"([[1, 2]])"},
      {R"({"contains": {"const": 1}})", R"([[2, 1], 2, {"a": 2}])", R"([[], [2]])"},
      {R"({"anyOf": [{"const": 1}, {"const": 2}]})", R"([1, 2])", R"([3])"},
      {R"({"allOf": [{"minimum": 1}, {"maximum": 2}]})", R"([1, 2])", R"([0, 3])"},
      {R"({"required": ["a"]})", R"([{"a": 1}, 1])", R"([{}, {"b": 1}])"},
      {R"({"properties": {"a": false, "b": {"const": 1}}})", R"([{}, {"b": 1, "c": 1}])",
       R"([{"a": 1}, {"b": 2}])"},
      {R"({"additionalProperties": false, "properties": {"a": {}}})", R"([{}, {"a": 1}])", R"([{"b": 1}])"},
      {R"({"additionalProperties": {"const": 1}, "properties": {"a": {}}})", R"([{"a": 2, "b": 1}, 2])",
       R"([{"b": 2}])"},
      {R"({"additionalProperties": false})", R"([{}, 1])", R"([{"b": 1}])"},
      {R"({"propertyNames": {"pattern": "^a"}})", R"([{}, {"a": 1, "ab": 2}, "b"])", R"([{"b": 1}])"},
      {R"({"dependentRequired": {"a": ["b"]}})", R"([{}, {"b": 1}, {"a": 1, "b": 1}])", R"([{"a": 1}])"},
      {R"({"if": {"minimum": 1}, "then": {"maximum": 2}, "else": {"maximum": -1}})", R"([-1, 1, 2])",
       R"([0, 3])"},
      {R"({"$defs": {"one": {"const": 1}}, "$ref": "#/$defs/one"})", R"([1])", R"([2])"},
  };
  for (const Rule& rule : rules) {
    const JsonSchema schema(Json::parse(rule.schema));
    for (const Json& value : Json::parse(rule.allowed)) {
      EXPECT_EQ(schema.complaint(value), "") << rule.schema << value;
    }
    for (const Json& value : Json::parse(rule.refused)) {
      EXPECT_NE(schema.complaint(value), "") << rule.schema << value;
    }
  }
}

TEST(JsonSchema, ReferencesInsideAnotherFileAreToThatFile) {
  const JsonSchema other(Json::parse(R"({"$defs": {"it": {"const": 1}}, "$ref": "#/$defs/it"})"));
  const JsonSchema schema(
      Json::parse(R"({"$defs": {"it": {"const": 2}}, "properties": {"a": {"$ref": "other.json"}}})"),
      {{"other.json", other}});
  EXPECT_EQ(schema.complaint({{"a", 1}}), "");
  EXPECT_EQ(schema.complaint({{"a", 2}}), "/a: const");
}

TEST(JsonSchema, ReferencesMayBeToAPlaceInAnotherFile) {
  const JsonSchema other(Json::parse(R"({"$defs": {"it": {"const": 1}, "that": {"$ref": "#/$defs/it"}}})"));
  const JsonSchema schema(Json::parse(R"({"$defs": {"it": {"const": 2}}, "$ref": "other.json#/$defs/that"})"),
                          {{"other.json", other}});
  EXPECT_EQ(schema.complaint(1), "");
  EXPECT_EQ(schema.complaint(2), ": const");
}

TEST(JsonSchema, WhatItDoesNotKnowIsAnErrorNotAPass) {
  EXPECT_THROW(JsonSchema(Json::parse(R"({"multipleOf": 2})")).complaint(4), std::logic_error);
  EXPECT_THROW(JsonSchema(Json::parse(R"({"type": "null"})")).complaint(nullptr), std::logic_error);
  EXPECT_THROW(JsonSchema(Json::parse(R"({"patternProperties": {}})")).complaint(Json::object()),
               std::logic_error);
  EXPECT_THROW(JsonSchema(Json::parse(R"({"$ref": "absent.json"})")).complaint(1), std::exception);
}

}  // namespace
}  // namespace brdfit::tests
