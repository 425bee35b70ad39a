// Results to JSON.
#include "cli/result_json.h"

#include <fmt/format.h>

#include <utility>

#include "cli/ladder_cost.h"
#include "cli/measure_names.h"
#include "io/material_json.h"

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

Json by_light_to_json(const render::SphereDeltaE& sphere) {
  Json json;
  for (std::size_t k = 0; k < render::kLightAnglesDeg.size(); ++k) {
    json[fmt::format("{:g}", render::kLightAnglesDeg[k])] = sphere.by_light[k];
  }
  return json;
}

Json effects_to_json(const fit::FitOptions& options) {
  if (options.choose_groups) return "auto";
  if (!options.groups)
    return options.effects ? Json(fit::names_of_groups(
                                 options.model, fit::groups_of_effects(options.model, *options.effects)))
                           : Json("all");
  return fit::names_of_groups(options.model, *options.groups);
}

// The errors that the choice of groups went by: of many sets the least, so none that a new block would show.
Json selection_to_json(const fit::Selection& selection) {
  return {{"log_ratio_pct", selection.held_out.log_ratio_pct},
          {"folds_pct", selection.held_out.folds_pct},
          {"without_pct", selection.held_out_without.log_ratio_pct},
          {"all_pct", selection.held_out_all.log_ratio_pct},
          {"free_parameters_all", selection.parameters_all},
          {"sets_compared", selection.sets}};
}

// Mean and spread over folds of every measure.
Json over_folds_to_json(const fit::HeldOutEvaluation& held_out, fit::Measures fit::Evaluation::*of) {
  std::size_t cells = 0;
  for (const fit::HeldOutFold& fold : held_out.folds) cells += (fold.evaluation.*of).cells;
  Json json = {{"cells", cells}};
  if (cells == 0) return json;
  constexpr std::pair<const char*, double fit::Measures::*> kMeasures[] = {
      {"log_ratio_pct", &fit::Measures::log_ratio_pct},
      {"slice_pct", &fit::Measures::slice_pct},
      {"relative", &fit::Measures::relative},
      {"cube_root", &fit::Measures::cube_root},
      {"srgb", &fit::Measures::srgb},
      {"cosine_l2", &fit::Measures::cosine_l2}};
  for (const auto& [name, measure] : kMeasures) {
    const fit::MeanAndSpread value = fit::over_folds(held_out, of, measure);
    json[name] = {{"mean", value.mean}, {"deviation", value.deviation}};
  }
  return json;
}

Json held_out_to_json(const JudgedFit& judged) {
  const fit::HeldOutEvaluation& held_out = *judged.held_out;
  Json folds = Json::array();
  for (const fit::HeldOutFold& fold : held_out.folds) {
    folds.push_back({{"log_ratio_pct", fold.evaluation.table.log_ratio_pct},
                     {"cells", fold.evaluation.table.cells},
                     {"observations", fold.observations},
                     {"free_parameters", fold.free_parameters},
                     {"groups", fit::names_of_groups(judged.fit.options.model, fold.groups)},
                     {"loss", name_of(fold.loss)}});
  }
  return {{"table", over_folds_to_json(held_out, &fit::Evaluation::table)},
          {"slice", over_folds_to_json(held_out, &fit::Evaluation::slice)},
          {"folds", folds}};
}

Json sample_size_to_json(const fit::SampleSize& size) {
  Json trials = Json::array();
  for (const fit::SizeTrial& trial : size.trials) {
    Json json = {{"samples", trial.samples}, {"held_out_pct", trial.held_out_pct}};
    if (!trials.empty()) json["standard_error_pct"] = trial.standard_error_pct;
    trials.push_back(json);
  }
  return {{"trials", trials}, {"check_cells", size.check_cells}, {"converged", size.converged}};
}

Json ladder_to_json(const fit::Selection& selection) {
  Json ladder = Json::array();
  for (const fit::LadderStep& step : selection.ladder) {
    ladder.push_back({{"action", step.removed ? "removed" : "added"},
                      {"groups", step.groups},
                      {"held_out_before_pct", step.held_out_before_pct},
                      {"held_out_after_pct", step.held_out_after_pct},
                      {"standard_error_pct", step.standard_error_pct},
                      {"parameters", step.parameters},
                      {"material", io::effects_and_values_to_json(step.material)}});
  }
  return ladder;
}

