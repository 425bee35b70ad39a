// The axes of a sweep.
#include "cli/cost/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "fit/groups.h"

namespace brdfit::cli {
namespace {

constexpr const char* kDefaultSamples = "20000";

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ","));
}

// A model's effects that isotropic data can show, within a tier.
Effects usable_effects(Model model, Tier tier) {
  const Effects all = effects_of(model).without(Effect::kAnisotropic);
  return fit::effects_of_groups(model, fit::usable_groups(model, tier, all));
}

// What a fit may move, as one text: two plans with the same text are the same fit.
std::string freedom_text(const fit::FitOptions& options) {
  const Effects effects = effects_of(options.model).without(Effect::kAnisotropic);
  fit::Groups groups = fit::usable_groups(options.model, options.tier, effects);
  if (options.groups) groups = groups & *options.groups;
  std::string text = options.choose_groups ? "chosen of" : "";
  for (const ParameterInfo& info : parameters_of(options.model)) {
    const auto group = fit::group_of_parameter(options.model, info.name);
    const bool is_usable = group ? groups.has(*group) : info.effect == Effect::kNone;
    if (is_usable && info.tier <= options.tier) text += fmt::format(" {}", info.name);
  }
  return text;
}

// Whether a tier means anything for the model.
bool has_tiers(Model model) {
  return std::ranges::any_of(parameters_of(model),
                             [](const ParameterInfo& info) { return info.tier != Tier::kBase; });
}

class Plan {
 public:
  Plan(const FitArguments& common, bool quick) : default_(common), quick_(quick) {
    default_.models = {std::string(name_of(Model::kCallisto))};
    default_.tier = name_of(Tier::kFull);
    default_.effects = {"all"};
    default_.on = name_of(fit::FitOn::kTable);
    default_.samples = kDefaultSamples;
    default_.loss = name_of(fit::Loss::kLogRatio);
    default_.starts = 0;
    default_.held_out_folds = 0;
  }

  std::vector<PlannedFit> make() {
    add("default", default_, "all effects");
    add_models();
    add_tiers();
    add_effects();
    add_samples();
    add_starts();
    add_losses();
    add_slices();
    return std::move(fits_);
  }

 private:
  // what: what tells the point from others of its model and tier.
  void add(const std::string& sweep, const FitArguments& arguments, const std::string& what) {
    const fit::FitOptions options = make_fit_options(arguments).front();
    std::string text = freedom_text(options);
    for (const auto& [key, value] : settings_of(arguments)) {
      if (key != "tier" && key != "effects") text += fmt::format(" {}={}", key, value);
    }
    if (!seen_.insert(text).second) return;
    std::string name(name_of(options.model));
    if (has_tiers(options.model)) name += fmt::format(" {}", arguments.tier);
    if (!what.empty()) name += fmt::format(", {}", what);
    fits_.push_back({name, sweep, arguments, options});
  }

  void add_models() {
    for (const Model model : all_models()) {
      FitArguments arguments = default_;
      arguments.models = {std::string(name_of(model))};
      add("model", arguments, effects_of(model) == Effects() ? "" : "all effects");
    }
  }

  void add_tiers() {
    for (const Tier tier : {Tier::kBase, Tier::kAdvanced, Tier::kFull}) {
      for (const Model model : all_models()) {
        FitArguments arguments = default_;
        arguments.models = {std::string(name_of(model))};
        arguments.tier = name_of(tier);
        add("tier", arguments, "all effects");
      }
    }
  }

  void add_effects() {
    for (const Model model : all_models()) {
      for (const Tier tier : {Tier::kFull, Tier::kAdvanced, Tier::kBase}) {
        const bool is_default = model == Model::kCallisto && tier == Tier::kFull;
        if (!quick_ || is_default) add_effects(model, tier);
      }
    }
  }

