// Members of an asset's JSON, both ways.
#include "io/realis_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "io/material_json.h"

namespace brdfit::io {
namespace {

constexpr int kVersion = 2;
constexpr int kMaxEdge = 1 << 20;
constexpr std::string_view kFrame = "x right, y up, z towards the viewer";
constexpr std::string_view kLambert = "lambert";

// Members of "files" that hold one name.
constexpr std::array<std::pair<std::string_view, std::string RealisFiles::*>, 7> kFiles{{
    {"amplitudes", &RealisFiles::amplitudes},
    {"dominant", &RealisFiles::dominant},
    {"chroma", &RealisFiles::chroma},
    {"surface", &RealisFiles::surface},
    {"albedo", &RealisFiles::albedo},
    {"normals", &RealisFiles::normals},
    {"confidence", &RealisFiles::confidence},
}};

Vec3 read_vector(ObjectReader& reader, std::string_view key) {
  const std::vector<double> numbers = reader.numbers(key);
  if (numbers.size() != 3) reader.fail(key, fmt::format("has {} numbers", numbers.size()), "3");
  return {numbers[0], numbers[1], numbers[2]};
}

LobeSet read_lobes(ObjectReader& reader, const std::string& file) {
  const Json& list = reader.member("lobes");
  if (!list.is_array()) reader.fail("lobes", fmt::format("is {}", list.type_name()), "a list of lobes");
  LobeSet lobes;
  for (std::size_t k = 0; k < list.size(); ++k) {
    ObjectReader one(list[k], file, fmt::format("{}[{}]", reader.place("lobes"), k));
    Lobe lobe;
    lobe.axis = read_vector(one, "axis");
    lobe.sharpness = one.number("sharpness", 0.0, kLargestSharpness);
    lobe.cos_cut_off = one.number("cos_cut_off", -1.0, 1.0);
    one.finish();
    lobes.push_back(lobe);
  }
  return lobes;
}

Json files_json(const RealisFiles& files) {
  Json json = Json::object();
  for (const auto& [name, member] : kFiles) {
    if (!(files.*member).empty()) json[std::string(name)] = files.*member;
  }
  if (!files.packed.empty()) json["packed"] = files.packed;
  return json;
}

RealisFiles read_files(ObjectReader reader) {
  RealisFiles files;
  for (const auto& [name, member] : kFiles) files.*member = reader.string(name, "");
  if (reader.has("packed")) files.packed = reader.strings("packed");
  reader.finish();
  return files;
}

RealisPacking read_packing(ObjectReader reader) {
  RealisPacking packing;
  packing.bits = static_cast<int>(reader.integer("bits", 4, 8));
  packing.dominant = static_cast<int>(reader.integer("dominant", 0, 64));
  const std::vector<double> steps = reader.numbers("step");
  const std::vector<double> zeros = reader.numbers("zero");
  if (zeros.size() != steps.size()) {
    reader.fail("zero", fmt::format("has {} numbers", zeros.size()), fmt::format("{}", steps.size()));
  }
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const bool whole = zeros[k] >= 0.0 && zeros[k] <= realis_top_code(packing.bits);
    if (!whole || std::floor(zeros[k]) != zeros[k]) {
      reader.fail("zero", fmt::format("has {}", zeros[k]),
                  fmt::format("whole numbers from 0 to {}", realis_top_code(packing.bits)));
    }
    packing.ranges.push_back({steps[k], static_cast<int>(zeros[k])});
  }
  reader.number("bytes_per_texel", 0.0, 1e6);
  reader.finish();
  return packing;
}

RealisFade read_fade(ObjectReader reader) {
  RealisFade fade;
  fade.albedo_range = reader.number("albedo_range", 0.0, 1e6);
  fade.normal_range_deg = reader.number("normal_range_deg", 0.0, 180.0);
  reader.finish();
  return fade;
}

std::optional<Material> read_base(ObjectReader& reader, const std::string& file) {
  const Json& value = reader.member("base");
  if (value.is_string() && value.get<std::string>() == kLambert) return std::nullopt;
  return material_from_json(value, file, reader.place("base"));
}

}  // namespace

