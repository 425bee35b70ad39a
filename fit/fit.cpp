// The course of a fit: sample, explore, refine, look at the evidence, measure.
#include "fit/fit.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "brdf/albedo.h"
#include "fit/descend.h"
#include "fit/draw.h"
#include "fit/explore.h"
#include "fit/metallic.h"
#include "fit/problem.h"
#include "fit/reasons.h"
#include "fit/settle.h"
#include "fit/solve.h"
#include "fit/uncertainty.h"

namespace brdfit::fit {
namespace {

// Of a table kExploredOfTable; slices need more, as a narrow highlight lies in few of their rows.
constexpr std::size_t kExploredOfSlices = 2400;
// How much wider the squares of a robust loss reach while searching.
constexpr double kWidening = 3.0;
constexpr std::size_t kRefined = 2;  // starts that are refined on all samples

// Candidates are compared after a brief descent; only the best is carried to its minimum.
constexpr DescentOptions kBrief = {8, 1e-4, 1e-4};
constexpr DescentOptions kNearby = {60, 1e-5, 1e-4};
constexpr DescentOptions kThorough = {60, 1e-7, 1e-4};

// A directional albedo above this is more than the quadrature's error above 1.
constexpr double kFurnaceBound = 1.01;

class Stopwatch {
 public:
  double lap_seconds() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Effects effects_to_fit(const FitOptions& options) {
  const Effects all = effects_of(options.model).without(Effect::kAnisotropic);
  return options.effects ? Effects(options.effects->bits() & all.bits()) : all;
}

Groups usable_groups_of(const FitOptions& options) {
  const Groups usable = usable_groups(options.model, options.tier, effects_to_fit(options));
  return options.groups ? usable & *options.groups : usable;
}

FreedomOptions freedom_of(const FitOptions& options) {
  return {options.tier, effects_to_fit(options), options.fixed, options.groups};
}

Material start_material(const FitOptions& options) {
  Material material = options.init ? *options.init : Material(options.model);
  material.options() = options.material_options;
  return material;
}

// The best candidates that are not the same minimum found twice, at most count of them.
std::vector<Candidate> distinct(const std::vector<Candidate>& candidates, std::size_t count) {
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates) {
    if (result.size() == count) break;
    // Worse than this on the part of the samples will not be best on all.
    if (candidate.solution.cost > 1.3 * candidates.front().solution.cost) break;
    const bool found = std::ranges::any_of(result, [&](const Candidate& other) {
      return candidate.solution.cost <= other.solution.cost * (1.0 + 5e-3);
    });
    if (!found) result.push_back(candidate);
  }
  return result;
}

// Samples as residuals.
struct Data {
  SampleSet samples;
  Targets targets;

  Data(SampleSet of, Loss loss) : samples(std::move(of)), targets(make_targets(samples, loss)) {}
};

// Those to explore on; with the targets of a loss that is squared over a wider range too.
struct Part : Data {
  Targets wide_targets;

  Part(SampleSet of, Loss loss) : Data(std::move(of), loss), wide_targets(targets) {
    wide_targets.robust_width *= kWidening;
  }
};

SampleSet part_to_explore(const Drawn& drawn, const FitOptions& options) {
  if (drawn.nested) return drawn.samples;
  const std::size_t explored = options.on == FitOn::kTable ? kExploredOfTable : kExploredOfSlices;
  return drawn.samples.thinned((drawn.samples.size() + explored - 1) / explored);
}

class Fitter {
 public:
  // seeds: materials to start from besides.
  Fitter(const MeasuredTable& table, const FitOptions& options, Drawn drawn, std::vector<Material> seeds)
      : table_(table),
        options_(options),
        seeds_(std::move(seeds)),
        parametrisation_(make_parametrisation(start_material(options), freedom_of(options))),
        nested_(std::move(drawn.nested)),
        part_(part_to_explore(drawn, options), options.loss),
        all_(std::move(drawn.samples), options.loss),
        on_part_(parametrisation_, part_.samples, part_.targets, options.loss),
        on_part_wide_(parametrisation_, part_.samples, part_.wide_targets, options.loss, Precision::kSingle),
        on_all_(parametrisation_, all_.samples, all_.targets, options.loss) {}