  void add_effects(Model model, Tier tier) {
    FitArguments arguments = default_;
    arguments.models = {std::string(name_of(model))};
    arguments.tier = name_of(tier);
    const auto with = [&](const std::vector<std::string>& effects, const std::string& what) {
      arguments.effects = effects;
      add("effects", arguments, what);
    };
    const Effects usable = usable_effects(model, tier);
    if (usable == Effects()) return;
    with({"none"}, "no effects");
    for (const Effect effect : all_effects()) {
      if (!usable.has(effect)) continue;
      const std::string name(effect_name(effect));
      if (!quick_) with({name}, "only " + name);
      std::vector<std::string> others;
      for (const Effect other : all_effects()) {
        if (usable.has(other) && other != effect) others.emplace_back(effect_name(other));
      }
      if (!others.empty()) with(others, "without " + name);
    }
    with({"auto"}, "chosen effects");
  }

  void add_samples() {
    const std::vector<std::string> sizes =
        quick_ ? std::vector<std::string>{"1000", "4000"}
               : std::vector<std::string>{"500", "1000", "2000", "4000", "8000", "50000", "100000"};
    FitArguments arguments = default_;
    for (const std::string& size : sizes) {
      arguments.samples = size;
      add("samples", arguments, size + " samples");
    }
    arguments.samples = "auto";
    add("samples", arguments, "chosen samples");
    // What `brdfit fit` does when it is told nothing.
    arguments.effects = {"auto"};
    add("samples", arguments, "chosen effects and samples");
  }

  void add_starts() {
    FitArguments arguments = default_;
    for (const int starts : quick_ ? std::vector{1, 4} : std::vector{1, 2, 4, 8, 16, 32}) {
      arguments.starts = starts;
      add("starts", arguments, fmt::format("{} start{}", starts, starts == 1 ? "" : "s"));
    }
  }

  void add_losses() {
    if (quick_) return;
    FitArguments arguments = default_;
    for (const fit::Loss loss : fit::all_losses()) {
      arguments.loss = name_of(loss);
      add("loss", arguments, fmt::format("{} loss", arguments.loss));
    }
    arguments.loss = "auto";
    add("loss", arguments, "chosen loss");
  }

  void add_slices() {
    FitArguments arguments = default_;
    arguments.on = name_of(fit::FitOn::kSlices);
    arguments.phi_d_deg = {90.0};
    add("on", arguments, "on the slice at 90 deg");
    if (quick_) return;
    arguments.phi_d_deg = {0.0, 45.0, 90.0};
    add("on", arguments, "on slices at 0, 45 and 90 deg");
  }

  FitArguments default_;
  bool quick_;
  std::vector<PlannedFit> fits_;
  std::set<std::string> seen_;
};

}  // namespace

std::vector<PlannedFit> plan_fits(const FitArguments& common, bool quick) {
  return Plan(common, quick).make();
}

std::vector<std::pair<std::string, std::string>> settings_of(const FitArguments& a) {
  std::vector<std::pair<std::string, std::string>> settings = {
      {"model", joined(a.models)}, {"tier", a.tier}, {"effects", joined(a.effects)}, {"on", a.on}};
  if (a.on == name_of(fit::FitOn::kSlices)) {
    settings.emplace_back("phi-d", fmt::format("{:g}", fmt::join(a.phi_d_deg, ",")));
  } else {
    settings.emplace_back("samples", a.samples);
  }
  settings.emplace_back("loss", a.loss);
  settings.emplace_back("starts", std::to_string(a.starts));
  return settings;
}

std::string fit_command(const FitArguments& arguments, const std::string& input) {
  std::string command = "brdfit fit " + quoted_word(input);
  for (const auto& [key, value] : settings_of(arguments)) command += fmt::format(" --{} {}", key, value);
  const FitArguments defaults;
  if (arguments.seed != defaults.seed) command += fmt::format(" --seed {}", arguments.seed);
  if (arguments.max_theta_deg != defaults.max_theta_deg) {
    command += fmt::format(" --max-theta {}", arguments.max_theta_deg);
  }
  if (arguments.cell != defaults.cell) command += fmt::format(" --cell {}", arguments.cell);
  if (arguments.lenient) command += " --lenient";
  return command;
}

}  // namespace brdfit::cli