Json vector_to_json(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json lobes_to_json(const LobeSet& lobes) {
  Json json = Json::array();
  for (const Lobe& lobe : lobes) {
    json.push_back({{"axis", vector_to_json(lobe.axis)},
                    {"sharpness", lobe.sharpness},
                    {"cos_cut_off", lobe.cos_cut_off}});
  }
  return json;
}

Json realis_to_json(const RealisAsset& asset) {
  std::string why;
  if (!asset.is_valid(&why)) throw std::invalid_argument("Realis asset: " + why);
  Json json;
  json["brdfit_realis"] = kVersion;
  json["name"] = asset.name;
  json["width"] = asset.width;
  json["height"] = asset.height;
  json["colour"] = name_of(asset.colour);
  json["albedo_in_modulation"] = asset.albedo_in_modulation;
  json["frame"] = kFrame;
  json["view"] = vector_to_json(asset.view);
  json["lobes"] = lobes_to_json(asset.lobes);
  if (asset.penalty) json["penalty"] = *asset.penalty;
  json["base"] = asset.base ? material_to_json(*asset.base) : Json(kLambert);
  std::vector<double> steps;
  std::vector<int> zeros;
  for (const RealisRange& range : asset.packing.ranges) {
    steps.push_back(range.step);
    zeros.push_back(range.zero);
  }
  json["packing"] = {{"bits", asset.packing.bits},
                     {"dominant", asset.packing.dominant},
                     {"step", steps},
                     {"zero", zeros},
                     {"bytes_per_texel", asset.bytes_per_texel()}};
  json["fade"] = {{"albedo_range", asset.fade.albedo_range},
                  {"normal_range_deg", asset.fade.normal_range_deg}};
  json["files"] = files_json(asset.files);
  return json;
}

RealisAsset realis_from_json(const Json& json, const std::string& file) {
  ObjectReader reader(json, file);
  reader.integer("brdfit_realis", kVersion, kVersion);
  RealisAsset asset;
  asset.name = reader.string("name");
  asset.width = static_cast<int>(reader.integer("width", 1, kMaxEdge));
  asset.height = static_cast<int>(reader.integer("height", 1, kMaxEdge));
  const std::string colour = reader.string("colour");
  const std::optional<RealisColour> known = realis_colour_by_name(colour);
  if (!known) {
    reader.fail("colour", fmt::format("is \"{}\"", colour), "\"luminance\", \"scaled-chroma\" or \"rgb\"");
  }
  asset.colour = *known;
  asset.albedo_in_modulation = reader.boolean("albedo_in_modulation");
  if (const std::string frame = reader.string("frame"); frame != kFrame) {
    reader.fail("frame", fmt::format("is \"{}\"", frame), fmt::format("\"{}\"", kFrame));
  }
  asset.view = read_vector(reader, "view");
  asset.lobes = read_lobes(reader, file);
  if (reader.has("penalty")) {
    asset.penalty = reader.number("penalty", 0.0, std::numeric_limits<double>::max());
  }
  asset.base = read_base(reader, file);
  asset.packing = read_packing(reader.object("packing"));
  asset.fade = read_fade(reader.object("fade"));
  asset.files = read_files(reader.object("files"));
  if (reader.has("bake")) reader.member("bake");
  reader.finish();
  std::string why;
  if (!asset.is_valid(&why)) throw IoError(IoError::Side::kInput, file, why, "an asset whose parts agree");
  return asset;
}

RealisAsset read_realis(const std::filesystem::path& file) {
  return realis_from_json(read_json(file), file.string());
}

void write_realis(const std::filesystem::path& file, const RealisAsset& asset, const Json& evidence) {
  Json json = realis_to_json(asset);
  if (!evidence.is_null()) json["bake"] = evidence;
  write_json(file, json);
}

}  // namespace brdfit::io
