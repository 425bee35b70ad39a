// Look-ups in a point.
#include "cli/cost/cost_point.h"

#include <algorithm>

namespace brdfit::cli {

double error_of(const CostPoint& point, const std::string& key) {
  const auto found = std::ranges::find(point.errors, key, &std::pair<std::string, double>::first);
  return found == point.errors.end() ? kNotMeasured : found->second;
}

std::string setting_of(const CostPoint& point, const std::string& key) {
  const auto found = std::ranges::find(point.settings, key, &std::pair<std::string, std::string>::first);
  return found == point.settings.end() ? "" : found->second;
}

}  // namespace brdfit::cli
