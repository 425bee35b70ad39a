// Starts, stages and kicks.
#include "fit/explore.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "fit/descend.h"
#include "fit/plateau.h"
#include "fit/starts.h"

namespace brdfit::fit {
namespace {

// Strong damping at first keeps a start in its own valley; the tolerances are those of a search.
constexpr double kFirstDamping = 0.1;
constexpr DescentOptions kStage = {8, 1e-3, kFirstDamping};
constexpr DescentOptions kJoint = {30, 1e-4, kFirstDamping};
constexpr DescentOptions kPolish = {60, 1e-7, kFirstDamping};
constexpr std::size_t kParents = 4;   // that are kicked in a round
constexpr std::size_t kPolished = 6;  // of the candidates in the end
// Candidates whose costs differ by less than this share are taken for the same minimum.
constexpr double kSameValley = 0.01;
// How many stages it takes for all rounds of kicks: with fewer there is less to kick, and a kick of
// everything would be a start.
constexpr int kAllStages = 5;

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

void advance(const Problem& problem, Candidate& candidate, const Box& box, const DescentOptions& options) {
  const int evaluations = candidate.solution.evaluations;
  candidate.solution = descend(problem, candidate.solution.x, box, options);
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

// What a kick draws anew: the parameters of one stage, or of the diffuse gains and what follows them, as
// two gains that share a region are often wrong together.
std::vector<std::vector<std::size_t>> kick_groups(const std::vector<std::vector<std::size_t>>& stages) {
  std::vector<std::vector<std::size_t>> groups = stages;
  if (stages.size() < 3) return groups;
  std::vector<std::size_t> shape;
  for (std::size_t k = 2; k < stages.size(); ++k)
    shape.insert(shape.end(), stages[k].begin(), stages[k].end());
  groups.push_back(shape);
  return groups;
}

// The best candidates of different cost, at most count of them: others are mostly the same minimum found
// twice.
std::vector<std::size_t> distinct_costs(const std::vector<Candidate>& candidates, std::size_t count,
                                        double relative_difference) {
  std::vector<std::size_t> picked;
  for (std::size_t k = 0; k < candidates.size() && picked.size() < count; ++k) {
    const double cost = candidates[k].solution.cost;
    if (picked.empty() || cost > candidates[picked.back()].solution.cost * (1.0 + relative_difference)) {
      picked.push_back(k);
    }
  }
  return picked;
}

// To the bottom of the valley.
void advance_to_bottom(const Problem& problem, Candidate& candidate) {
  descend_past_plateau(problem.parametrisation(), candidate,
                       [&](Candidate& each) { advance(problem, each, each.box, kPolish); });
}

// Brings the best candidates to the bottom of their valleys, so that they can be told apart.
void polish(const Problem& problem, std::vector<Candidate>& candidates) {
  const std::vector<std::size_t> picked = distinct_costs(candidates, kPolished, kSameValley);
  tbb::parallel_for(std::size_t{0}, picked.size(),
                    [&](std::size_t k) { advance_to_bottom(problem, candidates[picked[k]]); });
  sort_best_first(candidates);
}

}  // namespace

std::vector<Candidate> explore(const Problem& problem, const Problem& wide, const SampleSet& samples,
                               const std::vector<std::vector<double>>& seeds, const ExploreOptions& options) {
  const Parametrisation& parametrisation = problem.parametrisation();
  const std::vector<std::vector<std::size_t>> stages = staging(parametrisation);
  const std::size_t parents =
      std::min<std::size_t>(kParents, static_cast<std::size_t>(options.starts) + seeds.size());
  const std::vector<std::vector<std::size_t>> groups = kick_groups(stages);
  const std::size_t kicks_a_round = parents * groups.size();
  const std::size_t starts = static_cast<std::size_t>(options.starts);
  const int rounds = options.kick_rounds * (static_cast<int>(stages.size()) - 1) / (kAllStages - 1);
  const std::vector<std::vector<double>> points = make_starts(
      parametrisation, samples, options.starts + rounds * static_cast<int>(kicks_a_round), options.seed);
  std::vector<Candidate> candidates(seeds.size() + starts);
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t k) {
    candidates[k] = staged(wide, k < seeds.size() ? seeds[k] : points[k - seeds.size()]);
  });
  sort_best_first(candidates);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Candidate> next(kicks_a_round);
    const std::vector<std::size_t> parent = distinct_costs(candidates, parents, kSameValley);
    const std::size_t first_point = starts + static_cast<std::size_t>(round) * kicks_a_round;
    tbb::parallel_for(std::size_t{0}, kicks_a_round, [&](std::size_t k) {
      next[k] = kicked(wide, candidates[parent[k / groups.size() % parent.size()]], groups[k % groups.size()],
                       points[first_point + k]);
    });
    candidates.insert(candidates.end(), std::make_move_iterator(next.begin()),
                      std::make_move_iterator(next.end()));
    sort_best_first(candidates);
  }
  polish(problem, candidates);
  return candidates;
}

}  // namespace brdfit::fit
