// Recipes: their ranges, and reading and writing them as JSON.
#include "data/synthetic/recipe.h"

#include <fmt/format.h>

#include <cmath>

#include "data/synthetic/recipe_reader.h"
#include "io/material_json.h"

namespace brdfit::synthetic {
namespace {

constexpr int kVersion = 1;
// The largest double below 1: a fraction of 1 would leave nothing.
constexpr double kMaxFraction = 1.0 - 0x1p-53;
// Of the usual grids, only the retroreflective cell at the normal lies closer to the normal.
constexpr double kMinThetaDeg = 1e-3;
constexpr int kMaxBlocks = 1000;
constexpr int kMaxBlockCells = 64;

constexpr std::string_view kLowerEdge = "lower-edge";
constexpr std::string_view kCentre = "centre";

// The first complaint about a recipe's numbers.
class Complaint {
 public:
  void check(std::string_view name, double value, double lower, double upper) {
    if (!text_.empty() || (std::isfinite(value) && value >= lower && value <= upper)) return;
    text_ = fmt::format("{} is {}, not in [{}, {}]", name, value, lower, upper);
  }
  void check(bool good, std::string_view text) {
    if (text_.empty() && !good) text_ = text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

bool small_enough(const Grid& grid) {
  return grid.cell_count() <= Recipe::kMaxCells;
}

Grid read_grid(io::ObjectReader reader) {
  Grid grid;
  const auto dimension = [&](std::string_view key, int fallback) {
    return static_cast<int>(reader.integer(key, 1, Recipe::kMaxDimension, fallback));
  };
  grid.n_theta_h = dimension("theta_h", grid.n_theta_h);
  grid.n_theta_d = dimension("theta_d", grid.n_theta_d);
  grid.n_phi_d = dimension("phi_d", grid.n_phi_d);
  const std::string anchor = reader.string("anchor", kLowerEdge);
  if (anchor != kLowerEdge && anchor != kCentre) {
    reader.fail("anchor", fmt::format("is \"{}\"", anchor),
                fmt::format("\"{}\" or \"{}\"", kLowerEdge, kCentre));
  }
  grid.anchor = anchor == kCentre ? CellAnchor::kCentre : CellAnchor::kLowerEdge;
  reader.finish();
  return grid;
}

Invalid read_invalid(io::ObjectReader reader) {
  Invalid invalid;
  invalid.fraction = reader.number("fraction", 0.0, kMaxFraction, invalid.fraction);
  invalid.blocks = static_cast<int>(reader.integer("blocks", 0, kMaxBlocks, invalid.blocks));
  invalid.block_cells =
      static_cast<int>(reader.integer("block_cells", 1, kMaxBlockCells, invalid.block_cells));
  invalid.max_theta_deg = reader.number("max_theta_deg", kMinThetaDeg, 90.0, invalid.max_theta_deg);
  reader.finish();
  return invalid;
}

}  // namespace

Noise read_noise(io::ObjectReader reader) {
  Noise noise;
  noise.multiplicative = reader.number("multiplicative", 0.0, kMaxMultiplicativeNoise, noise.multiplicative);
  noise.additive = reader.number("additive", 0.0, kMaxAdditiveNoise, noise.additive);
  reader.finish();
  return noise;
}

std::uint64_t read_seed(io::ObjectReader& reader, std::uint64_t fallback) {
  if (!reader.has("seed")) return fallback;
  const io::Json& value = reader.member("seed");
  // An integer that is not negative may be held as either kind: parsed ones are unsigned.
  const bool is_seed =
      value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
  if (!is_seed) {
    const std::string found = value.is_number() ? value.dump() : value.type_name();
    reader.fail("seed", "is " + found, "an integer in [0, 18446744073709551615]");
  }
  return value.get<std::uint64_t>();
}

bool Recipe::is_valid(std::string* why) const {
  std::string material_why;
  const bool material_good = material.is_valid(&material_why);
  Complaint complaint;
  complaint.check(!name.empty(), "name is empty");
  complaint.check(material_good, "material: " + material_why);
  complaint.check("grid.theta_h", grid.n_theta_h, 1, kMaxDimension);
  complaint.check("grid.theta_d", grid.n_theta_d, 1, kMaxDimension);
  complaint.check("grid.phi_d", grid.n_phi_d, 1, kMaxDimension);
  if (complaint.text().empty()) complaint.check(small_enough(grid), "grid has too many cells");
  complaint.check("noise.multiplicative", noise.multiplicative, 0.0, kMaxMultiplicativeNoise);
  complaint.check("noise.additive", noise.additive, 0.0, kMaxAdditiveNoise);
  complaint.check("invalid.fraction", invalid.fraction, 0.0, kMaxFraction);
  complaint.check("invalid.blocks", invalid.blocks, 0, kMaxBlocks);
  complaint.check("invalid.block_cells", invalid.block_cells, 1, kMaxBlockCells);
  complaint.check("invalid.max_theta_deg", invalid.max_theta_deg, kMinThetaDeg, 90.0);
  if (complaint.text().empty()) return true;
  if (why != nullptr) *why = complaint.text();
  return false;
}

io::Json recipe_to_json(const Recipe& recipe) {
  io::Json json;
  json["brdfit_recipe"] = kVersion;
  json["name"] = recipe.name;
  json["source"] = recipe.source;
  json["material"] = io::material_to_json(recipe.material);
  json["grid"] = {{"theta_h", recipe.grid.n_theta_h},
                  {"theta_d", recipe.grid.n_theta_d},
                  {"phi_d", recipe.grid.n_phi_d},
                  {"anchor", recipe.grid.anchor == CellAnchor::kCentre ? kCentre : kLowerEdge}};
  json["noise"] = {{"multiplicative", recipe.noise.multiplicative}, {"additive", recipe.noise.additive}};
  json["invalid"] = {{"fraction", recipe.invalid.fraction},
                     {"blocks", recipe.invalid.blocks},
                     {"block_cells", recipe.invalid.block_cells},
                     {"max_theta_deg", recipe.invalid.max_theta_deg}};
  json["seed"] = recipe.seed;
  return json;
}

Recipe recipe_from_json(const io::Json& json, const std::string& file) {
  io::ObjectReader reader(json, file);
  reader.integer("brdfit_recipe", kVersion, kVersion);
  Recipe recipe;
  recipe.name = reader.string("name");
  if (recipe.name.empty()) reader.fail("name", "is empty", "at least one character");
  recipe.source = reader.string("source", recipe.source);
  recipe.material = io::material_from_json(reader.member("material"), file, reader.place("material"));
  if (reader.has("grid")) recipe.grid = read_grid(reader.object("grid"));
  if (!small_enough(recipe.grid)) {
    reader.fail("grid", fmt::format("has {} cells", recipe.grid.cell_count()),
                fmt::format("at most {}", Recipe::kMaxCells));
  }
  if (reader.has("noise")) recipe.noise = read_noise(reader.object("noise"));
  if (reader.has("invalid")) recipe.invalid = read_invalid(reader.object("invalid"));
  recipe.seed = read_seed(reader, recipe.seed);
  reader.finish();
  return recipe;
}

Recipe read_recipe(const std::filesystem::path& file) {
  return recipe_from_json(io::read_json(file), file.string());
}

void write_recipe(const std::filesystem::path& file, const Recipe& recipe) {
  io::write_json(file, recipe_to_json(recipe));
}

}  // namespace brdfit::synthetic
