// Documents changed in one place, to find out what a schema leaves open.
#ifndef BRDFIT_TESTS_SCHEMA_TOOLS_H_
#define BRDFIT_TESTS_SCHEMA_TOOLS_H_

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/json_schema.h"

namespace brdfit::tests {

using io::Json;

// The places of all members of objects in a document, those in lists too.
inline void list_members(const Json& value, const Json::json_pointer& place,
                         std::vector<Json::json_pointer>& found) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    const Json::json_pointer at = value.is_array() ? place / std::stoul(key) : place / key;
    if (value.is_object()) found.push_back(at);
    list_members(member, at, found);
  }
}

inline std::vector<Json::json_pointer> members_of(const Json& document) {
  std::vector<Json::json_pointer> found;
  list_members(document, Json::json_pointer(), found);
  return found;
}

inline Json without(Json document, const Json::json_pointer& member) {
  document[member.parent_pointer()].erase(member.back());
  return document;
}

inline Json renamed(const Json& document, const Json::json_pointer& member) {
  Json result = without(document, member);
  result[member.parent_pointer() / (member.back() + "_")] = document[member];
  return result;
}

inline Json nulled(Json document, const Json::json_pointer& member) {
  document[member] = nullptr;
  return document;
}

inline Json with_sibling(Json document, const Json::json_pointer& member) {
  document[member.parent_pointer()]["extra"] = 1;
  return document;
}

// What says with null that there is none.
inline bool may_be_null(const Json::json_pointer& member) {
  return member.back() == "standard_error";
}

// No object of the document takes a member of another name, and no other member may be null. named_freely:
// the members whose own members have any name.
inline void expect_all_members_are_described(const JsonSchema& schema, const Json& document,
                                             const std::string& named_freely = "") {
  for (const Json::json_pointer& member : members_of(document)) {
    if (named_freely.empty() || member.parent_pointer().to_string() != named_freely) {
      EXPECT_NE(schema.complaint(renamed(document, member)), "") << member;
    }
    EXPECT_TRUE(may_be_null(member) || !schema.complaint(nulled(document, member)).empty()) << member;
    EXPECT_NE(schema.complaint(with_sibling(document, member)), "") << member;
  }
}

// No number of the document may be anything: -1000 is below the range of all.
inline void expect_all_numbers_are_bounded(const JsonSchema& schema, const Json& document) {
  const Json leaves = document.flatten();
  for (const auto& [place, leaf] : leaves.items()) {
    if (!leaf.is_number()) continue;
    Json json = document;
    json[Json::json_pointer(place)] = -1000;
    EXPECT_NE(schema.complaint(json), "") << place;
  }
}

// What complaint there is about a document when one place is set to a value.
inline std::string complaint_with(const JsonSchema& schema, Json document, const std::string& place,
                                  const Json& value) {
  document[Json::json_pointer(place)] = value;
  return schema.complaint(document);
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_SCHEMA_TOOLS_H_
