// Tables and materials as input.
#include "cli/subject_input.h"

#include <fmt/format.h>

#include "io/material_json.h"

namespace brdfit::cli {

void add_table_reading(CLI::App& app, TableReading& reading) {
  app.add_option("--cell", reading.cell, "where in its cell a stored value was measured")
      ->check(CLI::IsMember({"lower-edge", "centre"}))
      ->capture_default_str();
  app.add_flag("--lenient", reading.lenient,
               "take NaN and infinities as unmeasured; count, show and name them");
}

io::MerlReadOptions read_options_of(const TableReading& reading) {
  io::MerlReadOptions options;
  options.anchor = reading.cell == "centre" ? CellAnchor::kCentre : CellAnchor::kLowerEdge;
  options.lenient = reading.lenient;
  return options;
}

render::Subject LoadedSubject::subject() const {
  if (material) return render::Subject(*material);
  return render::Subject(table->table);
}

LoadedSubject load_subject(const std::string& file, const TableReading& reading,
                           const CommonOptions& common) {
  LoadedSubject loaded;
  loaded.file = file;
  loaded.name = base_name(file);
  if (std::filesystem::path(file).extension() == ".json") {
    loaded.material = io::read_material(file);
    return loaded;
  }
  loaded.table = load_table(file, read_options_of(reading), common);
  for (const std::string& warning : cell_warnings(loaded.table->table)) say(common, file + ": " + warning);
  return loaded;
}

std::vector<std::string> cell_warnings(const MeasuredTable& table) {
  const std::array<std::size_t, 4> counts = table.state_counts();
  const std::size_t negative = counts[static_cast<std::size_t>(CellState::kNegative)];
  const std::size_t not_finite = counts[static_cast<std::size_t>(CellState::kNotFinite)];
  std::vector<std::string> warnings;
  if (not_finite > 0) {
    warnings.push_back(fmt::format(
        "{} cells hold NaN or infinity; they are left out, and hatched magenta in pictures", not_finite));
  }
  if (negative > 0) {
    warnings.push_back(fmt::format(
        "{} cells are negative in some channels only; they are left out, and hatched cyan in pictures",
        negative));
  }
  return warnings;
}

}  // namespace brdfit::cli
