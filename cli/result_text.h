// Fit results as tables for people.
#ifndef BRDFIT_CLI_RESULT_TEXT_H_
#define BRDFIT_CLI_RESULT_TEXT_H_

#include <span>
#include <string>
#include <vector>

#include "cli/sphere_judge.h"
#include "fit/fit.h"

namespace brdfit::cli {

// Columns of equal width, the first left and the others right aligned; a heading and a rule.
std::string format_table(const std::vector<std::string>& heading,
                         const std::vector<std::vector<std::string>>& rows);

// A parameter's value, and its 8-bit sRGB triple if it is a colour or a tint (empty if it is a number).
std::string value_text(const Material& material, const ParameterInfo& info);
std::string srgb_text(const Material& material, const ParameterInfo& info);

// The errors of one candidate (a model, a file) as cells of a row, in the order of measure_heading().
std::vector<std::string> measure_heading();
std::vector<std::string> measure_cells(const fit::Evaluation& evaluation, const render::SphereDeltaE& sphere);

// Per model: free parameters, every measure on slice and table, sphere dE, seconds.
std::string format_errors(std::span<const JudgedFit> results);

// Every parameter of a fit with its value, 8-bit sRGB for colours, its range and its status; then the notes.
std::string format_parameters(const fit::FitResult& result);

// How many cells were fitted and why, and the errors on what was held out: a line for each that there is.
std::string format_evidence(const JudgedFit& judged);

// What the choice of effects went through: a row per step, with the held-out error after it, its difference
// with the standard error over folds, the free parameters and the time per evaluation.
std::string format_ladder(const fit::FitResult& result);

// The phases of the fits in units of the load floor.
std::string format_timings(std::span<const JudgedFit> results, double load_seconds, double floor_seconds,
                           std::size_t peak_bytes);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RESULT_TEXT_H_
