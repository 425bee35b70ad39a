// Parsing of the options that say how to fit.
#include "cli/fit_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "io/material_json.h"

namespace brdfit::cli {
namespace {

const fit::FitOptions kDefaults;

template <class Range>
std::vector<std::string> names_of(const Range& values) {
  std::vector<std::string> names;
  for (const auto value : values) names.emplace_back(name_of(value));
  return names;
}

std::vector<std::string> with(std::vector<std::string> names, std::initializer_list<const char*> more) {
  names.insert(names.begin(), more.begin(), more.end());
  return names;
}

// Of every model's groups.
std::vector<std::string> group_names() {
  std::vector<std::string> names;
  for (const Model model : all_models()) {
    for (const fit::Group& group : fit::groups_of(model)) names.emplace_back(group.name);
  }
  return names;
}

bool is_keyword(std::string_view name) {
  return name == "auto" || name == "all" || name == "none";
}

void apply_samples(const std::string& text, fit::FitOptions& options) {
  options.choose_samples = text == "auto";
  if (options.choose_samples) return;
  options.samples = kAllSamples;
  if (text == "all") return;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.samples);
  if (error != std::errc() || end != text.data() + text.size() || options.samples == 0) {
    throw UsageError("--samples is \"" + text + "\", not a number of cells, \"auto\" or \"all\"");
  }
}

std::pair<std::string, std::vector<double>> parse_fix(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto fail = [&] {
    return UsageError("--fix is \"" + text + "\", not NAME=NUMBER or NAME=RED,GREEN,BLUE");
  };
  if (equals == std::string::npos || equals == 0) throw fail();
  std::vector<double> values;
  const char* at = text.data() + equals + 1;
  const char* const end = text.data() + text.size();
  while (true) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (next != end && *next != ',')) throw fail();
    values.push_back(value);
    if (next == end) break;
    at = next + 1;
  }
  return {text.substr(0, equals), values};
}

// What a list of effects and groups, or one word for them, means for a model.
void apply_effects(const std::vector<std::string>& names, fit::FitOptions& options) {
  if (names.size() > 1 && std::ranges::any_of(names, is_keyword)) {
    throw UsageError("--effects takes auto, all, none, or names of effects and refinements");
  }
  options.choose_groups = names.front() == "auto";
  if (names.front() == "auto" || names.front() == "all") return;
  options.groups = fit::groups_by_names(options.model, names);
  options.effects = fit::effects_of_groups(options.model, *options.groups);
}

std::vector<Model> parse_models(const std::vector<std::string>& names) {
  std::vector<Model> models;
  for (const Model model : all_models()) {
    const bool asked = std::ranges::any_of(
        names, [&](const std::string& name) { return name == "all" || name == name_of(model); });
    if (asked) models.push_back(model);
  }
  return models;
}

// Gives each fixed parameter to the models that have it.
void apply_fixed(const std::vector<std::string>& fix, std::vector<fit::FitOptions>& all) {
  for (const std::string& text : fix) {
    const auto [name, values] = parse_fix(text);
    bool known = false;
    for (fit::FitOptions& options : all) {
      if (find_parameter(options.model, name) == nullptr) continue;
      options.fixed[name] = values;
      known = true;
    }
    if (!known) throw UsageError("--fix names \"" + name + "\", which no model that is fitted has");
  }
}

void apply_init(const std::vector<std::string>& files, std::vector<fit::FitOptions>& all) {
  for (const std::string& file : files) {
    const Material material = io::read_material(file);
    const auto found = std::ranges::find(all, material.model(), &fit::FitOptions::model);
    if (found == all.end()) {
      throw UsageError(
          fmt::format("--init {} is a {} material, which is not fitted", file, title_of(material.model())));
    }
    found->init = material;
  }
}

// Effects that only some of the models have are given to those.
void check_effects(const std::vector<std::string>& names, const std::vector<Model>& models) {
  for (const std::string& name : names) {
    const bool known =
        std::ranges::any_of(models, [&](Model model) { return fit::group_by_name(model, name).has_value(); });
    if (!known && !is_keyword(name)) {
      throw UsageError("--effects names \"" + name + "\", which no model that is fitted has");
    }
  }
}

}  // namespace

FitArguments::FitArguments()
    : tier(name_of(kDefaults.tier)),
      on(name_of(kDefaults.on)),
      phi_d_deg(kDefaults.phi_d_deg),
      max_theta_deg(kDefaults.max_theta_deg),
      loss(name_of(kDefaults.loss)),
      starts(kDefaults.starts),
      seed(kDefaults.seed),
      masking(name_of(kDefaults.material_options.masking)),
      burley_g(name_of(kDefaults.material_options.burley_g)),
      diffuse(name_of(kDefaults.material_options.diffuse)) {}

