// From result files to what a report shows.
#ifndef BRDFIT_CLI_REPORT_DATA_H_
#define BRDFIT_CLI_REPORT_DATA_H_

#include <string>
#include <vector>

#include "cli/common.h"
#include "cli/comparison.h"
#include "cli/result_folder.h"
#include "cli/subject_input.h"
#include "render/report.h"

namespace brdfit::cli {

// What a material file says about its fit. Evidence that is missing or of the wrong type is left out.
render::ReportFit report_fit(const FittedMaterial& fitted);

struct ReportOptions {
  ComparisonOptions comparison;
  std::vector<std::string> measured;  // files or folders to look for tables in
  TableReading reading;
};

// One material with its pictures. Throws IoError when a table that was found cannot be read.
render::ReportMaterial report_material(const ResultGroup& group, const ReportOptions& options,
                                       const CommonOptions& common);

// The whole report of a folder, materials in parallel; says how far it is. command: for the report's head.
render::Report make_report(const std::filesystem::path& folder, const ReportOptions& options,
                           const std::string& command, const CommonOptions& common);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_REPORT_DATA_H_
