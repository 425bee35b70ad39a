// JSON as this project reads and writes it: key order kept, unknown keys refused, the place of an error
// named.
#ifndef BRDFIT_IO_JSON_H_
#define BRDFIT_IO_JSON_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"

namespace brdfit::io {

using Json = nlohmann::ordered_json;

// A file's JSON. Throws IoError (kInput) when it cannot be read, is no JSON (line and column named), has a
// key twice, or is larger than 64 MiB.
Json read_json(const std::filesystem::path& file);

// Writes indented by two spaces with a final newline, to a temporary that is then renamed. Numbers round-trip
// bit for bit; bytes in strings that are not UTF-8 become U+FFFD. Throws IoError (kOutput);
// std::invalid_argument for NaN or infinity in the value.
void write_json(const std::filesystem::path& file, const Json& value);

// Reads the members of one JSON object, so that what is missing, of the wrong type, out of range or unknown
// ends in an IoError that names the file and the member ("material.parameters.roughness").
class ObjectReader {
 public:
  // where: the object's own place in the file, empty for the root. Throws if value is not an object.
  ObjectReader(const Json& value, std::string file, std::string where = "");

  bool has(std::string_view key) const;
  // Each marks the key as known. The forms with a fallback return it where the key is absent.
  double number(std::string_view key, double lower, double upper);
  double number(std::string_view key, double lower, double upper, double fallback);
  long long integer(std::string_view key, long long lower, long long upper);
  long long integer(std::string_view key, long long lower, long long upper, long long fallback);
  std::string string(std::string_view key);
  std::string string(std::string_view key, std::string_view fallback);
  bool boolean(std::string_view key);
  bool boolean(std::string_view key, bool fallback);
  std::vector<std::string> strings(std::string_view key);  // an array of strings
  std::vector<double> numbers(std::string_view key);       // an array of numbers
  const Json& member(std::string_view key);                // anything
  ObjectReader object(std::string_view key);

  // Throws if the object holds a key that was never asked for.
  void finish() const;

  // Throws an IoError (kInput) about a member of this object: "'PLACE' FOUND (expected EXPECTED)", so found
  // begins with a verb.
  [[noreturn]] void fail(std::string_view key, const std::string& found, const std::string& expected) const;

  const std::string& file() const { return file_; }
  std::string place(std::string_view key) const;

 private:
  const Json* value_;
  std::string file_;
  std::string where_;
  std::vector<std::string> known_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_JSON_H_