void add_fit_arguments(CLI::App& app, FitArguments& a) {
  // Lists are separated by commas, so that an option does not take the file behind it.
  app.add_option("--model", a.models, "models to fit")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->check(CLI::IsMember(with(names_of(all_models()), {"all"})))
      ->capture_default_str();
  app.add_option("--tier", a.tier, "parameters that may move: those of a tier and the tiers before it")
      ->check(CLI::IsMember({"base", "advanced", "full"}))
      ->capture_default_str();
  app.add_option(
         "--effects", a.effects,
         "effects to use: auto for those that lower the held-out error, all, none, or a list of effects "
         "and of refinements (a tint, a tangent falloff, a length); an effect brings its refinements, "
         "unless some of them are named")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->check(CLI::IsMember(with(group_names(), {"auto", "all", "none"})))
      ->capture_default_str();
  app.add_option("--on", a.on, "what is fitted: a stratified sample of the table, or slices")
      ->check(CLI::IsMember({"table", "slices"}))
      ->capture_default_str();
  app.add_option("--phi-d", a.phi_d_deg, "slices to fit, in degrees")
      ->allow_extra_args(false)
      ->delimiter(',')
      ->capture_default_str();
  app.add_option(
         "--max-theta", a.max_theta_deg,
         "leave out directions further from the normal, in degrees (MERL is extrapolated above about 80)")
      ->capture_default_str();
  app.add_option("--samples", a.samples,
                 "cells of the table to fit: a number, all, or auto for as many as change the error on cells "
                 "that were not fitted")
      ->capture_default_str();
  app.add_option("--loss", a.loss,
                 "what is minimised; auto fits under each and keeps the one whose spheres look most like the "
                 "measured ones")
      ->check(CLI::IsMember(with(names_of(fit::all_losses()), {"auto"})))
      ->capture_default_str();
  app.add_option("--starts", a.starts,
                 "points from which the search begins; 0: 4 to 12, by the number of free parameters")
      ->capture_default_str();
  app.add_option("--seed", a.seed, "of the sample and the starts")->capture_default_str();
  app.add_option("--masking", a.masking, "masking of Lambert + GGX and Callisto")
      ->check(CLI::IsMember({"separable", "correlated"}))
      ->capture_default_str();
  app.add_option("--burley-g", a.burley_g, "masking of Burley: the remapped form of 2012 or that of 2017")
      ->check(CLI::IsMember({"2012", "2017"}))
      ->capture_default_str();
  app.add_option("--diffuse", a.diffuse, "diffuse base of Lambert + GGX and Callisto")
      ->check(CLI::IsMember({"lambert", "proxima"}))
      ->capture_default_str();
  app.add_option("--cell", a.cell, "where in its cell a stored value belongs")
      ->check(CLI::IsMember({"lower-edge", "centre"}))
      ->capture_default_str();
  app.add_flag("--held-out{5}", a.held_out_folds,
               "measure the errors of everything that is done here on blocks of angles that it did not see; "
               "takes as many fits more as there are folds, --held-out=FOLDS for another number than 5");
  app.add_flag("--lenient", a.lenient, "take NaN and infinities as unmeasured, and say how many");
  app.add_option("--init", a.init, "a material JSON of the same model to start from as well")
      ->allow_extra_args(false);
  app.add_option("--fix", a.fix, "NAME=NUMBER or NAME=RED,GREEN,BLUE: hold a parameter (may be repeated)")
      ->allow_extra_args(false);
}

std::vector<fit::FitOptions> make_fit_options(const FitArguments& a) {
  const std::vector<Model> models = parse_models(a.models);
  check_effects(a.effects, models);
  std::vector<fit::FitOptions> all;
  for (const Model model : models) {
    fit::FitOptions options;
    options.model = model;
    options.material_options.masking = *masking_by_name(a.masking);
    options.material_options.burley_g = *burley_g_by_name(a.burley_g);
    options.material_options.diffuse = *diffuse_by_name(a.diffuse);
    options.tier = *tier_by_name(a.tier);
    apply_effects(a.effects, options);
    options.on = *fit::fit_on_by_name(a.on);
    options.phi_d_deg = a.phi_d_deg;
    options.max_theta_deg = a.max_theta_deg;
    apply_samples(a.samples, options);
    options.choose_loss = a.loss == "auto";
    if (!options.choose_loss) options.loss = *fit::loss_by_name(a.loss);
    options.starts = a.starts;
    options.seed = a.seed;
    options.held_out_folds = a.held_out_folds;
    all.push_back(options);
  }
  apply_fixed(a.fix, all);
  apply_init(a.init, all);
  for (const fit::FitOptions& options : all) {
    std::string why;
    if (!options.is_valid(&why)) throw UsageError(why);
  }
  return all;
}

io::MerlReadOptions make_read_options(const FitArguments& arguments) {
  io::MerlReadOptions options;
  options.anchor = arguments.cell == "centre" ? CellAnchor::kCentre : CellAnchor::kLowerEdge;
  options.lenient = arguments.lenient;
  return options;
}

}  // namespace brdfit::cli
