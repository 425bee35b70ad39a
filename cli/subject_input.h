// Loading what is drawn: a measured table or a material, told apart by the file's ending.
#ifndef BRDFIT_CLI_SUBJECT_INPUT_H_
#define BRDFIT_CLI_SUBJECT_INPUT_H_

#include <optional>
#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/table_input.h"
#include "render/subject.h"

namespace brdfit::cli {

// How tables are read.
struct TableReading {
  std::string cell = "lower-edge";
  bool lenient = false;
};

void add_table_reading(CLI::App& app, TableReading& reading);
io::MerlReadOptions read_options_of(const TableReading& reading);

// Owns one table or one material.
struct LoadedSubject {
  std::string file;
  std::string name;  // the file's base name
  std::optional<LoadedTable> table;
  std::optional<Material> material;

  render::Subject subject() const;
};

// ".json" is a material, everything else a MERL-format table. Throws IoError.
LoadedSubject load_subject(const std::string& file, const TableReading& reading, const CommonOptions& common);

// What is wrong with a table's cells, in sentences, empty if nothing is: values that are not finite, or
// negative in some channels only. Cells without a measurement are normal and not named here.
std::vector<std::string> cell_warnings(const MeasuredTable& table);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_SUBJECT_INPUT_H_
