// Lobe sets compared under lights held out, everything redone without them.
#include "bake/choose_lobes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "bake/ridge.h"
#include "bake/solve.h"

namespace brdfit::bake {
namespace {

// Fewer lights per lobe than this cannot carry the five parameters that a search gives each lobe.
constexpr std::size_t kLightsPerSearchedLobe = 6;
// Lobes must help in this share of the folds: where they fail they may fail by far.
constexpr double kHelpedFolds = 0.75;
// Gains of a smaller share of the squared error are not worth a texture.
constexpr double kLeastGain = 2e-3;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

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
  const auto folds = static_cast<double>(without.size());
  const double mean = (sum(without) - candidate.error()) / folds;
  double squares = 0.0;
  double helped = 0.0;
  for (std::size_t f = 0; f < without.size(); ++f) {
    const double gain = without[f] - candidate.errors[f];
    if (gain > 0.0) helped += 1.0;
    squares += (gain - mean) * (gain - mean);
  }
  const double error = std::sqrt(squares / (folds * std::max(folds - 1.0, 1.0)));
  return helped >= kHelpedFolds * folds && mean > std::max(error, kLeastGain * sum(without) / folds);
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

LobeChoice choose_lobes(const ProblemOf& problem_of, std::span<const Vec3> directions,
                        const ChoiceOptions& options) {
  check(directions, options);
  const std::vector<std::vector<std::size_t>> folds = light_folds(directions, options.folds);
  LobeChoice choice;
  choice.errors_without.resize(folds.size());
  for (const int count : options.counts) {
    choice.candidates.push_back({count, false, std::vector<double>(folds.size())});
    const bool enough = directions.size() >= kLightsPerSearchedLobe * static_cast<std::size_t>(count);
    if (options.optimise && enough)
      choice.candidates.push_back({count, true, std::vector<double>(folds.size())});
  }
  tbb::parallel_for(std::size_t{0}, folds.size(), [&](std::size_t f) {
    const std::vector<std::size_t> rest = all_but(directions.size(), folds[f]);
    const TexelProblem whole = problem_of(rest);
    const Part training = {with_lights(whole, rest), chosen(directions, rest)};
    const Part held_out = {with_lights(whole, folds[f]), chosen(directions, folds[f])};
    const std::vector<ResidualClass> classes =
        residual_classes(training.problem, training.directions, options.classes);
    choice.errors_without[f] = error_under(held_out.problem, {});
    for (Candidate& candidate : choice.candidates) {
      const LobeSet lobes =
          candidate.optimised
              ? search_lobes(classes, training.directions, candidate.count, options.search).lobes
              : best_uniform(classes, training.directions, candidate.count).lobes;
      candidate.errors[f] = held_out_error(lobes, training, held_out);
    }
  });

  const TexelProblem problem = problem_of(all_but(directions.size(), {}));
  choice.squared_modulation = mean_squared_modulation(problem);
  const Candidate* picked = pick(choice.candidates, choice.errors_without, options.tolerance);
  if (picked == nullptr) return choice;
  const std::vector<ResidualClass> classes = residual_classes(problem, directions, options.classes);
  choice.optimised = picked->optimised;
  choice.search = picked->optimised ? search_lobes(classes, directions, picked->count, options.search)
                                    : best_uniform(classes, directions, picked->count);
  choice.lobes = choice.search.lobes;
  choice.ridge = choose_ridge(choice.lobes, directions, problem).ridge;
  return choice;
}

}  // namespace brdfit::bake
