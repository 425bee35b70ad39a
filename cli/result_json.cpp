// Results to JSON.
#include "cli/result_json.h"

#include <fmt/format.h>

namespace brdfit::cli {
namespace {

using io::Json;

// A number, or null where there is none.
Json error_to_json(const std::optional<double>& error) {
  return error ? Json(*error) : Json();
}

// One number, three for a colour, or null where the fit did not move it.
Json errors_to_json(const fit::ParameterState& state, int components) {
  if (state.standard_error.empty()) return {};
  if (components == 1) return error_to_json(state.standard_error.front());
  Json errors = Json::array();
  for (const std::optional<double>& error : state.standard_error) errors.push_back(error_to_json(error));
  return errors;
}

Json parameter_to_json(const Material& material, const fit::ParameterState& state) {
  const ParameterInfo& info = *find_parameter(material.model(), state.name);
  Json json;
  if (info.components == 3) {
    json["value"] = material.colour(state.name);
    Json statuses = Json::array();
    for (const fit::Status status : state.components) statuses.push_back(name_of(status));
    json["status"] = name_of(state.status);
    if (!state.components.empty()) json["channel_status"] = statuses;
  } else {
    json["value"] = material.number(state.name);
    json["status"] = name_of(state.status);
  }
  json["standard_error"] = errors_to_json(state, info.components);
  if (!state.reason.empty()) json["reason"] = state.reason;
  return json;
}

Json timings_to_json(const JudgedFit& judged) {
  const fit::FitTimings& timings = judged.fit.timings;
  return {{"sample", timings.sample_seconds},   {"explore", timings.explore_seconds},
          {"refine", timings.refine_seconds},   {"evidence", timings.evidence_seconds},
          {"measure", timings.measure_seconds}, {"sphere", judged.sphere.seconds},
          {"fit", judged.total_seconds()}};
}

Json by_light_to_json(const render::SphereDeltaE& sphere) {
  Json json;
  for (std::size_t k = 0; k < render::kLightAnglesDeg.size(); ++k) {
    json[fmt::format("{:g}", render::kLightAnglesDeg[k])] = sphere.by_light[k];
  }
  return json;
}

Json options_to_json(const fit::FitOptions& options) {
  Json json;
  json["tier"] = name_of(options.tier);
  json["on"] = name_of(options.on);
  if (options.on == fit::FitOn::kSlices) json["phi_d_deg"] = options.phi_d_deg;
  if (options.on == fit::FitOn::kTable) {
    json["samples"] = options.samples == kAllSamples ? Json("all") : Json(options.samples);
  }
  json["max_theta_deg"] = options.max_theta_deg;
  json["loss"] = name_of(options.loss);
  json["starts"] = options.starts;
  json["seed"] = options.seed;
  Json fixed = Json::object();
  for (const auto& [name, values] : options.fixed) fixed[name] = values;
  if (!fixed.empty()) json["fixed"] = fixed;
  json["init"] = options.init.has_value();
  return json;
}

}  // namespace

std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::proximate(file, folder, error);
  return error || path.is_absolute() ? "" : path.generic_string();
}

Json measures_to_json(const fit::Measures& m) {
  return {{"log_ratio_pct", m.log_ratio_pct},
          {"slice_pct", m.slice_pct},
          {"relative", m.relative},
          {"cube_root", m.cube_root},
          {"srgb", m.srgb},
          {"cosine_l2", m.cosine_l2},
          {"cells", m.cells}};
}

Json evaluation_to_json(const fit::Evaluation& evaluation, const render::SphereDeltaE& sphere) {
  return {
      {"slice", measures_to_json(evaluation.slice)},           {"table", measures_to_json(evaluation.table)},
      {"reciprocity_gap_pct", evaluation.reciprocity_gap_pct}, {"sphere_delta_e", sphere.mean},
      {"sphere_delta_e_by_light", by_light_to_json(sphere)},   {"sphere_pixels_skipped", sphere.skipped}};
}

Json evidence_to_json(const JudgedFit& judged, const Provenance& provenance) {
  const fit::FitResult& result = judged.fit;
  Json json;
  json["version"] = provenance.version;
  json["command"] = provenance.command;
  json["input"] = {{"name", provenance.input},
                   {"sha256", provenance.sha256},
                   {"cell", provenance.cell},
                   {"path", provenance.path}};
  if (provenance.lenient) json["input"]["non_finite_values"] = provenance.non_finite_values;
  json["options"] = options_to_json(result.options);
  json["observations"] = result.observations;
  json["weights"] = result.options.on == fit::FitOn::kTable
                        ? "every cell of the table alike; a sampled cell stands for its stratum"
                        : "pixels of the slices";
  json["cost"] = result.cost;
  json["searched"] = result.starts;
  json["searched_near_best"] = result.starts_near_best;
  json["evaluations"] = result.evaluations;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  json["termination"] = result.termination;
  json["free_parameters"] = result.free_parameters;
  json.update(evaluation_to_json(result.evaluation, judged.sphere.delta_e));
  json["largest_directional_albedo"] = result.largest_albedo;
  Json parameters = Json::object();
  for (const fit::ParameterState& state : result.parameters) {
    parameters[state.name] = parameter_to_json(result.material, state);
  }
  json["parameters"] = parameters;
  Json correlated = Json::array();
  for (const fit::CorrelatedPair& pair : result.correlated) {
    correlated.push_back({{"first", pair.first}, {"second", pair.second}, {"correlation", pair.correlation}});
  }
  json["correlated"] = correlated;
  json["notes"] = result.notes;
  json["timings_seconds"] = timings_to_json(judged);
  return json;
}

}  // namespace brdfit::cli
