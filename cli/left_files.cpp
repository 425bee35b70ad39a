// Names out of the JSON, as far as they can be trusted.
#include "cli/left_files.h"

#include <algorithm>
#include <string>

#include "cli/asset_files.h"
#include "io/realis_json.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".realis.json";

std::string asset_name(const fs::path& json_file) {
  std::string name = json_file.filename().string();
  if (name.ends_with(kEnding)) name.resize(name.size() - kEnding.size());
  return name;
}

// Within the folder, and called after the asset: NAME.codes0.png, NAME.panels/LIGHT.png.
bool is_own(const fs::path& name, const std::string& asset) {
  return name.is_relative() &&
         std::ranges::none_of(name, [](const fs::path& part) { return part == ".."; }) &&
         name.begin()->string().starts_with(asset + ".");
}

std::vector<std::string> pictures_of(const io::Json& json) {
  std::vector<std::string> names;
  const auto add = [&](const io::Json& picture) {
    if (picture.is_object() && picture.contains("file") && picture["file"].is_string()) {
      names.push_back(picture["file"].get<std::string>());
    }
  };
  const io::Json* at = &json;
  for (const char* key : {"bake", "pictures"}) {
    if (!at->is_object() || !at->contains(key)) return names;
    at = &(*at)[key];
  }
  if (!at->is_object()) return names;
  if (at->contains("benefit")) add((*at)["benefit"]);
  if (at->contains("panels")) {
    for (const io::Json& panel : (*at)["panels"]) add(panel);
  }
  return names;
}

}  // namespace

std::vector<fs::path> files_named_by(const fs::path& json_file) {
  std::vector<fs::path> files;
  if (!fs::exists(json_file)) return files;
  try {
    const io::Json json = io::read_json(json_file);
    const std::string asset = asset_name(json_file);
    std::vector<std::string> names = pictures_of(json);
    for (const fs::path& file : asset_paths(io::realis_from_json(json, json_file.string()), fs::path())) {
      names.push_back(file.string());
    }
    for (const std::string& name : names) {
      if (!name.empty() && is_own(name, asset)) files.push_back(json_file.parent_path() / name);
    }
  } catch (const std::exception&) {
    // What cannot be read names nothing.
    files.clear();
  }
  return files;
}

void remove_left_files(const fs::path& json_file, const std::vector<fs::path>& before) {
  const std::vector<fs::path> now = files_named_by(json_file);
  std::error_code error;
  for (const fs::path& file : before) {
    if (std::ranges::find(now, file) == now.end()) fs::remove(file, error);
  }
  fs::remove(json_file.parent_path() / (asset_name(json_file) + ".panels"), error);
}

}  // namespace brdfit::cli
