// Recipes of stacks: their ranges, and reading and writing them as JSON.
#include "data/synthetic/stack_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "data/synthetic/recipe_reader.h"
#include "io/material_json.h"

namespace brdfit::synthetic {
namespace {

constexpr int kVersion = 1;
constexpr int kMaxEdge = 16384;
constexpr int kMaxLights = 10000;
constexpr int kMaxLobes = 32;
constexpr int kMaxHotPixels = 1000000;
constexpr double kMaxIntensity = 1e6;
constexpr double kSmallest = 1e-6;  // of what may not be 0

constexpr std::array<std::string_view, 3> kReliefs{"plane", "sphere", "bumps"};
constexpr std::array<std::string_view, 4> kSubsamplings{"4:4:4", "4:2:2", "4:2:0", "4:1:1"};
constexpr std::array<std::string_view, 3> kArrangements{"dome", "ring", "sparse"};

// The place of a member's value among the names it may have.
template <std::size_t N>
int choice(io::ObjectReader& reader, std::string_view key, const std::array<std::string_view, N>& names,
           int fallback) {
  const std::string found = reader.string(key, names[static_cast<std::size_t>(fallback)]);
  for (std::size_t k = 0; k < N; ++k) {
    if (found == names[k]) return static_cast<int>(k);
  }
  reader.fail(key, fmt::format("is \"{}\"", found), fmt::format("one of \"{}\"", fmt::join(names, "\", \"")));
}

ShapeRecipe read_shape(io::ObjectReader reader) {
  ShapeRecipe shape;
  shape.relief = static_cast<Relief>(choice(reader, "relief", kReliefs, static_cast<int>(shape.relief)));
  shape.slope = reader.number("slope", 0.0, 10.0, shape.slope);
  shape.wavelength_px = reader.number("wavelength_px", 4.0, 4096.0, shape.wavelength_px);
  reader.finish();
  return shape;
}

LightsRecipe read_lights(io::ObjectReader reader) {
  LightsRecipe lights;
  lights.arrangement = static_cast<Arrangement>(
      choice(reader, "arrangement", kArrangements, static_cast<int>(lights.arrangement)));
  lights.count = static_cast<int>(reader.integer("count", 1, kMaxLights, lights.count));
  lights.theta_deg = reader.number("theta_deg", 0.0, 90.0, lights.theta_deg);
  lights.intensity = reader.number("intensity", kSmallest, kMaxIntensity, lights.intensity);
  lights.distance = reader.number("distance", 0.0, kMaxIntensity, lights.distance);
  reader.finish();
  return lights;
}

ResidualRecipe read_residual(io::ObjectReader reader) {
  ResidualRecipe residual;
  residual.lobes = static_cast<int>(reader.integer("lobes", 0, kMaxLobes, residual.lobes));
  residual.sharpness = reader.number("sharpness", 0.0, kMaxIntensity, residual.sharpness);
  residual.cut_off_deg = reader.number("cut_off_deg", kSmallest, 180.0, residual.cut_off_deg);
  residual.strength = reader.number("strength", 0.0, 1000.0, residual.strength);
  reader.finish();
  return residual;
}

// An array of pairs of numbers, the first (and where `whole` both) a light's number.
std::vector<std::pair<int, double>> read_pairs(io::ObjectReader& reader, std::string_view key, bool whole) {
  std::vector<std::pair<int, double>> pairs;
  if (!reader.has(key)) return pairs;
  const io::Json& value = reader.member(key);
  const std::string expected = whole ? "pairs of light numbers" : "pairs of a light number and a factor";
  const auto is_light = [](const io::Json& number) {
    return number.is_number_integer() && number.get<std::int64_t>() >= 0 &&
           number.get<std::int64_t>() < kMaxLights;
  };
  if (!value.is_array()) reader.fail(key, fmt::format("is {}", value.type_name()), expected);
  for (const io::Json& pair : value) {
    const bool good = pair.is_array() && pair.size() == 2 && is_light(pair[0]) &&
                      (whole ? is_light(pair[1]) : pair[1].is_number());
    if (!good) reader.fail(key, fmt::format("holds {}", pair.dump()), expected);
    pairs.emplace_back(pair[0].get<int>(), pair[1].get<double>());
  }
  return pairs;
}

StackFaults read_faults(io::ObjectReader reader) {
  StackFaults faults;
  faults.gains = read_pairs(reader, "gains", false);
  for (const auto& [first, second] : read_pairs(reader, "swapped", true)) {
    faults.swapped.emplace_back(first, static_cast<int>(second));
  }
  faults.upside_down = reader.boolean("upside_down", faults.upside_down);
  faults.hot_pixels = static_cast<int>(reader.integer("hot_pixels", 0, kMaxHotPixels, faults.hot_pixels));
  reader.finish();
  return faults;
}

StackFiles read_files(io::ObjectReader reader) {
  StackFiles files;
  files.format = reader.string("format", files.format);
  files.transfer = reader.string("transfer", files.transfer);
  files.jpeg_quality = static_cast<int>(reader.integer("jpeg_quality", 1, 100, files.jpeg_quality));
  files.jpeg_subsampling = reader.string("jpeg_subsampling", files.jpeg_subsampling);
  files.manifest = reader.string("manifest", files.manifest);
  files.give_normals = reader.boolean("give_normals", files.give_normals);
  files.give_albedo = reader.boolean("give_albedo", files.give_albedo);
  reader.finish();
  return files;
}

std::vector<Material> read_materials(io::ObjectReader& reader, const std::string& file) {
  const io::Json& list = reader.member("materials");
  if (!list.is_array() || list.empty())
    reader.fail("materials", "is no list with an entry", "at least one material");
  std::vector<Material> materials;
  for (std::size_t k = 0; k < list.size(); ++k) {
    materials.push_back(
        io::material_from_json(list[k], file, fmt::format("{}[{}]", reader.place("materials"), k)));
  }
  return materials;
}

// Whether f is affine in the base colour.
bool is_affine_in_base_colour(const Material& material) {
  return material.model() != Model::kBurley && material.number("metallic") == 0.0;
}

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// The first complaint about what the parts of a recipe demand of each other.
std::string complaint_of(const StackRecipe& recipe) {
  const auto is_light = [&](int light) { return light >= 0 && light < recipe.lights.count; };
  for (const auto& [light, factor] : recipe.faults.gains) {
    if (!is_light(light)) return fmt::format("faults.gains names light {} of {}", light, recipe.lights.count);
    if (!(factor > 0.0 && factor <= 100.0))
      return fmt::format("faults.gains has factor {}, not in (0, 100]", factor);
  }
  for (const auto& [first, second] : recipe.faults.swapped) {
    if (!is_light(first) || !is_light(second)) {
      return fmt::format("faults.swapped names lights {} and {} of {}", first, second, recipe.lights.count);
    }
  }
  for (const Material& material : recipe.materials) {
    std::string why;
    if (!material.is_valid(&why)) return "materials: " + why;
    if (recipe.albedo_variation > 0.0 && !is_affine_in_base_colour(material)) {
      return "albedo_variation needs materials without metallic that are not Burley";
    }
  }
  const std::string& format = recipe.files.format;
  if (format.empty() || !std::all_of(format.begin(), format.end(), is_letter_or_digit)) {
    return fmt::format("files.format is \"{}\", no ending of a file", format);
  }
  if (recipe.files.transfer != "linear" && recipe.files.transfer != "srgb") {
    return fmt::format("files.transfer is \"{}\", not linear or srgb", recipe.files.transfer);
  }
  const std::string& colours = recipe.files.jpeg_subsampling;
  if (std::ranges::find(kSubsamplings, colours) == std::end(kSubsamplings)) {
    return fmt::format("files.jpeg_subsampling is \"{}\", not {}", colours, fmt::join(kSubsamplings, ", "));
  }
  if (recipe.files.jpeg_quality < 1 || recipe.files.jpeg_quality > 100) {
    return fmt::format("files.jpeg_quality is {}, not in [1, 100]", recipe.files.jpeg_quality);
  }
  if (recipe.files.manifest != "json" && recipe.files.manifest != "lp") {
    return fmt::format("files.manifest is \"{}\", not json or lp", recipe.files.manifest);
  }
  if (recipe.files.manifest == "lp" && recipe.lights.distance > 0.0)
    return "files.manifest lp cannot hold near lights";
  if (recipe.name.empty() || recipe.name.find('/') != std::string::npos) return "name is empty or a path";
  if (recipe.materials.empty()) return "materials is empty";
  return "";
}

bool in(double value, double lower, double upper) {
  return value >= lower && value <= upper;
}

bool ranges_hold(const StackRecipe& r) {
  return in(r.width, 1, kMaxEdge) && in(r.height, 1, kMaxEdge) && in(r.shape.slope, 0.0, 10.0) &&
         in(r.shape.wavelength_px, 4.0, 4096.0) && in(r.patch_px, 0, kMaxEdge) &&
         in(r.albedo_variation, 0.0, 1.0) && in(r.lights.count, 1, kMaxLights) &&
         in(r.lights.theta_deg, 0.0, 90.0) && in(r.lights.intensity, kSmallest, kMaxIntensity) &&
         in(r.lights.distance, 0.0, kMaxIntensity) && in(r.residual.lobes, 0, kMaxLobes) &&
         in(r.residual.sharpness, 0.0, kMaxIntensity) && in(r.residual.cut_off_deg, kSmallest, 180.0) &&
         in(r.residual.strength, 0.0, 1000.0) && in(r.noise.multiplicative, 0.0, kMaxMultiplicativeNoise) &&
         in(r.noise.additive, 0.0, kMaxAdditiveNoise) && in(r.faults.hot_pixels, 0, kMaxHotPixels);
}

}  // namespace

bool StackRecipe::is_valid(std::string* why) const {
  std::string complaint = ranges_hold(*this) ? complaint_of(*this) : "a number is outside its range";
  if (complaint.empty()) return true;
  if (why != nullptr) *why = std::move(complaint);
  return false;
}

io::Json stack_recipe_to_json(const StackRecipe& recipe) {
  io::Json json;
  json["brdfit_stack_recipe"] = kVersion;
  json["name"] = recipe.name;
  json["source"] = recipe.source;
  json["width"] = recipe.width;
  json["height"] = recipe.height;
  json["shape"] = {{"relief", kReliefs[static_cast<std::size_t>(recipe.shape.relief)]},
                   {"slope", recipe.shape.slope},
                   {"wavelength_px", recipe.shape.wavelength_px}};
  json["materials"] = io::Json::array();
  for (const Material& material : recipe.materials)
    json["materials"].push_back(io::material_to_json(material));
  json["patch_px"] = recipe.patch_px;
  json["albedo_variation"] = recipe.albedo_variation;
  json["lights"] = {{"arrangement", kArrangements[static_cast<std::size_t>(recipe.lights.arrangement)]},
                    {"count", recipe.lights.count},
                    {"theta_deg", recipe.lights.theta_deg},
                    {"intensity", recipe.lights.intensity},
                    {"distance", recipe.lights.distance}};
  json["cast_shadows"] = recipe.cast_shadows;
  json["residual"] = {{"lobes", recipe.residual.lobes},
                      {"sharpness", recipe.residual.sharpness},
                      {"cut_off_deg", recipe.residual.cut_off_deg},
                      {"strength", recipe.residual.strength}};
  json["noise"] = {{"multiplicative", recipe.noise.multiplicative}, {"additive", recipe.noise.additive}};
  io::Json gains = io::Json::array();
  for (const auto& [light, factor] : recipe.faults.gains) gains.push_back(io::Json::array({light, factor}));
  io::Json swapped = io::Json::array();
  for (const auto& [first, second] : recipe.faults.swapped)
    swapped.push_back(io::Json::array({first, second}));
  json["faults"] = {{"gains", gains},
                    {"swapped", swapped},
                    {"upside_down", recipe.faults.upside_down},
                    {"hot_pixels", recipe.faults.hot_pixels}};
  json["files"] = {{"format", recipe.files.format},
                   {"transfer", recipe.files.transfer},
                   {"jpeg_quality", recipe.files.jpeg_quality},
                   {"jpeg_subsampling", recipe.files.jpeg_subsampling},
                   {"manifest", recipe.files.manifest},
                   {"give_normals", recipe.files.give_normals},
                   {"give_albedo", recipe.files.give_albedo}};
  json["seed"] = recipe.seed;
  return json;
}

StackRecipe stack_recipe_from_json(const io::Json& json, const std::string& file) {
  io::ObjectReader reader(json, file);
  reader.integer("brdfit_stack_recipe", kVersion, kVersion);
  StackRecipe recipe;
  recipe.name = reader.string("name");
  recipe.source = reader.string("source", recipe.source);
  recipe.width = static_cast<int>(reader.integer("width", 1, kMaxEdge, recipe.width));
  recipe.height = static_cast<int>(reader.integer("height", 1, kMaxEdge, recipe.height));
  if (reader.has("shape")) recipe.shape = read_shape(reader.object("shape"));
  recipe.materials = read_materials(reader, file);
  recipe.patch_px = static_cast<int>(reader.integer("patch_px", 0, kMaxEdge, recipe.patch_px));
  recipe.albedo_variation = reader.number("albedo_variation", 0.0, 1.0, recipe.albedo_variation);
  if (reader.has("lights")) recipe.lights = read_lights(reader.object("lights"));
  recipe.cast_shadows = reader.boolean("cast_shadows", recipe.cast_shadows);
  if (reader.has("residual")) recipe.residual = read_residual(reader.object("residual"));
  if (reader.has("noise")) recipe.noise = read_noise(reader.object("noise"));
  if (reader.has("faults")) recipe.faults = read_faults(reader.object("faults"));
  if (reader.has("files")) recipe.files = read_files(reader.object("files"));
  recipe.seed = read_seed(reader, recipe.seed);
  reader.finish();
  if (const std::string complaint = complaint_of(recipe); !complaint.empty()) {
    throw io::IoError(io::IoError::Side::kInput, file, complaint, "a recipe whose parts agree");
  }
  return recipe;
}

StackRecipe read_stack_recipe(const std::filesystem::path& file) {
  return stack_recipe_from_json(io::read_json(file), file.string());
}

bool is_stack_recipe(const io::Json& json) {
  return json.is_object() && json.contains("brdfit_stack_recipe");
}

}  // namespace brdfit::synthetic
