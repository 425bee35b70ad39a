// Lobe sets compared under lights held out, everything redone without them.
#include "bake/choose_lobes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "bake/fold_gain.h"
#include "bake/ridge.h"
#include "bake/solve.h"

namespace brdfit::bake {
namespace {

// Fewer lights per lobe than this cannot carry the five parameters that a search gives each lobe.
constexpr std::size_t kLightsPerSearchedLobe = 6;
// Steps of a fold's search.
constexpr int kFoldIterations = 25;
// Gains of a smaller share of the squared error are not worth a texture.
constexpr double kLeastGain = 2e-3;

std::vector<Vec3> chosen(std::span<const Vec3> directions, std::span<const std::size_t> lights) {
  std::vector<Vec3> out;
  for (const std::size_t l : lights) out.push_back(directions[l]);
  return out;
}

std::vector<std::size_t> all_but(std::size_t count, const std::vector<std::size_t>& held_out) {
  std::vector<std::size_t> rest;
  for (std::size_t l = 0; l < count; ++l) {
    if (std::find(held_out.begin(), held_out.end(), l) == held_out.end()) rest.push_back(l);
  }
  return rest;
}

// The error of amplitudes under the lights of a problem; of none without them.
double error_under(const TexelProblem& problem, std::span<const float> sums) {
  double error = 0.0;
  for (std::size_t l = 0; l < problem.lights; ++l) {
    for (std::size_t i = 0; i < problem.texels; ++i) {
      const std::size_t at = problem.at(l, i);
      const double lobes = sums.empty() ? 0.0 : static_cast<double>(problem.modulation[at]) * sums[at];
      const double left = problem.residual[at] - lobes;
      error += problem.weight_of(l, i) * left * left;
    }
  }
  return error;
}

struct Part {
  TexelProblem problem;
  std::vector<Vec3> directions;
};

double held_out_error(const LobeSet& lobes, const Part& training, const Part& held_out) {
  const RidgeChoice ridge = choose_ridge(lobes, training.directions, training.problem);
  const LobeSystem system(lobes, training.directions, mean_squared_modulation(training.problem), ridge.ridge);
  const SolveResult solved = solve(system, training.problem);
  return error_under(held_out.problem, lobe_sums(lobes, held_out.directions, held_out.problem.directions,
                                                 solved.amplitudes, held_out.problem.texels));
}

// Whether candidates leave less than no lobes do, by more than the chance of which lights were held out.
bool gains(const Candidate& candidate, const std::vector<double>& without) {
  const FoldGain gain = fold_gain(candidate.errors, without);
  const double least = kLeastGain * sum(without) / static_cast<double>(without.size());
  return gain.helped >= kHelpedFolds && gain.mean > std::max(gain.standard_error, least);
}

// The better kind of each number, then the smallest number that is about as good as the best. Null: none
// gains.
const Candidate* pick(const std::vector<Candidate>& candidates, const std::vector<double>& without,
                      double tolerance) {
  std::vector<const Candidate*> gaining;
  for (const Candidate& candidate : candidates) {
    if (gains(candidate, without)) gaining.push_back(&candidate);
  }
  if (gaining.empty()) return nullptr;
  const auto less = [](const Candidate* a, const Candidate* b) { return a->error() < b->error(); };
  const double best = (*std::min_element(gaining.begin(), gaining.end(), less))->error();
  const double enough = best * (1.0 + tolerance) * (1.0 + tolerance);
  const Candidate* picked = nullptr;
  for (const Candidate* candidate : gaining) {
    if (candidate->error() > enough) continue;
    const bool better = picked == nullptr || candidate->count < picked->count ||
                        (candidate->count == picked->count && candidate->error() < picked->error());
    if (better) picked = candidate;
  }
  return picked;
}

void check(std::span<const Vec3> directions, const ChoiceOptions& options) {
  if (directions.size() < 2) throw std::invalid_argument("choose_lobes: at least two lights");
  if (options.counts.empty()) throw std::invalid_argument("choose_lobes: no number of lobes");
  for (const int count : options.counts) {
    if (count < 1 || count > kMaxLobes) throw std::invalid_argument("choose_lobes: 1 to 16 lobes");
  }
}

}  // namespace

double Candidate::error() const {
  return sum(errors);
}

double LobeChoice::error_without() const {
  return sum(errors_without);
}

std::vector<std::vector<std::size_t>> light_folds(std::span<const Vec3> directions, int folds) {
  std::vector<std::size_t> order(directions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Vec3& p = directions[a];
    const Vec3& q = directions[b];
    return std::tie(p.z, p.x, p.y) < std::tie(q.z, q.x, q.y);
  });
  const std::size_t wanted = static_cast<std::size_t>(std::max(folds, 2));
  const std::size_t count = directions.size() <= 2 * wanted ? directions.size() : wanted;
  std::vector<std::vector<std::size_t>> result(count);
  for (std::size_t k = 0; k < order.size(); ++k) result[k % count].push_back(order[k]);
  for (std::vector<std::size_t>& fold : result) std::sort(fold.begin(), fold.end());
  return result;
}

