// Reading and writing JSON, with errors that name the place.
#include "io/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "io/atomic_file.h"
#include "io/input_file.h"

namespace brdfit::io {
namespace {

constexpr std::size_t kLargestFile = std::size_t{64} << 20;
constexpr int kDeepest = 64;

[[noreturn]] void fail_to_parse(const std::string& file, const std::string& found,
                                const std::string& expected, const std::string& advice = "") {
  throw IoError(IoError::Side::kInput, file, found, expected, advice);
}

// Watches a parse for what the parser itself lets through: keys given twice, nesting without end.
class ParseWatch {
 public:
  explicit ParseWatch(const std::string& file) : file_(file) {}

  void see(int depth, Json::parse_event_t event, const Json& value) {
    using Event = Json::parse_event_t;
    if (depth > kDeepest) {
      fail_to_parse(file_, fmt::format("nested more than {} levels deep", kDeepest), "a flatter document");
    }
    if (event == Event::object_start) objects_.push_back({place_, {}});
    if (event == Event::key) see_key(value.get_ref<const std::string&>());
    if (event == Event::object_end) {
      place_ = objects_.back().place;
      objects_.pop_back();
    }
  }

 private:
  struct Object {
    std::string place;
    std::vector<std::string> keys;  // sorted
  };

  void see_key(const std::string& key) {
    Object& object = objects_.back();
    place_ = object.place.empty() ? key : object.place + "." + key;
    const auto at = std::lower_bound(object.keys.begin(), object.keys.end(), key);
    if (at != object.keys.end() && *at == key) {
      fail_to_parse(file_, fmt::format("'{}' is there twice", place_), "every key once",
                    "remove one of them");
    }
    object.keys.insert(at, key);
  }

  const std::string& file_;
  std::string place_;
  std::vector<Object> objects_;
};

// The parser's message without its own tags, and fit for a terminal.
std::string readable(std::string message) {
  for (const std::string_view tag : {"] ", "parse error at "}) {
    const std::size_t at = message.find(tag);
    if (at != std::string::npos) message.erase(0, at + tag.size());
  }
  for (char& c : message) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  }
  return message;
}

void require_finite(const Json& value, const std::string& place) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw std::invalid_argument(fmt::format("write_json: '{}' is not finite", place));
  }
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    require_finite(member, place.empty() ? key : place + "." + key);
  }
}

std::string range_text(double lower, double upper) {
  return fmt::format("[{}, {}]", lower, upper);
}

// What a value is, for messages: scalars in full, the rest by its type.
std::string describe(const Json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_structured()) return fmt::format("is an {}", value.type_name());
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return fmt::format("is {}", text);
}

}  // namespace

Json read_json(const std::filesystem::path& file) {
  const InputFile input(file, "a JSON file");
  if (input.size() > kLargestFile) {
    fail_to_parse(input.name(), fmt::format("{} bytes", input.size()),
                  fmt::format("at most {} bytes of JSON", kLargestFile), "is this the right file?");
  }
  std::string text(input.size(), '\0');
  input.read_at(0, std::as_writable_bytes(std::span(text)));

  ParseWatch watch(input.name());
  const auto callback = [&watch](int depth, Json::parse_event_t event, const Json& value) {
    watch.see(depth, event, value);
    return true;
  };
  try {
    return Json::parse(text, callback);
  } catch (const Json::exception& error) {
    fail_to_parse(input.name(), "no JSON: " + readable(error.what()), "a JSON document");
  }
}

