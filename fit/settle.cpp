// Greedy moves to defaults.
#include "fit/settle.h"

#include <algorithm>
#include <ranges>

#include "fit/descend.h"
#include "fit/reasons.h"
#include "fit/ties.h"

namespace brdfit::fit {
namespace {

// Enough to see whether the others can make up for a default.
constexpr DescentOptions kSettling = {12, 0.1 * kSettlingShare, 1e-4};
// Attempts in vain before the rest is only tried as it stands: each costs as much as a refinement.
constexpr int kMostFailures = 3;

class Settling {
 public:
  Settling(const Problem& problem, const Problem& rough, const Solution& solution, const Box& box)
      : problem_(problem),
        rough_(rough),
        parametrisation_(problem.parametrisation()),
        defaults_(parametrisation_.from_material(Material(parametrisation_.start.model()))),
        limit_(solution.cost * (1.0 + kSettlingShare)) {
    settled_.solution = solution;
    settled_.box = box;
    settled_.at_default.assign(parametrisation_.size(), false);
    look();
    first_ = settled_.identifiability;
  }

  Settled run() && {
    hold_what_is_there();
    const std::vector<std::string> order = public_order();
    // What was tried in vain may go once something else has gone, but most often does not.
    const bool moved =
        std::ranges::count_if(order, [&](const std::string& name) { return try_one(name); }) > 0;
    if (moved) finish();
    keep_unidentifiable();
    settled_.identifiability.unseen = first_.unseen;
    settled_.reasons = reasons_of(parametrisation_, settled_.solution.x, first_, settled_.identifiability);
    return std::move(settled_);
  }

 private:
  // What is settled no longer ties others.
  void look() {
    const std::vector<double>& x = settled_.solution.x;
    if (x != curvature_at_) {
      curvature_ = problem_.curvature(x);
      curvature_at_ = x;
      ++settled_.evaluations;
    }
    settled_.identifiability = identify(parametrisation_, x, curvature_, settled_.at_default);
    add_hidden_ties(parametrisation_, x, settled_.box, curvature_, settled_.at_default,
                    settled_.identifiability);
  }

  std::vector<std::string> public_order() const {
    std::vector<std::string> order = {"metallic"};
    for (const ParameterInfo& info : parameters_of(parametrisation_.start.model()) | std::views::reverse) {
      if (info.name != "metallic" && info.name != "base_color") order.emplace_back(info.name);
    }
    return order;
  }

  // Numbers of a public parameter that are unidentifiable with the others as they are now.
  std::vector<std::size_t> unidentifiable_of(const std::string& name) const {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < parametrisation_.size(); ++k) {
      if (parametrisation_.free[k].parameter == name && !settled_.at_default[k] &&
          settled_.identifiability.status[k] == Status::kUnidentifiable) {
        numbers.push_back(k);
      }
    }
    return numbers;
  }

  bool try_one(const std::string& name) {
    const std::vector<std::size_t> numbers = unidentifiable_of(name);
    if (numbers.empty()) return false;
    Box box = settled_.box;
    std::vector<double> x = settled_.solution.x;
    for (const std::size_t k : numbers) {
      if (defaults_[k] < box.lower[k] || defaults_[k] > box.upper[k]) return false;
      x[k] = defaults_[k];
      box.moves[k] = false;
    }
    Solution trial = settled_.solution;
    trial.x = x;
    trial.cost = problem_.cost(x);
    ++settled_.evaluations;
    if (!(trial.cost <= limit_) && failures_ < kMostFailures) {
      DescentOptions descent = kSettling;
      descent.goal = limit_;
      trial = descend(rough_, x, box, descent);
      trial.cost = problem_.cost(trial.x);
      settled_.evaluations += trial.evaluations + 1;
    }
    if (!(trial.cost <= limit_)) {
      ++failures_;
      return false;
    }
    settled_.solution.x = trial.x;
    settled_.solution.cost = trial.cost;
    settled_.box = box;
    for (const std::size_t k : numbers) settled_.at_default[k] = true;
    look();
    return true;
  }

  // What stands at its default already settles a tie at no cost.
  void hold_what_is_there() {
    for (const std::string& name : public_order()) {
      const std::vector<std::size_t> numbers = unidentifiable_of(name);
      if (numbers.empty()) continue;
      if (!std::ranges::all_of(numbers,
                               [&](std::size_t k) { return settled_.solution.x[k] == defaults_[k]; })) {
        continue;
      }
      for (const std::size_t k : numbers) {
        settled_.at_default[k] = true;
        settled_.box.moves[k] = false;
      }
      look();
    }
  }

  void finish() {
    const Solution start = settled_.solution;
    settled_.solution = solve_pinning(problem_, start.x, settled_.box, {});
    settled_.evaluations += settled_.solution.evaluations;
    look();
  }

  void keep_unidentifiable() {
    for (std::size_t k = 0; k < parametrisation_.size(); ++k) {
      Status& status = settled_.identifiability.status[k];
      const bool was = first_.status[k] == Status::kUnidentifiable;
      if (settled_.at_default[k] || was) status = Status::kUnidentifiable;
    }
  }

  const Problem& problem_;
  const Problem& rough_;
  const Parametrisation& parametrisation_;
  const std::vector<double> defaults_;
  const double limit_;
  Settled settled_;
  Eigen::MatrixXd curvature_;
  std::vector<double> curvature_at_;
  Identifiability first_;
  int failures_ = 0;
};

}  // namespace

Settled settle_unidentifiable(const Problem& problem, const Problem& rough, const Solution& solution,
                              const Box& box) {
  return Settling(problem, rough, solution, box).run();
}

Settled settle_unidentifiable(const Problem& problem, const Solution& solution, const Box& box) {
  return settle_unidentifiable(problem, problem, solution, box);
}

}  // namespace brdfit::fit
