// What a synthetic table is made of: the recipe, and its JSON form.
#ifndef BRDFIT_DATA_SYNTHETIC_RECIPE_H_
#define BRDFIT_DATA_SYNTHETIC_RECIPE_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "brdf/material.h"
#include "io/json.h"
#include "measured/table.h"

namespace brdfit::synthetic {

// Noise of a measurement, independent in every cell and channel. A value f becomes
// f exp(multiplicative z1) + additive z2, with z1 and z2 standard normal: the mean of log f is kept by the
// first, the mean of f by the second.
struct Noise {
  double multiplicative = 0.0;  // relative sigma, in [0, 1]
  double additive = 0.0;        // sigma in sr^-1, in [0, 1000]
  friend bool operator==(const Noise&, const Noise&) = default;
};

// Cells that count as not measured, beside those below the horizon.
struct Invalid {
  double fraction = 0.0;        // chance of each otherwise valid cell to be dropped, in [0, 1)
  int blocks = 0;               // box-shaped holes at random places, in [0, 1000]
  int block_cells = 4;          // edge of a hole in cells, in [1, 64]; cut to the grid where that is smaller
  double max_theta_deg = 90.0;  // cells with theta_i or theta_o above are dropped; in [0.001, 90]
  friend bool operator==(const Invalid&, const Invalid&) = default;
};

// A material with a known answer, and how it is "measured".
struct Recipe {
  std::string name;    // not empty
  std::string source;  // where the facts come from; may be empty
  Material material;
  Grid grid;
  Noise noise;
  Invalid invalid;
  std::uint64_t seed = 1;  // of noise and holes

  // Largest grid dimension, and number of cells (24 bytes each while generating).
  static constexpr int kMaxDimension = 4096;
  static constexpr std::size_t kMaxCells = std::size_t{1} << 26;

  // Whether name, material and all ranges above hold; if not, *why (when not null) names the first that does
  // not.
  bool is_valid(std::string* why) const;

  friend bool operator==(const Recipe&, const Recipe&) = default;
};

// {"brdfit_recipe": 1, "name": ..., "source": ..., "material": {...}, "grid": {"theta_h", "theta_d", "phi_d",
// "anchor": "lower-edge" | "centre"}, "noise": {"multiplicative", "additive"}, "invalid": {"fraction",
// "blocks", "block_cells", "max_theta_deg"}, "seed": ...}; material as in io/material_json.h. Throws
// std::invalid_argument if the material is not valid.
io::Json recipe_to_json(const Recipe& recipe);

// The inverse. Everything but version, name and material may be absent and is then at its default. file names
// the place for errors. Throws IoError (kInput), naming file and member: unknown version or key, a wrong
// type, a value outside its range, a missing member, a material that is not valid.
Recipe recipe_from_json(const io::Json& json, const std::string& file);

// Reads and writes a recipe's file. Throw IoError.
Recipe read_recipe(const std::filesystem::path& file);
void write_recipe(const std::filesystem::path& file, const Recipe& recipe);

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_RECIPE_H_