void write_json(const std::filesystem::path& file, const Json& value) {
  require_finite(value, "");
  AtomicFile output(file);
  output.write(value.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  output.commit();
}

ObjectReader::ObjectReader(const Json& value, std::string file, std::string where)
    : value_(&value), file_(std::move(file)), where_(std::move(where)) {
  if (value.is_object()) return;
  const std::string name = where_.empty() ? "the document" : "'" + where_ + "'";
  fail_to_parse(file_, fmt::format("{} {}", name, describe(value)), "an object");
}

bool ObjectReader::has(std::string_view key) const {
  return value_->contains(key);
}

double ObjectReader::number(std::string_view key, double lower, double upper) {
  const std::string expected = "a number in " + range_text(lower, upper);
  if (!has(key)) fail(key, "is missing", expected);
  const Json& value = member(key);
  if (!value.is_number()) fail(key, describe(value), expected);
  const double number = value.get<double>();
  if (!(number >= lower && number <= upper)) fail(key, describe(value), expected);
  return number;
}

double ObjectReader::number(std::string_view key, double lower, double upper, double fallback) {
  known_.emplace_back(key);
  return has(key) ? number(key, lower, upper) : fallback;
}

long long ObjectReader::integer(std::string_view key, long long lower, long long upper) {
  const std::string expected = fmt::format("an integer in [{}, {}]", lower, upper);
  if (!has(key)) fail(key, "is missing", expected);
  const Json& value = member(key);
  const bool is_too_large = value.is_number_unsigned() &&
                            value.get<unsigned long long>() >
                                static_cast<unsigned long long>(std::numeric_limits<long long>::max());
  if (!value.is_number_integer() || is_too_large) fail(key, describe(value), expected);
  const auto number = value.get<long long>();
  if (number < lower || number > upper) fail(key, describe(value), expected);
  return number;
}

long long ObjectReader::integer(std::string_view key, long long lower, long long upper, long long fallback) {
  known_.emplace_back(key);
  return has(key) ? integer(key, lower, upper) : fallback;
}

std::string ObjectReader::string(std::string_view key) {
  if (!has(key)) fail(key, "is missing", "a string");
  const Json& value = member(key);
  if (!value.is_string()) fail(key, describe(value), "a string");
  return value.get<std::string>();
}

std::string ObjectReader::string(std::string_view key, std::string_view fallback) {
  known_.emplace_back(key);
  return has(key) ? string(key) : std::string(fallback);
}

bool ObjectReader::boolean(std::string_view key) {
  if (!has(key)) fail(key, "is missing", "true or false");
  const Json& value = member(key);
  if (!value.is_boolean()) fail(key, describe(value), "true or false");
  return value.get<bool>();
}

bool ObjectReader::boolean(std::string_view key, bool fallback) {
  known_.emplace_back(key);
  return has(key) ? boolean(key) : fallback;
}

std::vector<std::string> ObjectReader::strings(std::string_view key) {
  if (!has(key)) fail(key, "is missing", "an array of strings");
  const Json& value = member(key);
  const bool is_fit = value.is_array() && std::all_of(value.begin(), value.end(),
                                                      [](const Json& item) { return item.is_string(); });
  if (!is_fit)
    fail(key, value.is_array() ? "holds more than strings" : describe(value), "an array of strings");
  return value.get<std::vector<std::string>>();
}

std::vector<double> ObjectReader::numbers(std::string_view key) {
  if (!has(key)) fail(key, "is missing", "an array of numbers");
  const Json& value = member(key);
  const bool is_fit = value.is_array() && std::all_of(value.begin(), value.end(),
                                                      [](const Json& item) { return item.is_number(); });
  if (!is_fit)
    fail(key, value.is_array() ? "holds more than numbers" : describe(value), "an array of numbers");
  return value.get<std::vector<double>>();
}

const Json& ObjectReader::member(std::string_view key) {
  known_.emplace_back(key);
  const auto found = value_->find(key);
  if (found == value_->end()) fail(key, "is missing", "a value");
  return *found;
}

ObjectReader ObjectReader::object(std::string_view key) {
  if (!has(key)) fail(key, "is missing", "an object");
  return ObjectReader(member(key), file_, place(key));
}

void ObjectReader::finish() const {
  for (const auto& [key, member] : value_->items()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::vector<std::string> names = known_;
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    fail(key, "is unknown", fmt::format("only {}", fmt::join(names, ", ")));
  }
}

void ObjectReader::fail(std::string_view key, const std::string& found, const std::string& expected) const {
  throw IoError(IoError::Side::kInput, file_, fmt::format("'{}' {}", place(key), found), expected);
}

std::string ObjectReader::place(std::string_view key) const {
  return where_.empty() ? std::string(key) : where_ + "." + std::string(key);
}

}  // namespace brdfit::io