  FitResult run() {
    result_.options = options_;
    result_.free_parameters = static_cast<int>(parametrisation_.size());
    result_.groups = usable_groups_of(options_);
    result_.timings.sample_seconds = watch_.lap_seconds();
    explore_starts();
    result_.timings.explore_seconds = watch_.lap_seconds();
    refine_best();
    result_.timings.refine_seconds = watch_.lap_seconds();
    look_at_evidence();
    result_.timings.evidence_seconds = watch_.lap_seconds();
    result_.evaluation = evaluate(result_.material, table_, options_.max_theta_deg);
    result_.timings.measure_seconds = watch_.lap_seconds();
    const FitTimings& t = result_.timings;
    result_.timings.total_seconds =
        t.sample_seconds + t.explore_seconds + t.refine_seconds + t.evidence_seconds + t.measure_seconds;
    return std::move(result_);
  }

 private:
  // More parameters have more wrong valleys.
  int start_count() const {
    if (options_.starts > 0) return options_.starts;
    return std::clamp(static_cast<int>(parametrisation_.size()) / 2 + 1, 4, 12);
  }

  void explore_starts() {
    std::vector<std::vector<double>> seeds;
    if (options_.init) seeds.push_back(parametrisation_.from_material(*options_.init));
    for (const Material& seed : seeds_) seeds.push_back(parametrisation_.from_material(seed));
    candidates_ = explore(on_part_, on_part_wide_, part_.samples, seeds, {start_count(), options_.seed});
    result_.starts = static_cast<int>(candidates_.size());
    for (const Candidate& candidate : candidates_) result_.evaluations += candidate.solution.evaluations;
  }

  void refine_best() {
    const double best_cost = candidates_.front().solution.cost;
    result_.starts_near_best = static_cast<int>(std::ranges::count_if(
        candidates_, [&](const Candidate& c) { return c.solution.cost <= 1.05 * best_cost; }));
    std::vector<Decided> refined;
    for (const Candidate& candidate : distinct(candidates_, kRefined)) {
      refined.push_back(decide_metallic(on_part_, candidate));
      result_.evaluations += refined.back().evaluations;
    }
    if (nested_) {
      grow_samples(refined);
    } else {
      descend_to_best(refined);
    }
    result_.observations = all_.samples.size();
    Solution& solution = published_.candidate.solution;
    // Near the minimum already, Ceres has little left to do.
    solution = solve_pinning(on_all_, solution.x, published_.candidate.box, {});
    result_.evaluations += solution.evaluations;
  }

  // On all samples as they are now; the best goes to its minimum.
  void descend_to_best(std::vector<Decided>& refined) {
    const Problem& rough = on_all_rough_.emplace(parametrisation_, all_.samples, all_.targets, options_.loss,
                                                 Precision::kSingle);
    if (refined.size() > 1) {
      tbb::parallel_for(std::size_t{0}, refined.size(), [&](std::size_t k) {
        Candidate& candidate = refined[k].candidate;
        candidate.solution = descend(rough, candidate.solution.x, candidate.box, kBrief);
      });
      for (const Decided& decided : refined) result_.evaluations += decided.candidate.solution.evaluations;
    }
    published_ =
        *std::ranges::min_element(refined, {}, [](const Decided& d) { return d.candidate.solution.cost; });
    Solution& solution = published_.candidate.solution;
    const Solution nearby = descend(rough, solution.x, published_.candidate.box, kNearby);
    solution = descend(on_all_, nearby.x, published_.candidate.box, kThorough);
    result_.evaluations += nearby.evaluations + solution.evaluations;
  }

  // Doubles the samples until that changes little; each size goes on from the minimum of the one before. The
  // first size chooses between minima, as a search sees few cells.
  void grow_samples(std::vector<Decided>& refined) {
    SizeChoice choice(nested_->check(), options_.sample_threshold);
    const auto tried = [&](const Decided& decided) {
      return choice.add(all_.samples.size(), parametrisation_.to_material(decided.candidate.solution.x));
    };
    tried(refined.front());
    bool is_enough = false;
    while (!is_enough && nested_->grow()) {
      all_ = Data(nested_->samples(), options_.loss);
      descend_to_best(refined);
      refined = {published_};
      is_enough = tried(published_);
    }
    if (!is_enough) {
      all_ = Data(draw_all(table_, options_), options_.loss);
      descend_to_best(refined);
    }
    result_.sample_size = choice.outcome();
  }

