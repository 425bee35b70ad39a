// Starts, stages and kicks.
#include "fit/explore.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "fit/starts.h"

namespace brdfit::fit {
namespace {

// A short trust region at first keeps a start in its own valley; the tolerances are those of a search.
constexpr SolveOptions kStage = {4, 1e-3, 1e-10, 1e-8, 1.0};
constexpr SolveOptions kJoint = {15, 1e-5, 1e-10, 1e-8, 1.0};
constexpr SolveOptions kPolish = {60, 1e-7, 1e-12, 1e-9, 1.0};
constexpr std::size_t kParents = 3;   // that are kicked in a round
constexpr std::size_t kPolished = 4;  // of the candidates in the end

// Products of one sign stay on the side where they begin.
Box box_for(const Parametrisation& parametrisation, const std::vector<double>& x) {
  Box box = full_box(parametrisation);
  for (const std::size_t k : parametrisation.one_signed) {
    if (x[parametrisation.one_signed.front()] >= 0.0) {
      box.lower[k] = 0.0;
    } else {
      box.upper[k] = 0.0;
    }
  }
  return box;
}

void advance(const Problem& problem, Candidate& candidate, const Box& box, const SolveOptions& options) {
  const int evaluations = candidate.solution.evaluations;
  candidate.solution = solve(problem, candidate.solution.x, box, options);
  candidate.solution.evaluations += evaluations;
}

Box only(const Box& box, const std::vector<std::size_t>& moving) {
  Box result = box;
  result.moves.assign(box.moves.size(), false);
  for (const std::size_t k : moving) result.moves[k] = true;
  return result;
}

Candidate candidate_at(const Problem& problem, const std::vector<double>& x) {
  Candidate candidate;
  candidate.box = box_for(problem.parametrisation(), x);
  candidate.solution.x = x;
  return candidate;
}

// Stage by stage as an artist would, each leaving the earlier alone; then everything at once.
Candidate staged(const Problem& problem, const std::vector<double>& x) {
  Candidate candidate = candidate_at(problem, x);
  for (const std::vector<std::size_t>& stage : staging(problem.parametrisation())) {
    advance(problem, candidate, only(candidate.box, stage), kStage);
  }
  advance(problem, candidate, candidate.box, kJoint);
  return candidate;
}

// One stage's parameters from another point, solved alone and then with the rest.
Candidate kicked(const Problem& problem, const Candidate& parent, const std::vector<std::size_t>& stage,
                 const std::vector<double>& fresh) {
  std::vector<double> x = parent.solution.x;
  for (const std::size_t k : stage) x[k] = fresh[k];
  Candidate candidate = candidate_at(problem, x);
  advance(problem, candidate, only(candidate.box, stage), kStage);
  advance(problem, candidate, candidate.box, kJoint);
  return candidate;
}

void sort_best_first(std::vector<Candidate>& candidates) {
  std::ranges::stable_sort(candidates, {}, [](const Candidate& c) { return c.solution.cost; });
}

// Brings the best candidates to the bottom of their valleys, so that they can be told apart.
void polish(const Problem& problem, std::vector<Candidate>& candidates) {
  const std::size_t count = std::min(kPolished, candidates.size());
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    Candidate& candidate = candidates[k];
    const int evaluations = candidate.solution.evaluations;
    candidate.solution = solve_pinning(problem, candidate.solution.x, candidate.box, kPolish);
    candidate.solution.evaluations += evaluations;
  });
  sort_best_first(candidates);
}

}  // namespace

std::vector<Candidate> explore(const Problem& problem, const Problem& wide, const SampleSet& samples,
                               const std::vector<std::vector<double>>& seeds, const ExploreOptions& options) {
  const Parametrisation& parametrisation = problem.parametrisation();
  const std::vector<std::vector<std::size_t>> stages = staging(parametrisation);
  const std::size_t parents =
      std::min<std::size_t>(kParents, static_cast<std::size_t>(options.starts) + seeds.size());
  const std::size_t kicks_a_round = parents * stages.size();
  const std::size_t starts = static_cast<std::size_t>(options.starts);
  // With fewer stages there is less to kick; a kick of everything would be a start.
  const int rounds = std::min(options.kick_rounds, static_cast<int>(stages.size()) - 1);
  const std::vector<std::vector<double>> points = make_starts(
      parametrisation, samples, options.starts + rounds * static_cast<int>(kicks_a_round), options.seed);
  std::vector<Candidate> candidates(seeds.size() + starts);
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    candidates[k] = staged(wide, k < seeds.size() ? seeds[k] : points[k - seeds.size()]);
  });
  sort_best_first(candidates);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Candidate> next(kicks_a_round);
    const std::size_t first_point = starts + static_cast<std::size_t>(round) * kicks_a_round;
    tbb::parallel_for(std::size_t{0}, kicks_a_round, [&](std::size_t k) {
      next[k] =
          kicked(wide, candidates[k / stages.size()], stages[k % stages.size()], points[first_point + k]);
    });
    candidates.insert(candidates.end(), std::make_move_iterator(next.begin()),
                      std::make_move_iterator(next.end()));
    sort_best_first(candidates);
  }
  polish(problem, candidates);
  return candidates;
}

}  // namespace brdfit::fit
