// Materials of a folder, and the tables that they came from.
#include "cli/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/error.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

using Groups = std::map<std::pair<std::string, std::string>, ResultGroup>;  // by name and hash of the input

std::string text_of(const io::Json& json, const char* key) {
  const auto member = json.find(key);
  return member != json.end() && member->is_string() ? member->get<std::string>() : "";
}

io::Json object_of(const io::Json& json, const char* key) {
  const auto member = json.find(key);
  return member != json.end() && member->is_object() ? *member : io::Json::object();
}

std::vector<fs::path> json_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (at->is_regular_file() && at->path().extension() == ".json") files.push_back(at->path());
  }
  if (error) {
    throw io::IoError(io::IoError::Side::kInput, folder.string(), "cannot be read: " + error.message(),
                      "a folder that `brdfit fit` wrote to");
  }
  std::ranges::sort(files);
  return files;
}

// "blue-fabric" for blue-fabric.callisto.json when the evidence does not name the input.
std::string group_name(const FittedMaterial& fitted, const std::string& input_name) {
  if (!input_name.empty()) return fs::path(input_name).stem().string();
  const std::string stem = fitted.file.stem().string();
  const std::string ending = fmt::format(".{}", name_of(fitted.material.model()));
  return stem.ends_with(ending) ? stem.substr(0, stem.size() - ending.size()) : stem;
}

void read_one(const fs::path& file, Groups& groups) {
  const io::Json json = io::read_json(file);
  if (!json.is_object() || !json.contains("brdfit") || !json.contains("model")) return;
  FittedMaterial fitted = {file, io::material_from_json(json, file.string()), object_of(json, "fit")};
  const io::Json input = object_of(fitted.evidence, "input");
  const std::string input_name = text_of(input, "name");
  const std::string sha256 = text_of(input, "sha256");
  const std::string name = group_name(fitted, input_name);
  // Inputs of one name but of different contents are different materials.
  ResultGroup& group = groups[{name, sha256}];
  group.name = name;
  group.input_name = input_name;
  group.input_sha256 = sha256;
  group.fits.push_back(std::move(fitted));
}

bool is_that_table(const fs::path& file, const std::string& sha256) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  return sha256.empty() || io::sha256_of_file(file) == sha256;
}

}  // namespace

ResultFolder read_results(const fs::path& folder) {
  ResultFolder result;
  Groups groups;
  for (const fs::path& file : json_files(folder)) {
    try {
      read_one(file, groups);
    } catch (const io::IoError& error) {
      result.ignored.emplace_back(error.what());
    }
  }
  for (auto& [key, group] : groups) {
    std::ranges::stable_sort(group.fits, {}, [](const FittedMaterial& f) { return f.material.model(); });
    result.groups.push_back(std::move(group));
  }
  if (result.groups.empty()) {
    throw io::IoError(io::IoError::Side::kInput, folder.string(), "holds no material file",
                      "a folder that `brdfit fit` wrote to",
                      result.ignored.empty() ? "" : "the first that was refused: " + result.ignored.front());
  }
  return result;
}

std::optional<fs::path> find_measured(const ResultGroup& group, const std::vector<std::string>& given,
                                      std::string* why) {
  std::vector<fs::path> places;
  for (const std::string& place : given) {
    places.push_back(fs::is_directory(place) ? fs::path(place) / group.input_name : fs::path(place));
  }
  if (!group.input_name.empty()) {
    for (const FittedMaterial& fitted : group.fits) {
      const fs::path folder = fitted.file.parent_path();
      places.push_back(folder / group.input_name);
      const std::string relative = text_of(object_of(fitted.evidence, "input"), "path");
      if (!relative.empty()) places.push_back(folder / relative);
    }
  }
  for (const fs::path& place : places) {
    if (place.filename() == group.input_name && is_that_table(place, group.input_sha256)) return place;
  }
  *why = group.input_name.empty()
             ? "the material files do not say what they were fitted to; the measured table is not shown"
             : fmt::format(
                   "the measured table {} (SHA-256 {}...) was not found; give its folder with --measured",
                   group.input_name, group.input_sha256.substr(0, 12));
  return std::nullopt;
}

}  // namespace brdfit::cli