  // Metallic 0 was kept where another value fits as well: that ties it to specular, whatever stands at x.
  void mark_undecided(Settled& settled) const {
    if (!published_.metallic_undecided) return;
    for (std::size_t k = 0; k < parametrisation_.size(); ++k) {
      const std::string& name = parametrisation_.free[k].name;
      if (name != "metallic" && name != "specular") continue;
      settled.identifiability.status[k] = Status::kUnidentifiable;
      settled.reasons[k] = fmt::format("tied to {}: another combination fits as well",
                                       name == "metallic" ? "specular" : "metallic");
    }
  }

  void look_at_evidence() {
    if (!published_.note.empty()) result_.notes.push_back(published_.note);
    Settled settled = settle_unidentifiable(on_all_, *on_all_rough_, published_.candidate.solution,
                                            published_.candidate.box);
    mark_undecided(settled);
    result_.evaluations += settled.evaluations;
    const Solution& solution = settled.solution;
    const Identifiability& identifiability = settled.identifiability;
    result_.parameters = public_states(parametrisation_, solution.x, identifiability);
    add_standard_errors(parametrisation_, solution.x,
                        estimate_uncertainty(on_all_, solution.x, settled.box, identifiability),
                        result_.parameters);
    add_reasons(parametrisation_, solution.x, settled.reasons, result_.parameters);
    result_.correlated = identifiability.correlated;
    result_.material = parametrisation_.to_material(solution.x);
    result_.cost = solution.cost;
    result_.iterations = solution.iterations;
    result_.converged = solution.converged;
    result_.termination = solution.termination;
    result_.largest_albedo = largest_directional_albedo(result_.material);
    add_notes();
  }

  void add_notes() {
    std::string at_bounds;
    for (const ParameterState& state : result_.parameters) {
      if (state.status != Status::kAtLowerBound && state.status != Status::kAtUpperBound) continue;
      at_bounds +=
          (at_bounds.empty() ? "" : ", ") + state.name + " (" + std::string(name_of(state.status)) + ")";
    }
    if (!at_bounds.empty()) result_.notes.push_back("at the end of its range: " + at_bounds);
    if (!result_.converged) {
      result_.notes.push_back(
          fmt::format("the solver stopped before it converged ({} iterations)", result_.iterations));
    }
    if (result_.largest_albedo > kFurnaceBound) {
      result_.notes.push_back(fmt::format(
          "the material gives back more light than it gets: its directional albedo reaches {:.2f}",
          result_.largest_albedo));
    }
    if (options_.max_theta_deg < 90.0) {
      result_.notes.push_back(
          fmt::format("directions further than {:g} deg from the normal were left out of fit and errors",
                      options_.max_theta_deg));
    }
  }