namespace {

// Lobes searched on all the lights given, by their number; where there are too few lights, none.
std::map<int, LobeSearchResult> searched(std::span<const ResidualClass> classes,
                                         std::span<const Vec3> directions, const std::vector<int>& counts,
                                         const ChoiceOptions& options) {
  std::vector<int> wanted;
  for (const int count : counts) {
    const bool enough = directions.size() >= kLightsPerSearchedLobe * static_cast<std::size_t>(count);
    if (options.optimise && enough) wanted.push_back(count);
  }
  std::vector<LobeSearchResult> found(wanted.size());
  tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t k) {
    found[k] = search_lobes(classes, directions, wanted[k], options.search);
  });
  std::map<int, LobeSearchResult> by_count;
  for (std::size_t k = 0; k < wanted.size(); ++k) by_count[wanted[k]] = std::move(found[k]);
  return by_count;
}

// Of a fold, a search that goes on from where all lights led to: a few steps undo what is left of the lights
// held out.
LobeSet lobes_of(const Candidate& candidate, std::span<const ResidualClass> classes,
                 std::span<const Vec3> directions, const std::map<int, LobeSearchResult>& starts,
                 const ChoiceOptions& options) {
  if (!candidate.optimised) return best_uniform(classes, directions, candidate.count).lobes;
  LobeSearchOptions search = options.search;
  search.start = starts.at(candidate.count).lobes;
  search.start_ridge = starts.at(candidate.count).ridge;
  search.iterations = std::min(search.iterations, kFoldIterations);
  return search_lobes(classes, directions, candidate.count, search).lobes;
}

}  // namespace

LobeChoice choose_lobes(const ProblemOf& problem_of, std::span<const Vec3> directions,
                        const ChoiceOptions& options) {
  return std::move(choose_lobes_each(problem_of, directions, {options.counts}, options).front());
}

std::vector<LobeChoice> choose_lobes_each(const ProblemOf& problem_of, std::span<const Vec3> directions,
                                          const std::vector<std::vector<int>>& groups,
                                          const ChoiceOptions& options) {
  std::vector<int> counts;
  for (const std::vector<int>& group : groups) {
    ChoiceOptions checked = options;
    checked.counts = group;
    check(directions, checked);
    counts.insert(counts.end(), group.begin(), group.end());
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());

  const TexelProblem problem = problem_of(all_but(directions.size(), {}));
  const std::vector<ResidualClass> classes = residual_classes(problem, directions, options.classes);
  const std::map<int, LobeSearchResult> starts = searched(classes, directions, counts, options);

  const std::vector<std::vector<std::size_t>> folds = light_folds(directions, options.folds);
  std::vector<double> without(folds.size());
  std::vector<Candidate> candidates;
  for (const int count : counts) {
    candidates.push_back({count, false, std::vector<double>(folds.size())});
    if (starts.contains(count)) candidates.push_back({count, true, std::vector<double>(folds.size())});
  }
  tbb::parallel_for(std::size_t{0}, folds.size(), [&](std::size_t f) {
    if (options.check) options.check();
    const std::vector<std::size_t> rest = all_but(directions.size(), folds[f]);
    const TexelProblem whole = problem_of(rest);
    const Part training = {with_lights(whole, rest), chosen(directions, rest)};
    const Part held_out = {with_lights(whole, folds[f]), chosen(directions, folds[f])};
    const std::vector<ResidualClass> seen =
        residual_classes(training.problem, training.directions, options.classes);
    without[f] = error_under(held_out.problem, {});
    for (Candidate& candidate : candidates) {
      candidate.errors[f] =
          held_out_error(lobes_of(candidate, seen, training.directions, starts, options), training, held_out);
    }
  });

  std::vector<LobeChoice> choices;
  for (const std::vector<int>& group : groups) {
    LobeChoice choice;
    choice.errors_without = without;
    choice.squared_modulation = mean_squared_modulation(problem);
    for (const Candidate& candidate : candidates) {
      if (std::ranges::find(group, candidate.count) != group.end()) choice.candidates.push_back(candidate);
    }
    if (const Candidate* picked = pick(choice.candidates, without, options.tolerance)) {
      choice.optimised = picked->optimised;
      choice.search =
          picked->optimised ? starts.at(picked->count) : best_uniform(classes, directions, picked->count);
      choice.lobes = choice.search.lobes;
      choice.ridge = choose_ridge(choice.lobes, directions, problem).ridge;
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace brdfit::bake
