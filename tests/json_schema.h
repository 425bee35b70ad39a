// Validation of JSON against the part of JSON Schema (draft 2020-12) that the project's schemas use.
#ifndef BRDFIT_TESTS_JSON_SCHEMA_H_
#define BRDFIT_TESTS_JSON_SCHEMA_H_

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/json.h"

namespace brdfit::tests {

// A schema; a keyword that is not known here is an error, not a pass.
class JsonSchema {
 public:
  // others: the schemas that this one refers to, by the name of their file.
  explicit JsonSchema(io::Json schema, std::map<std::string, JsonSchema> others = {})
      : root_(std::move(schema)), others_(std::move(others)) {}

  // What the value breaks first, as "PLACE: KEYWORD"; empty if it is valid.
  std::string complaint(const io::Json& value) const { return check(root_, value, ""); }

 private:
  using Json = io::Json;

  std::string check(const Json& schema, const Json& value, const std::string& place) const {
    if (schema.is_boolean()) return schema.get<bool>() ? "" : place + ": not allowed";
    for (const auto& [keyword, rule] : schema.items()) {
      std::string found = check_keyword(schema, keyword, rule, value, place);
      if (!found.empty()) return found;
    }
    return "";
  }

  std::string check_keyword(const Json& schema, const std::string& keyword, const Json& rule,
                            const Json& value, const std::string& place) const {
    static const std::set<std::string> kNotes = {"$schema", "$defs", "title", "description",
                                                 "default", "then",  "else"};
    if (kNotes.contains(keyword)) return "";
    if (keyword == "$ref") return check_reference(rule.get<std::string>(), value, place);
    if (keyword == "if") {
      const char* branch = check(rule, value, place).empty() ? "then" : "else";
      return schema.contains(branch) ? check(schema[branch], value, place) : "";
    }
    if (keyword == "anyOf") return any_holds(rule, value) ? "" : place + ": anyOf";
    if (keyword == "contains") {
      const bool found = std::any_of(value.begin(), value.end(),
                                     [&](const Json& item) { return check(rule, item, place).empty(); });
      return found || !value.is_array() ? "" : place + ": contains";
    }
    if (keyword == "allOf") {
      for (const Json& part : rule) {
        if (std::string found = check(part, value, place); !found.empty()) return found;
      }
      return "";
    }
    if (keyword == "properties" || keyword == "items") return check_inside(keyword, rule, value, place);
    if (keyword == "additionalProperties") return check_others(schema, rule, value, place);
    if (keyword == "prefixItems") return check_first_items(rule, value, place);
    if (keyword == "propertyNames") return check_names(rule, value, place);
    return holds(keyword, rule, value) ? "" : place + ": " + keyword;
  }

  // "#/place/in/this/schema", the name of another schema's file, or both together.
  std::string check_reference(const std::string& reference, const Json& value,
                              const std::string& place) const {
    const std::size_t hash = std::min(reference.find('#'), reference.size());
    const JsonSchema& schema = hash == 0 ? *this : others_.at(reference.substr(0, hash));
    const std::string inside = hash == reference.size() ? "" : reference.substr(hash + 1);
    return schema.check(schema.root_.at(Json::json_pointer(inside)), value, place);
  }

  bool any_holds(const Json& schemas, const Json& value) const {
    return std::any_of(schemas.begin(), schemas.end(),
                       [&](const Json& schema) { return check(schema, value, "").empty(); });
  }

  std::string check_inside(const std::string& keyword, const Json& rule, const Json& value,
                           const std::string& place) const {
    const bool is_list = keyword == "items";
    if (is_list ? !value.is_array() : !value.is_object()) return "";
    for (const auto& [key, member] : value.items()) {
      if (!is_list && !rule.contains(key)) continue;
      std::string found = check(is_list ? rule : rule[key], member, place + "/" + key);
      if (!found.empty()) return found;
    }
    return "";
  }

  // Each item by the rule in its place.
  std::string check_first_items(const Json& rules, const Json& value, const std::string& place) const {
    if (!value.is_array()) return "";
    for (std::size_t k = 0; k < std::min(rules.size(), value.size()); ++k) {
      std::string found = check(rules[k], value[k], place + "/" + std::to_string(k));
      if (!found.empty()) return found;
    }
    return "";
  }

  // Members that "properties" does not name.
  std::string check_others(const Json& schema, const Json& rule, const Json& value,
                           const std::string& place) const {
    if (!value.is_object()) return "";
    for (const auto& [key, member] : value.items()) {
      if (schema.contains("properties") && schema["properties"].contains(key)) continue;
      if (rule == false) return place + ": additionalProperties";
      std::string found = check(rule, member, place + "/" + key);
      if (!found.empty()) return found;
    }
    return "";
  }

  std::string check_names(const Json& rule, const Json& value, const std::string& place) const {
    if (!value.is_object()) return "";
    for (const auto& [key, member] : value.items()) {
      std::string found = check(rule, key, place + "/" + key);
      if (!found.empty()) return found;
    }
    return "";
  }

  // The keywords that look at one value alone. Each passes for values of other types, as the standard says.
  static bool holds(const std::string& keyword, const Json& rule, const Json& value) {
    if (keyword == "type") return has_type(value, rule.get<std::string>());
    if (keyword == "const") return value == rule;
    if (keyword == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (keyword == "minimum") return !value.is_number() || value >= rule;
    if (keyword == "maximum") return !value.is_number() || value <= rule;
    if (keyword == "exclusiveMinimum") return !value.is_number() || value > rule;
    if (keyword == "exclusiveMaximum") return !value.is_number() || value < rule;
    if (keyword == "minLength") return !value.is_string() || length(value) >= rule.get<std::size_t>();
    if (keyword == "pattern") return !value.is_string() || matches(value, rule);
    if (keyword == "minProperties") return !value.is_object() || value.size() >= rule.get<std::size_t>();
    if (keyword == "minItems") return !value.is_array() || value.size() >= rule.get<std::size_t>();
    if (keyword == "maxItems") return !value.is_array() || value.size() <= rule.get<std::size_t>();
    if (keyword == "uniqueItems") return !value.is_array() || is_unique(value);
    if (keyword == "required") return !value.is_object() || has_all(value, rule);
    if (keyword == "dependentRequired") {
      if (!value.is_object()) return true;
      const auto items = rule.items();
      return std::all_of(items.begin(), items.end(), [&](const auto& item) {
        return !value.contains(item.key()) || has_all(value, item.value());
      });
    }
    throw std::logic_error("JsonSchema does not know the keyword " + keyword);
  }

  static bool has_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number_integer();
    if (type == "boolean") return value.is_boolean();
    throw std::logic_error("JsonSchema does not know the type " + type);
  }

  // In bytes, which for a bound of 1 says the same as in characters.
  static std::size_t length(const Json& text) { return text.get_ref<const std::string&>().size(); }

  static bool matches(const Json& text, const Json& pattern) {
    return std::regex_search(text.get_ref<const std::string&>(), std::regex(pattern.get<std::string>()));
  }

  static bool is_unique(const Json& list) {
    for (auto item = list.begin(); item != list.end(); ++item) {
      if (std::find(std::next(item), list.end(), *item) != list.end()) return false;
    }
    return true;
  }

  static bool has_all(const Json& object, const Json& keys) {
    return std::all_of(keys.begin(), keys.end(),
                       [&](const Json& key) { return object.contains(key.get_ref<const std::string&>()); });
  }

  Json root_;
  std::map<std::string, JsonSchema> others_;
};

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_JSON_SCHEMA_H_
