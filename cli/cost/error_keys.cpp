// Keys and titles from the one list of measures.
#include "cli/cost/error_keys.h"

#include <fmt/format.h>

#include <utility>

#include "cli/measure_names.h"

namespace brdfit::cli {

std::vector<std::string> table_error_keys(int folds) {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& prefix) {
    for (const MeasureName& measure : kMeasures) keys.push_back(prefix + measure.key);
  };
  add("slice_");
  add("table_");
  keys.emplace_back("sphere_delta_e");
  keys.emplace_back("reciprocity_gap_pct");
  if (folds > 0) add("held_out_");
  return keys;
}

namespace {

// Of light stacks, in 1/255.
std::string stack_error_title(const std::string& key) {
  for (const auto& [prefix, where] : {std::pair("held_out_", "held out"), {"train_", "in training"}}) {
    for (const auto& [measure, title] : {std::pair("rgb_rmse_255", "RMSE/255 of RGB"),
                                         {"rmse_255", "RMSE/255 of luminance"},
                                         {"lit_rmse_255", "RMSE/255 where lit"},
                                         {"worst_light_rmse_255", "RMSE/255 under the worst light"}}) {
      if (key == std::string(prefix) + measure) return fmt::format("{}, {}", title, where);
    }
  }
  return key;
}

}  // namespace

std::string error_title(const std::string& key) {
  if (key == "sphere_delta_e") return kSphereTitle;
  for (const auto& [prefix, where] :
       {std::pair("slice_", "on the slice"), {"table_", "on the table"}, {"held_out_", "held out"}}) {
    for (const MeasureName& measure : kMeasures) {
      if (key == std::string(prefix) + measure.key) return fmt::format("{} {}", measure.title, where);
    }
  }
  return stack_error_title(key);
}

}  // namespace brdfit::cli
