// Loading a measured table as subcommands do: timed, and with what was found said.
#ifndef BRDFIT_CLI_TABLE_INPUT_H_
#define BRDFIT_CLI_TABLE_INPUT_H_

#include <string>
#include <vector>

#include "cli/common.h"
#include "io/merl.h"
#include "measured/table.h"

namespace brdfit::cli {

struct LoadedTable {
  MeasuredTable table;
  io::MerlReadReport report;
  double seconds = 0.0;
};

// Throws IoError. Says how many values were not finite where the options let that pass.
LoadedTable load_table(const std::string& file, const io::MerlReadOptions& options,
                       const CommonOptions& common);

// Files as they are; folders as the .binary files in them, in the order of their names. Throws IoError
// (kInput) for a folder without one.
std::vector<std::string> table_files(const std::vector<std::string>& inputs);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_TABLE_INPUT_H_
