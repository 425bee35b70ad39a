// Reading what `fit` wrote: the materials of a folder with their evidence, grouped by what they were fitted
// to.
#ifndef BRDFIT_CLI_RESULT_FOLDER_H_
#define BRDFIT_CLI_RESULT_FOLDER_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "io/json.h"

namespace brdfit::cli {

// A material file and the member "fit" of it (an empty object where it has none).
struct FittedMaterial {
  std::filesystem::path file;
  Material material;
  io::Json evidence;
};

// All that was fitted to one input.
struct ResultGroup {
  std::string name;        // "blue-fabric"
  std::string input_name;  // "blue-fabric.binary"; empty if the files do not say
  std::string input_sha256;
  std::vector<FittedMaterial> fits;  // in the order of all_models(), then of file names
};

struct ResultFolder {
  std::vector<ResultGroup> groups;   // in the order of names
  std::vector<std::string> ignored;  // files that could not be read, and why
};

// Every material file (.json) below the folder. JSON files that are no materials are passed over; those that
// say they are one and cannot be read are in `ignored`. Throws IoError when the folder cannot be read or
// holds no material.
ResultFolder read_results(const std::filesystem::path& folder);

// The table that a group was fitted to: in one of the given files or folders, in the result folder, or where
// the evidence says that it was, relative to the result. Its hash must be that of the evidence. Nothing if
// there is none; *why then says what was looked for.
std::optional<std::filesystem::path> find_measured(const ResultGroup& group,
                                                   const std::vector<std::string>& given, std::string* why);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RESULT_FOLDER_H_
