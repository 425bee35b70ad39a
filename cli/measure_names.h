// The error measures by name, with their units and digits: the one list that texts, tables, comparisons and
// reports are made from.
#ifndef BRDFIT_CLI_MEASURE_NAMES_H_
#define BRDFIT_CLI_MEASURE_NAMES_H_

#include <array>
#include <string>

#include "fit/metrics.h"

namespace brdfit::cli {

struct MeasureName {
  const char* key;    // in JSON: "log_ratio_pct"
  const char* title;  // for people, with its unit if it has one: "log-ratio %"
  double fit::Measures::*value;
  int digits;           // behind the point
  bool is_significant;  // then the digits are significant ones
};

// What is measured on the slice and on the table alike, in the order in which it is shown.
inline constexpr std::array<MeasureName, 6> kMeasures = {
    {{"log_ratio_pct", "log-ratio %", &fit::Measures::log_ratio_pct, 2, false},
     {"slice_pct", "slice %", &fit::Measures::slice_pct, 2, false},
     {"relative", "relative", &fit::Measures::relative, 3, false},
     {"cube_root", "cube root", &fit::Measures::cube_root, 4, false},
     {"srgb", "sRGB", &fit::Measures::srgb, 4, false},
     {"cosine_l2", "cosine L2", &fit::Measures::cosine_l2, 3, true}}};

// What there is one number of.
inline constexpr const char* kSphereTitle = "sphere dE";
inline constexpr const char* kGapTitle = "gap %";

// Values as texts, with the digits of the measure; on the slice and on the table with a bar between them.
std::string measure_text(const MeasureName& measure, double value);
std::string measure_texts(const MeasureName& measure, double slice, double table, const char* bar = "|");
std::string sphere_text(double delta_e);
std::string gap_text(double gap_pct);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_MEASURE_NAMES_H_
