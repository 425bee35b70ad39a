// Fits of many tables into a folder: in parallel, one file per result, resumable.
#ifndef BRDFIT_CLI_DATABASE_RUN_H_
#define BRDFIT_CLI_DATABASE_RUN_H_

#include <filesystem>
#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/fit_options.h"
#include "cli/shard.h"

namespace brdfit::cli {

struct DatabaseRun {
  CommonOptions common;
  FitArguments fit;
  std::vector<std::string> files;  // of the whole run
  std::filesystem::path output;
  Shard shard;
  bool published = false;  // with the talk's parameters as further candidates
  bool timings = false;
  std::string fit_options;  // as typed, of given_fit_options()
};

// Every table by all models, one table per worker in memory. A result is a file of its own, complete or
// absent. One that is there and came from the same input, request and version is kept; the folder's tables
// are made from the files alone, so an interrupted run that is started again ends as an uninterrupted one
// does. A file that cannot be used is told and the others are done.
// Returns an ExitCode. Throws UsageError when a result is there that was made otherwise and --force is off,
// or two files have one name; std::runtime_error when interrupted; IoError (kOutput).
int run_database(const DatabaseRun& run);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_DATABASE_RUN_H_
