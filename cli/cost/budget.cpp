// Choices under limits.
#include "cli/cost/budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/cost/error_keys.h"
#include "cli/cost/pareto.h"

namespace brdfit::cli {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double upper(const RepeatedTime& time) {
  return time.is_measured() ? time.high_quartile : kInfinity;
}

double or_infinity(double value) {
  return std::isnan(value) ? kInfinity : value;
}

bool is_choice(const CostPoint& point) {
  return point.sweep != "device";
}

// What counts beside the error.
std::vector<CostFigure> limited_figures(const Limits& limits) {
  std::vector<CostFigure> figures;
  const bool only_error = !limits.evaluation_ns && !limits.make_seconds && !limits.bytes;
  if (limits.evaluation_ns || only_error) figures.emplace_back(evaluation_ns_of);
  if (limits.make_seconds) figures.emplace_back(make_seconds_of);
  if (limits.bytes) figures.emplace_back(bytes_of);
  return figures;
}

double largest_ratio(const std::vector<Excess>& excess) {
  double largest = 0.0;
  for (const Excess& one : excess) largest = std::max(largest, one.value / one.limit);
  return largest;
}

std::string excess_text(const std::vector<Excess>& excess, const std::string& leading_error) {
  std::string text;
  for (const Excess& one : excess) {
    const std::string what = one.what == "error" ? error_title(leading_error) : one.what;
    text += fmt::format("{}{} {:.3g} over {:g}", text.empty() ? "" : ", ", what, one.value, one.limit);
  }
  return text;
}

std::string figures_text(const CostPoint& point, const std::string& leading_error) {
  std::string text = fmt::format("{} {:.3g}", error_title(leading_error), error_of(point, leading_error));
  const auto add = [&](const RepeatedTime& time, const char* unit) {
    if (time.is_measured())
      text += fmt::format(", {:.3g} {} (upper quartile {:.3g})", time.median, unit, time.high_quartile);
  };
  add(point.evaluation_ns, "ns an evaluation");
  add(point.make_seconds, "s to make");
  return text + fmt::format(", {:g} bytes", point.bytes);
}

}  // namespace

std::vector<Excess> excess_over(const Limits& limits, const CostPoint& point,
                                const std::string& leading_error) {
  std::vector<Excess> excess;
  const auto check = [&](const char* what, double value, const std::optional<double>& limit) {
    if (limit && !(value <= *limit)) excess.push_back({what, value, *limit});
  };
  check("evaluation_ns", upper(point.evaluation_ns), limits.evaluation_ns);
  check("bytes", or_infinity(point.bytes), limits.bytes);
  check("make_seconds", upper(point.make_seconds), limits.make_seconds);
  check("error", or_infinity(error_of(point, leading_error)), limits.error);
  return excess;
}

std::vector<std::size_t> choices_under(const Limits& limits, const CostRun& run) {
  std::vector<std::size_t> places;
  std::vector<CostPoint> points;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    if (!is_choice(run.points[k])) continue;
    places.push_back(k);
    points.push_back(run.points[k]);
  }
  const CostFigure error = [&run](const CostPoint& point) { return error_of(point, run.leading_error); };
  std::vector<CostFigure> figures = limited_figures(limits);
  const CostFigure best = limits.error ? figures.front() : error;
  figures.push_back(error);
  const std::vector<bool> front = front_of(points, figures);
  std::vector<std::size_t> choices;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (front[k] && excess_over(limits, points[k], run.leading_error).empty()) choices.push_back(places[k]);
  }
  std::ranges::stable_sort(choices, {}, [&](std::size_t k) { return best(run.points[k]); });
  return choices;
}

std::size_t nearest_to(const Limits& limits, const CostRun& run) {
  std::size_t nearest = 0;
  double least = kInfinity;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    if (!is_choice(run.points[k])) continue;
    const double ratio = largest_ratio(excess_over(limits, run.points[k], run.leading_error));
    if (ratio < least) {
      least = ratio;
      nearest = k;
    }
  }
  return nearest;
}

BudgetAnswer spend(const Limits& limits, const CostRun& run, const MeasureAgain& measure_again) {
  BudgetAnswer answer;
  for (const std::size_t choice : choices_under(limits, run)) {
    BudgetTrial trial = {choice, measure_again(run.points[choice]), {}};
    trial.excess = excess_over(limits, trial.again, run.leading_error);
    answer.trials.push_back(std::move(trial));
    if (answer.trials.back().excess.empty()) {
      answer.point = choice;
      return answer;
    }
  }
  answer.nearest = nearest_to(limits, run);
  return answer;
}

std::string budget_text(const BudgetAnswer& answer, const Limits& limits, const CostRun& run) {
  std::string text;
  for (const BudgetTrial& trial : answer.trials) {
    const std::string& name = run.points[trial.point].name;
    if (trial.excess.empty()) {
      text += fmt::format("Under the limits {} is best. Measured again: {}.", name,
                          figures_text(trial.again, run.leading_error));
    } else {
      text += fmt::format("{} kept the limits, but not when measured again ({}). ", name,
                          excess_text(trial.excess, run.leading_error));
    }
  }
  if (answer.point) return text;
  const CostPoint& nearest = run.points[answer.nearest];
  const std::vector<Excess> excess = excess_over(limits, nearest, run.leading_error);
  return text + fmt::format("No point keeps the limits. Nearest is {}{}{}.", nearest.name,
                            excess.empty() ? ", which keeps them only at times" : ": ",
                            excess_text(excess, run.leading_error));
}

}  // namespace brdfit::cli
