// Looking into JSON that may lack anything: what is missing or of another type is nothing, not an error.
#ifndef BRDFIT_CLI_JSON_AT_H_
#define BRDFIT_CLI_JSON_AT_H_

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "io/json.h"

namespace brdfit::cli {

// A member below an object, by names; null where there is none.
const io::Json& at(const io::Json& json, std::initializer_list<const char*> path);

std::optional<double> number_at(const io::Json& json, std::initializer_list<const char*> path);

// A string as it is, any other value as JSON; empty where there is none.
std::string text_at(const io::Json& json, std::initializer_list<const char*> path);

// The strings of a list.
std::vector<std::string> texts_at(const io::Json& json, std::initializer_list<const char*> path);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_JSON_AT_H_
