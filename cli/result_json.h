// Fit results as JSON: the evidence in a material file, and what --json prints.
#ifndef BRDFIT_CLI_RESULT_JSON_H_
#define BRDFIT_CLI_RESULT_JSON_H_

#include <filesystem>
#include <string>

#include "cli/sphere_judge.h"
#include "fit/fit.h"
#include "io/json.h"

namespace brdfit::cli {

// Where a result came from.
struct Provenance {
  std::string input;   // base name of the file, without its folder
  std::string sha256;  // of its bytes
  std::string version;
  bool lenient = false;
  std::size_t non_finite_values = 0;
  std::string cell;     // "lower-edge" or "centre"
  std::string path;     // of the input from the folder of the result, so that a report finds it
  std::string command;  // the line that was typed
  // Of request_of(): what was asked, so that a run knows a finished result.
  std::string request = "";
};

// `path` of a provenance. Empty where there is no way from one to the other.
std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file);

io::Json measures_to_json(const fit::Measures& measures);

// The options of a fit that the evidence holds.
io::Json fit_options_to_json(const fit::FitOptions& options);

// The member "fit" of a material file. Everything that changes from run to run is under "timings_seconds".
io::Json evidence_to_json(const JudgedFit& judged, const Provenance& provenance);

// "groups" that a fit used, with "selection" and "ladder" where it chose them; "sample_size" where it chose
// that; "held_out" where that was asked for.
void add_choices(const JudgedFit& judged, io::Json& json);

// {"slice": {...}, "table": {...}, "reciprocity_gap_pct": x, "sphere_delta_e": x, ...}
io::Json evaluation_to_json(const fit::Evaluation& evaluation, const render::SphereDeltaE& sphere);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RESULT_JSON_H_