Json losses_to_json(const fit::FitResult& result) {
  Json losses = Json::array();
  for (const fit::LossTrial& trial : result.losses) {
    losses.push_back({{"loss", name_of(trial.loss)},
                      {"sphere_delta_e", trial.judged},
                      {"kept", trial.loss == result.options.loss}});
  }
  return losses;
}

Json options_to_json(const fit::FitOptions& options) {
  Json json;
  json["tier"] = name_of(options.tier);
  json["on"] = name_of(options.on);
  if (options.on == fit::FitOn::kSlices) json["phi_d_deg"] = options.phi_d_deg;
  if (options.on == fit::FitOn::kTable) {
    json["samples"] = options.choose_samples           ? Json("auto")
                      : options.samples == kAllSamples ? Json("all")
                                                       : Json(options.samples);
    if (options.choose_samples) json["sample_threshold"] = options.sample_threshold;
  }
  json["max_theta_deg"] = options.max_theta_deg;
  json["effects"] = effects_to_json(options);
  if (options.choose_groups) json["group_threshold"] = options.group_threshold;
  json["loss"] = options.choose_loss ? "auto" : name_of(options.loss);
  json["starts"] = options.starts;
  json["seed"] = options.seed;
  if (options.held_out_folds > 0) json["held_out_folds"] = options.held_out_folds;
  Json fixed = Json::object();
  for (const auto& [name, values] : options.fixed) fixed[name] = values;
  if (!fixed.empty()) json["fixed"] = fixed;
  json["init"] = options.init.has_value();
  return json;
}

Json timings_to_json(const JudgedFit& judged) {
  const fit::FitTimings& timings = judged.fit.timings;
  Json json = {{"sample", timings.sample_seconds},     {"select", timings.select_seconds},
               {"explore", timings.explore_seconds},   {"refine", timings.refine_seconds},
               {"evidence", timings.evidence_seconds}, {"measure", timings.measure_seconds},
               {"sphere", judged.sphere.seconds},      {"fit", judged.total_seconds()}};
  if (judged.held_out) json["held_out"] = judged.held_out_seconds;
  if (judged.fit.selection) {
    Json costs = Json::array();
    for (const double seconds : ladder_costs(judged.fit)) costs.push_back(seconds);
    json["evaluation"] = costs;
  }
  return json;
}

}  // namespace

std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::proximate(file, folder, error);
  return error || path.is_absolute() ? "" : path.generic_string();
}

void add_choices(const JudgedFit& judged, Json& json) {
  const fit::FitResult& result = judged.fit;
  if (result.sample_size) json["sample_size"] = sample_size_to_json(*result.sample_size);
  if (judged.held_out) json["held_out"] = held_out_to_json(judged);
  json["groups"] = fit::names_of_groups(result.options.model, result.groups);
  if (!result.selection) return;
  json["selection"] = selection_to_json(*result.selection);
  json["ladder_start"] = io::effects_and_values_to_json(result.selection->material_without);
  json["ladder"] = ladder_to_json(*result.selection);
}

Json measures_to_json(const fit::Measures& m) {
  Json json;
  for (const MeasureName& measure : kMeasures) json[measure.key] = m.*measure.value;
  json["cells"] = m.cells;
  return json;
}

Json evaluation_to_json(const fit::Evaluation& evaluation, const render::SphereDeltaE& sphere) {
  return {
      {"slice", measures_to_json(evaluation.slice)},           {"table", measures_to_json(evaluation.table)},
      {"reciprocity_gap_pct", evaluation.reciprocity_gap_pct}, {"sphere_delta_e", sphere.mean},
      {"sphere_delta_e_by_light", by_light_to_json(sphere)},   {"sphere_pixels_skipped", sphere.skipped}};
}

Json fit_options_to_json(const fit::FitOptions& options) {
  return options_to_json(options);
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
  json["request"] = provenance.request;
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
  add_choices(judged, json);
  if (!result.losses.empty()) json["losses"] = losses_to_json(result);
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