  const MeasuredTable& table_;
  FitOptions options_;
  std::vector<Material> seeds_;
  Stopwatch watch_;
  Parametrisation parametrisation_;
  std::optional<NestedSample> nested_;
  Part part_;
  Data all_;
  Problem on_part_;
  Problem on_part_wide_;
  Problem on_all_;
  std::optional<Problem> on_all_rough_;  // the same in single precision, of the samples as they are
  std::vector<Candidate> candidates_;
  Decided published_;
  FitResult result_;
};

// At phi_d = 90 deg cos_i and cos_o are the same, and the smooth terminator is a second knob for what the
// Fresnel terms do at grazing angles.
bool is_blind_to_terminator(const FitOptions& options) {
  constexpr double kNear = 10.0;
  return options.on == FitOn::kSlices &&
         std::ranges::all_of(options.phi_d_deg, [](double phi_d) { return std::abs(phi_d - 90.0) <= kNear; });
}

bool leaves_terminator_off(const FitOptions& options) {
  return options.model == Model::kCallisto && options.choose_groups && !options.effects && !options.groups &&
         is_blind_to_terminator(options);
}

SelectionOptions choice_of(const FitOptions& options) {
  SelectionOptions choice;
  choice.threshold = options.group_threshold;
  choice.usable = usable_groups_of(options);
  if (leaves_terminator_off(options)) {
    choice.usable =
        choice.usable.without(groups_of_effects(options.model, Effects().with(Effect::kSmoothTerminator)));
  }
  for (const auto& [name, values] : options.fixed) {
    const auto group = group_of_parameter(options.model, name);
    if (!group) continue;
    const auto effect = *group_by_name(options.model, effect_name(groups_of(options.model)[*group].effect));
    choice.required = choice.required.with(*group).with(effect);
  }
  choice.usable = choice.usable | choice.required;
  return choice;
}

CrossValidation cross_validation(const MeasuredTable& table, const Drawn& drawn, const FitOptions& options) {
  FoldOptions folding;
  folding.seed = options.seed;
  // An earlier material may come from all of the data: folds do not begin from it.
  FitOptions without_init = options;
  without_init.init.reset();
  CrossValidationOptions validating;
  validating.start = start_material(without_init);
  validating.tier = options.tier;
  validating.fixed = options.fixed;
  validating.loss = options.loss;
  validating.seed = options.seed;
  return {make_folds(drawn.samples, drawn.cells, table.grid(), folding), validating};
}

// What the choice of data means for the result.
void add_notes_on_data(FitResult& result) {
  const FitOptions& options = result.options;
  if (leaves_terminator_off(options)) {
    result.notes.emplace_back(
        "a slice at phi_d = 90 deg does not show the smooth terminator: it was left at its default "
        "(--effects "
        "with its name has it fitted)");
  }
  if (options.on == FitOn::kSlices) {
    result.notes.push_back(fmt::format(
        "fitted on slices alone: the log-ratio is {:.1f}% on the slice at 90 deg and {:.1f}% on the "
        "whole table",
        result.evaluation.slice.log_ratio_pct, result.evaluation.table.log_ratio_pct));
  }
}

}  // namespace

std::string_view name_of(FitOn on) {
  return on == FitOn::kTable ? "table" : "slices";
}

std::optional<FitOn> fit_on_by_name(std::string_view name) {
  for (const FitOn on : {FitOn::kTable, FitOn::kSlices}) {
    if (name_of(on) == name) return on;
  }
  return std::nullopt;
}

bool FitOptions::is_valid(std::string* why) const {
  const auto fail = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (!(group_threshold >= 0.0)) {
    return fail(fmt::format("the threshold of groups is {}; 0 or more is needed", group_threshold));
  }
  if (starts < 0) return fail(fmt::format("starts is {}; 0 or more is needed", starts));
  if (!(sample_threshold >= 0.0)) {
    return fail(fmt::format("the threshold of samples is {}; 0 or more is needed", sample_threshold));
  }
  if (held_out_folds < 0 || held_out_folds == 1) {
    return fail(fmt::format("{} folds are held out; 0 for none, or 2 and more are needed", held_out_folds));
  }
  if (samples < 1) return fail("samples is 0; at least 1 is needed");
  if (!(max_theta_deg > 0.0 && max_theta_deg <= 90.0)) {
    return fail(fmt::format("max theta is {} deg, not in (0, 90]", max_theta_deg));
  }
  if (on == FitOn::kSlices && phi_d_deg.empty()) return fail("no phi_d is given for the slices");
  for (const double phi_d : phi_d_deg) {
    if (!(phi_d >= 0.0 && phi_d < 180.0)) return fail(fmt::format("phi_d is {} deg, not in [0, 180)", phi_d));
  }
  if (init && init->model() != model) {
    return fail(
        fmt::format("the material to start from is {}, not {}", title_of(init->model()), title_of(model)));
  }
  try {
    make_parametrisation(start_material(*this), freedom_of(*this));
  } catch (const std::invalid_argument& error) {
    return fail(error.what());
  }
  return true;
}

FitResult fit(const MeasuredTable& table, const FitOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument(why);
  Stopwatch watch;
  Drawn drawn = draw_samples(table, options);
  const double sample_seconds = watch.lap_seconds();
  FitOptions chosen = options;
  std::vector<Material> seeds;
  std::optional<Selection> selection;
  if (options.choose_groups && !choice_of(options).usable.empty()) {
    CrossValidation validation = cross_validation(table, draw_for_folds(drawn), options);
    if (!validation.folds().empty()) {
      selection = select_groups(validation, options.model, choice_of(options));
      chosen.groups = selection->chosen;
      seeds = validation.materials(selection->chosen);
      fit_ladder(validation, drawn.samples, *selection);
    }
  }
  const double select_seconds = watch.lap_seconds();
  FitResult result = Fitter(table, chosen, std::move(drawn), std::move(seeds)).run();
  result.options = options;
  result.selection = std::move(selection);
  add_notes_on_data(result);
  result.timings.sample_seconds += sample_seconds;
  result.timings.select_seconds = select_seconds;
  result.timings.total_seconds += sample_seconds + select_seconds;
  return result;
}

}  // namespace brdfit::fit
