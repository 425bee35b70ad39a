// The errors of a run as a table: one row per material and candidate, and what they come to.
#ifndef BRDFIT_CLI_RESULT_TABLE_H_
#define BRDFIT_CLI_RESULT_TABLE_H_

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/measure_names.h"
#include "io/json.h"

namespace brdfit::cli {

struct MeasureColumn {
  const char* name;   // "table_log_ratio_pct"
  const char* group;  // the member of the evidence that it is in; empty: it is the evidence's own
  const char* key;
};

// Every error measure, less is better.
inline constexpr std::array<MeasureColumn, 14> kMeasureColumns = {
    {{"slice_log_ratio_pct", "slice", kMeasures[0].key},
     {"table_log_ratio_pct", "table", kMeasures[0].key},
     {"slice_slice_pct", "slice", kMeasures[1].key},
     {"table_slice_pct", "table", kMeasures[1].key},
     {"slice_relative", "slice", kMeasures[2].key},
     {"table_relative", "table", kMeasures[2].key},
     {"slice_cube_root", "slice", kMeasures[3].key},
     {"table_cube_root", "table", kMeasures[3].key},
     {"slice_srgb", "slice", kMeasures[4].key},
     {"table_srgb", "table", kMeasures[4].key},
     {"slice_cosine_l2", "slice", kMeasures[5].key},
     {"table_cosine_l2", "table", kMeasures[5].key},
     {"sphere_delta_e", "", "sphere_delta_e"},
     {"reciprocity_gap_pct", "", "reciprocity_gap_pct"}}};

using MeasureValues = std::array<double, kMeasureColumns.size()>;

// Of blocks of angles that nothing of a fit saw, where these were asked for.
struct HeldOutValues {
  double log_ratio_pct = 0.0;  // mean over folds
  double deviation_pct = 0.0;
  double free_parameters = 0.0;  // mean over folds
};

struct ResultRow {
  std::string material;   // "blue-fabric"
  std::string candidate;  // "callisto", "callisto (published)"
  int rank = 0;           // of the candidate: fits before published ones, in the order of all_models()
  std::string file;       // of the result, in the folder of the run
  std::string input_name;
  std::string input_sha256;
  double free_parameters = 0.0;
  MeasureValues values = {};
  std::optional<HeldOutValues> held_out;
  std::vector<std::string> effects;                           // that the material uses
  std::vector<std::pair<std::string, double>> phase_seconds;  // what changes from run to run
};

// What the rows of one candidate come to.
struct CandidateSummary {
  std::string candidate;
  std::size_t materials = 0;
  double mean_free_parameters = 0.0;
  double median_free_parameters = 0.0;
  MeasureValues mean = {};
  MeasureValues median = {};
  // Materials for which it is the best of at least two; of equals each wins.
  std::array<int, kMeasureColumns.size()> wins = {};
  std::map<std::string, int> effects;  // materials that use each
};

struct ResultTable {
  std::vector<ResultRow> rows;
  std::map<std::string, std::string> failures;  // why a file has no row, by its name
};

// The row of a result file (a material with the evidence of its fit, or a published one that was compared).
// Throws IoError when a member is missing.
ResultRow row_of_result(const io::Json& document, const std::filesystem::path& file);

// By material, then by rank: the same whichever way the results came together.
void sort_rows(std::vector<ResultRow>& rows);

// In the order of their ranks.
std::vector<CandidateSummary> summarise(const std::vector<ResultRow>& rows);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RESULT_TABLE_H_
