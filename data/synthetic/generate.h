// Tables with known answers: a recipe in, a measured table or a MERL-format file out.
#ifndef BRDFIT_DATA_SYNTHETIC_GENERATE_H_
#define BRDFIT_DATA_SYNTHETIC_GENERATE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "data/synthetic/recipe.h"
#include "measured/table.h"

namespace brdfit::synthetic {

// What a generated table holds. cells - valid - dropped cells are at or below the horizon.
struct GenerateReport {
  std::size_t cells = 0;
  std::size_t valid = 0;
  std::size_t dropped = 0;  // above the horizon, but left out by Recipe::invalid
  std::size_t floored_at_zero =
      0;  // channel values that noise took below 0, which cannot be stored: 0 instead
  std::uint64_t seed = 0;
  friend bool operator==(const GenerateReport&, const GenerateReport&) = default;
};

// f of every cell, in sr^-1, in the order of Grid::index; -1 in all channels of cells that are not valid.
//
// A cell's value is the mean of f(wi, wo) and f(wo, wi) at the cell's own angles (its anchor), with the
// recipe's noise: phi_d folds the two into one cell, and not every model is reciprocal. Runs on all threads
// that TBB may use; the result depends on the recipe alone. Throws std::invalid_argument if the recipe is not
// valid. report may be null.
std::vector<Rgb> generate_values(const Recipe& recipe, GenerateReport* report = nullptr);

// As generate_values, in memory, rounded to the table's floats.
MeasuredTable generate_table(const Recipe& recipe, GenerateReport* report = nullptr);

// As generate_values, written as a MERL file in double precision. Throws IoError (kOutput): the file cannot
// be written, or the recipe leaves no valid cell, which no reader would accept.
GenerateReport generate(const Recipe& recipe, const std::filesystem::path& merl_file);

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_GENERATE_H_
