// Starts, and the descent from each.
#include "bake/lobe_search.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/k_means.h"
#include "bake/lobe_objective.h"

namespace brdfit::bake {
namespace {

constexpr std::array<double, 4> kOverlaps = {0.25, 0.45, 0.65, 0.8};
constexpr std::array<double, 4> kRidges = {1e-3, 1e-2, 1e-1, 1.0};

class CeresObjective : public ceres::FirstOrderFunction {
 public:
  explicit CeresObjective(const LobeObjective& objective) : objective_(objective) {}
  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const auto count = static_cast<std::size_t>(objective_.parameters());
    *cost = objective_.evaluate({parameters, count}, gradient);
    return std::isfinite(*cost);
  }
  int NumParameters() const override { return objective_.parameters(); }

 private:
  const LobeObjective& objective_;
};

struct Start {
  LobeSet lobes;
  double ridge;
  const char* name;
};

LobeSearchResult descend(const LobeObjective& objective, const Start& start, int iterations) {
  std::vector<double> parameters = objective.pack(start.lobes, start.ridge);
  const ceres::GradientProblem problem(new CeresObjective(objective));  // which takes it over
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::LBFGS;
  options.max_num_iterations = iterations;
  options.function_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, parameters.data(), &summary);
  LobeSearchResult result;
  result.lobes = objective.lobes(parameters);
  result.ridge = objective.ridge(parameters);
  result.objective = summary.final_cost;
  result.start = start.name;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.evaluations = summary.num_cost_evaluations + summary.num_gradient_evaluations;
  return result;
}

// Clusters of the lights, weighted by the residual's energy under them.
LobeSet cluster_lobes(std::span<const ResidualClass> classes, std::span<const Vec3> directions,
                      const LobeSet& uniform, std::uint64_t seed) {
  std::vector<double> energies(directions.size(), 0.0);
  for (const ResidualClass& c : classes) {
    for (std::size_t l = 0; l < directions.size(); ++l) {
      energies[l] += c.factor.row(static_cast<Eigen::Index>(l)).squaredNorm();
    }
  }
  const Clusters clusters = k_means(directions, energies, static_cast<int>(uniform.size()), seed);
  LobeSet lobes = uniform;  // what clusters do not fill stays
  for (std::size_t k = 0; k < clusters.centres.size(); ++k) {
    const Vec3& c = clusters.centres[k];
    const double length = std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z);
    if (length > 1e-6) lobes[k].axis = {c.x / length, c.y / length, c.z / length};
  }
  return lobes;
}

}  // namespace

LobeSearchResult best_uniform(std::span<const ResidualClass> classes, std::span<const Vec3> directions,
                              int count) {
  const Cap cap = cap_of(directions);
  LobeSearchResult best;
  best.start = "uniform";
  best.converged = true;
  best.uniform = best.lobes = uniform_lobes(count, cap);
  best.ridge = 1.0;
  if (classes.empty()) return best;
  const LobeObjective objective(classes, count, bounds_of(directions));
  best.objective = std::numeric_limits<double>::infinity();
  for (const double overlap : kOverlaps) {
    const LobeSet lobes = uniform_lobes(count, cap, overlap);
    for (const double ridge : kRidges) {
      const double value = objective.evaluate(lobes, ridge);
      ++best.evaluations;
      if (value >= best.objective) continue;
      best.objective = best.start_objective = value;
      best.lobes = best.uniform = lobes;
      best.ridge = ridge;
    }
  }
  return best;
}

LobeSearchResult search_lobes(std::span<const ResidualClass> classes, std::span<const Vec3> directions,
                              int count, const LobeSearchOptions& options) {
  const LobeSearchResult uniform = best_uniform(classes, directions, count);
  if (classes.empty()) return uniform;
  std::vector<Start> starts = {{uniform.lobes, uniform.ridge, "uniform"}};
  const bool is_given = options.start.size() == static_cast<std::size_t>(count);
  if (is_given) starts = {{options.start, options.start_ridge, "given"}};
  for (int k = 0; k < options.cluster_starts && !is_given; ++k) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
    starts.push_back({cluster_lobes(classes, directions, uniform.lobes, seed), uniform.ridge, "clusters"});
  }
  const LobeObjective objective(classes, count, bounds_of(directions));
  std::vector<LobeSearchResult> ends(starts.size());
  tbb::parallel_for(std::size_t{0}, starts.size(),
                    [&](std::size_t k) { ends[k] = descend(objective, starts[k], options.iterations); });
  LobeSearchResult best = uniform;
  for (LobeSearchResult& end : ends) {
    best.evaluations += end.evaluations;
    if (!(end.objective < best.objective)) continue;
    best.lobes = std::move(end.lobes);
    best.ridge = end.ridge;
    best.objective = end.objective;
    best.start = end.start;
    best.converged = end.converged;
  }
  return best;
}

}  // namespace brdfit::bake
