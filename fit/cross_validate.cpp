// Coarse fits of every fold.
#include "fit/cross_validate.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/descend.h"
#include "fit/explore.h"
#include "fit/log_ratio.h"
#include "fit/plateau.h"
#include "fit/starts.h"

namespace brdfit::fit {
namespace {

// How much wider the squares of a robust loss reach while searching; see fit/explore.h.
constexpr double kWidening = 3.0;
constexpr DescentOptions kStage = {5, 1e-3};
constexpr DescentOptions kJoint = {14, 1e-3};
constexpr DescentOptions kPolish = {30, 1e-5};
// A search whose cost is higher than the best one's by more than this share is not polished.
constexpr double kWorthPolishing = 0.5;
constexpr std::size_t kPolished = 2;
// Searches whose costs differ by less than this share are taken for the same minimum.
constexpr double kSameMinimum = 2e-3;

// Products of one sign stay on the side where they begin.
Box box_at(const Parametrisation& parametrisation, const std::vector<double>& x) {
  Box box = full_box(parametrisation);
  for (const std::size_t k : parametrisation.one_signed) {
    (x[parametrisation.one_signed.front()] >= 0.0 ? box.lower : box.upper)[k] = 0.0;
  }
  return box;
}

// A fresh value for a number that has one, with the other sign where it has a sign.
double turned(const Parametrisation& parametrisation, std::size_t at, double fresh, double now) {
  const bool is_signed = parametrisation.free[at].lower < 0.0;
  return is_signed && now != 0.0 ? std::copysign(fresh, -now) : fresh;
}

struct Search {
  Solution solution;
  Box box;
};

void advance(const Problem& problem, Search& search, const Box& box, const DescentOptions& options) {
  const int evaluations = search.solution.evaluations;
  search.solution = descend(problem, search.solution.x, box, options);
  search.solution.evaluations += evaluations;
}

// Everything at once.
void advance_all(const Problem& problem, Search& search) {
  leave_plateau(problem.parametrisation(), search.solution.x);
  descend_past_plateau(problem.parametrisation(), search,
                       [&](Search& each) { advance(problem, each, each.box, kJoint); });
}

// Moves some numbers and holds the others.
void advance_some(const Problem& problem, Search& search, const std::vector<std::size_t>& moving) {
  Box box = search.box;
  box.moves.assign(box.moves.size(), false);
  for (const std::size_t k : moving) box.moves[k] = true;
  leave_plateau(problem.parametrisation(), search.solution.x);
  advance(problem, search, box, kStage);
}

// Stage by stage, then everything: from a start those of the staging, from a point that was a minimum for
// another set what is new.
Search searched(const Problem& problem, const std::vector<double>& x,
                const std::vector<std::vector<std::size_t>>& stages) {
  Search search;
  search.solution.x = x;
  search.box = box_at(problem.parametrisation(), x);
  for (const std::vector<std::size_t>& stage : stages) {
    if (!stage.empty()) advance_some(problem, search, stage);
  }
  advance_all(problem, search);
  return search;
}

// The best few that are worth polishing and not the same minimum found twice.
std::vector<Search> distinct(std::vector<Search> searches) {
  std::ranges::stable_sort(searches, {}, [](const Search& s) { return s.solution.cost; });
  std::vector<Search> result;
  for (const Search& search : searches) {
    const double cost = search.solution.cost;
    if (result.size() == kPolished || cost > (1.0 + kWorthPolishing) * searches.front().solution.cost) break;
    if (result.empty() || cost > (1.0 + kSameMinimum) * result.back().solution.cost) result.push_back(search);
  }
  return result;
}

}  // namespace

double standard_error_of_difference(const HeldOut& a, const HeldOut& b) {
  const std::size_t n = a.folds_pct.size();
  if (n < 2) return 0.0;
  const double mean = b.log_ratio_pct - a.log_ratio_pct;
  double squares = 0.0;
  for (std::size_t k = 0; k < n; ++k) squares += std::pow(b.folds_pct[k] - a.folds_pct[k] - mean, 2);
  return std::sqrt(squares / static_cast<double>(n * (n - 1)));
}

CrossValidation::CrossValidation(std::vector<Fold> folds, CrossValidationOptions options)
    : folds_(std::move(folds)), options_(std::move(options)) {
  for (const Fold& fold : folds_) {
    FoldTargets targets = {make_targets(fold.training, options_.loss), {}};
    targets.wide = targets.narrow;
    targets.wide.robust_width *= kWidening;
    targets_.push_back(std::move(targets));
  }
}

Parametrisation CrossValidation::parametrisation(Groups groups) const {
  const Model model = options_.start.model();
  return make_parametrisation(options_.start,
                              {options_.tier, effects_of_groups(model, groups), options_.fixed, groups});
}

Material CrossValidation::merged(const Origin& origin, std::size_t fold) const {
  Material material = fits_.at(origin.base.bits())[fold].material;
  if (origin.donor.empty()) return material;
  const Material& donor = fits_.at(origin.donor.bits())[fold].material;
  for (const ParameterInfo& info : parameters_of(material.model())) {
    const auto group = group_of_parameter(material.model(), info.name);
    if (!group || origin.base.has(*group) || !origin.donor.has(*group)) continue;
    const auto from = donor.values().subspan(static_cast<std::size_t>(info.offset),
                                             static_cast<std::size_t>(info.components));
    std::ranges::copy(from, material.values().begin() + info.offset);
  }
  return material;
}

CrossValidation::FoldFit CrossValidation::explore_fold(const Request& request, std::size_t fold) const {
  const Parametrisation parameters = parametrisation(request.groups);
  const SampleSet& samples = folds_[fold].training;
  const Problem wide(parameters, samples, targets_[fold].wide, options_.loss);
  const Problem narrow(parameters, samples, targets_[fold].narrow, options_.loss);
  const ExploreOptions options = {request.fresh_starts, options_.seed + request.variant, request.kick_rounds};
  const std::vector<Candidate> candidates = explore(narrow, wide, samples, {}, options);
  FoldFit best = {parameters.to_material(candidates.front().solution.x)};
  best.cost = candidates.front().solution.cost;
  for (const Candidate& candidate : candidates) best.evaluations += candidate.solution.evaluations;
  best.held_out_pct = log_ratio_pct(best.material, folds_[fold].validation);
  return best;
}

CrossValidation::FoldFit CrossValidation::fit_fold(const Request& request, std::size_t fold) const {
  const Model model = options_.start.model();
  const Parametrisation parameters = parametrisation(request.groups);
  const SampleSet& samples = folds_[fold].training;
  const Problem wide(parameters, samples, targets_[fold].wide, options_.loss, Precision::kSingle);
  const Problem narrow(parameters, samples, targets_[fold].narrow, options_.loss);
  const std::size_t count = static_cast<std::size_t>(request.fresh_starts) + request.origins.size();
  const std::vector<std::vector<double>> fresh =
      make_starts(parameters, samples, static_cast<int>(count), options_.seed + request.variant);
  std::vector<Search> searches;
  for (std::size_t k = 0; k < count; ++k) {
    if (k >= request.origins.size()) {
      searches.push_back(searched(wide, fresh[k], staging(wide.parametrisation())));
      continue;
    }
    const Origin& origin = request.origins[k];
    std::vector<double> x = parameters.from_material(merged(origin, fold));
    std::vector<std::size_t> added;
    for (std::size_t at = 0; at < x.size(); ++at) {
      const auto group = group_of_parameter(model, parameters.free[at].parameter);
      if (!group) continue;
      const bool anew = origin.anew.has(*group);
      if (origin.base.has(*group) && !anew) continue;
      if (anew || !origin.donor.has(*group))
        x[at] = anew ? turned(parameters, at, fresh[k][at], x[at]) : fresh[k][at];
      added.push_back(at);
    }
    searches.push_back(searched(wide, x, {added}));
  }
  FoldFit best = {options_.start};
  for (const Search& search : searches) best.evaluations += search.solution.evaluations;
  for (const Search& search : distinct(searches)) {
    const Solution polished = descend(narrow, search.solution.x, search.box, kPolish);
    best.evaluations += polished.evaluations;
    if (!(polished.cost < best.cost)) continue;
    best.cost = polished.cost;
    best.material = parameters.to_material(polished.x);
  }
  best.held_out_pct = log_ratio_pct(best.material, folds_[fold].validation);
  return best;
}

void CrossValidation::fit(const std::vector<Request>& requests) {
  const std::size_t n = folds_.size();
  std::vector<FoldFit> results(requests.size() * n);
  tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t k) {
    const Request& request = requests[k / n];
    results[k] = request.kick_rounds > 0 ? explore_fold(request, k % n) : fit_fold(request, k % n);
  });
  for (std::size_t k = 0; k < results.size(); ++k) {
    evaluations_ += results[k].evaluations;
    std::vector<FoldFit>& known = fits_[requests[k / n].groups.bits()];
    if (known.size() <= k % n) {
      known.push_back(std::move(results[k]));
    } else if (results[k].cost < known[k % n].cost) {
      known[k % n] = std::move(results[k]);
    }
  }
}

