// One fit per loss, and the judge's choice.
#include "fit/choose_loss.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace brdfit::fit {
namespace {

void add(FitTimings& sum, const FitTimings& more) {
  sum.sample_seconds += more.sample_seconds;
  sum.select_seconds += more.select_seconds;
  sum.explore_seconds += more.explore_seconds;
  sum.refine_seconds += more.refine_seconds;
  sum.evidence_seconds += more.evidence_seconds;
  sum.measure_seconds += more.measure_seconds;
  sum.total_seconds += more.total_seconds;
}

std::string note_of(std::vector<LossTrial> trials) {
  std::ranges::stable_sort(trials, {}, &LossTrial::judged);
  std::string others;
  for (const LossTrial& trial : std::span(trials).subspan(1)) {
    others += fmt::format("{}{:.2f} of {}", others.empty() ? "" : ", ", trial.judged, name_of(trial.loss));
  }
  return fmt::format("fitted under {}, whose spheres differ least from the measured ones: {:.2f} against {}",
                     name_of(trials.front().loss), trials.front().judged, others);
}

}  // namespace

FitResult fit_under_best_loss(const MeasuredTable& table, const FitOptions& options, const Judge& judge) {
  FitOptions one = options;
  FitResult best;
  std::optional<Selection> selection;
  std::vector<LossTrial> trials;
  FitTimings timings;
  for (const Loss loss : all_losses()) {
    one.loss = loss;
    FitResult result = fit(table, one);
    add(timings, result.timings);
    const double judged = judge(result.material);
    if (result.selection) {
      selection = std::move(result.selection);
      one.choose_groups = false;
      one.groups = result.groups;
      one.effects = effects_of_groups(one.model, result.groups);
    }
    const bool is_best = std::ranges::all_of(trials, [&](const LossTrial& t) { return judged < t.judged; });
    trials.push_back({loss, judged});
    if (is_best) best = std::move(result);
  }
  const Loss kept = best.options.loss;
  best.options = options;
  best.options.loss = kept;
  best.selection = std::move(selection);
  best.losses = trials;
  best.notes.push_back(note_of(trials));
  best.timings = timings;
  return best;
}

}  // namespace brdfit::fit
