// Measures as texts.
#include "cli/measure_names.h"

#include <fmt/format.h>

namespace brdfit::cli {

std::string measure_text(const MeasureName& measure, double value) {
  return measure.is_significant ? fmt::format("{:.{}g}", value, measure.digits)
                                : fmt::format("{:.{}f}", value, measure.digits);
}

std::string measure_texts(const MeasureName& measure, double slice, double table, const char* bar) {
  return measure_text(measure, slice) + bar + measure_text(measure, table);
}

std::string sphere_text(double delta_e) {
  return fmt::format("{:.2f}", delta_e);
}

std::string gap_text(double gap_pct) {
  return fmt::format("{:.2f}", gap_pct);
}

}  // namespace brdfit::cli