HeldOut CrossValidation::held_out(Groups groups) const {
  HeldOut result;
  for (const FoldFit& fit : fits_.at(groups.bits())) result.folds_pct.push_back(fit.held_out_pct);
  result.log_ratio_pct = std::accumulate(result.folds_pct.begin(), result.folds_pct.end(), 0.0) /
                         static_cast<double>(result.folds_pct.size());
  return result;
}

double CrossValidation::cost(Groups groups) const {
  double sum = 0.0;
  for (const FoldFit& fit : fits_.at(groups.bits())) sum += fit.cost;
  return sum;
}

std::vector<Material> CrossValidation::materials(Groups groups) const {
  std::vector<Material> result;
  for (const FoldFit& fit : fits_.at(groups.bits())) result.push_back(fit.material);
  return result;
}

Material CrossValidation::fitted_to(const SampleSet& samples, Groups groups) const {
  const Parametrisation parameters = parametrisation(groups);
  const Targets targets = make_targets(samples, options_.loss);
  const Problem problem(parameters, samples, targets, options_.loss);
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (const FoldFit& fit : fits_.at(groups.bits())) {
    std::vector<double> x = parameters.from_material(fit.material);
    const double cost = problem.cost(x);
    if (!best.empty() && !(cost < least)) continue;
    best = std::move(x);
    least = cost;
  }
  return parameters.to_material(descend(problem, best, box_at(parameters, best), kPolish).x);
}

int CrossValidation::free_numbers(Groups groups) const {
  return static_cast<int>(parametrisation(groups).size());
}

}  // namespace brdfit::fit
