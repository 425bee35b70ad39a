// Members that may be missing.
#include "cli/json_at.h"

namespace brdfit::cli {

using io::Json;

const Json& at(const Json& json, std::initializer_list<const char*> path) {
  static const Json kNull;
  const Json* value = &json;
  for (const char* key : path) {
    if (!value->is_object()) return kNull;
    const auto member = value->find(key);
    if (member == value->end()) return kNull;
    value = &*member;
  }
  return *value;
}

std::optional<double> number_at(const Json& json, std::initializer_list<const char*> path) {
  const Json& value = at(json, path);
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

std::string text_at(const Json& json, std::initializer_list<const char*> path) {
  const Json& value = at(json, path);
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? "" : value.dump();
}

std::vector<std::string> texts_at(const Json& json, std::initializer_list<const char*> path) {
  std::vector<std::string> texts;
  for (const Json& item : at(json, path)) {
    if (item.is_string()) texts.push_back(item.get<std::string>());
  }
  return texts;
}

}  // namespace brdfit::cli
