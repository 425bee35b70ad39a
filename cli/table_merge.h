// Joining the folders of a run that was split over machines.
#ifndef BRDFIT_CLI_TABLE_MERGE_H_
#define BRDFIT_CLI_TABLE_MERGE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "cli/result_table.h"

namespace brdfit::cli {

// Copies the results of the folders into another and writes the tables that one run would have written.
// Throws IoError when a folder holds no finished run or a shard is missing; UsageError when two folders hold
// different results of one material, or a file exists and force is off.
ResultTable merge_runs(const std::vector<std::string>& folders, const std::filesystem::path& output,
                       bool force);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_TABLE_MERGE_H_
