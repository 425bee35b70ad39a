// Growing and pruning a set of groups.
#include "fit/select.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace brdfit::fit {
namespace {

using Request = CrossValidation::Request;

// Fresh starts of a fit that has others to begin from too, and of one that has little or nothing.
constexpr int kFewStarts = 1;
constexpr int kManyStarts = 3;
// Everything together is searched well and first, as others begin from what is found: where its fits end
// beside the minimum, a group that matters looks as if it could be missed.
constexpr int kStartsOfAll = 6;
constexpr int kKickRoundsOfAll = 2;

// The error may rise by this share of the threshold when groups are removed. Less than all of it: fits of few
// samples overfit and blocks differ, so what a group is worth is seen to be less than it is, and on cells
// that are new the set must still be within the threshold of everything.
constexpr double kRemovalShare = 0.25;

// A group without which the error is beyond the bound by more than this share is not tried again when others
// have gone: it will hardly be missed less.
constexpr double kNeeded = 0.05;

constexpr std::size_t kSamplesOfLadder = 2400;

class Selector {
 public:
  Selector(CrossValidation& validation, Model model, const SelectionOptions& options)
      : validation_(validation), model_(model), options_(options), set_(options.required) {}

  Selection run() {
    result_.required = set_;
    result_.threshold = options_.threshold;
    validation_.fit({{set_, {}, kManyStarts}});
    if (options_.usable != set_) {
      validation_.fit({{options_.usable, {}, kStartsOfAll, 0, kKickRoundsOfAll}});
    }
    while (grow()) {
    }
    compare_with_all();
    do {
      // What was not worth its place before may be after others have gone. The bound of pruning only falls
      // and growing goes below it, so this ends.
      do {
        while (prune()) {
        }
      } while (grow());
    } while (compare_with_all());
    result_.chosen = set_;
    result_.held_out_without = validation_.held_out(options_.required);
    write_errors();
    result_.held_out = validation_.held_out(set_);
    result_.held_out_all = validation_.held_out(options_.usable);
    result_.parameters = validation_.free_numbers(set_);
    result_.parameters_without = validation_.free_numbers(options_.required);
    result_.parameters_all = validation_.free_numbers(options_.usable);
    result_.sets = static_cast<int>(validation_.sets());
    result_.evaluations = validation_.evaluations();
    return std::move(result_);
  }

 private:
  struct Move {
    Groups groups;
    Groups set;            // after it
    std::size_t head = 0;  // the group that it is about; the others refine it
  };

  void step_to(const Move& move, bool removed) {
    LadderStep step;
    step.groups = names_of_groups(model_, move.groups);
    step.removed = removed;
    step.parameters = validation_.free_numbers(move.set) - validation_.free_numbers(set_);
    step.set = move.set;
    result_.ladder.push_back(std::move(step));
    if (!removed) needed_ = Groups();
    before_ = set_;
    set_ = move.set;
  }

  void write_errors() {
    HeldOut before = result_.held_out_without;
    for (LadderStep& step : result_.ladder) {
      const HeldOut after = validation_.held_out(step.set);
      step.held_out_before_pct = before.log_ratio_pct;
      step.held_out_after_pct = after.log_ratio_pct;
      step.standard_error_pct = standard_error_of_difference(before, after);
      before = after;
    }
  }

  const Move& best_of(const std::vector<Move>& moves) const {
    return *std::ranges::min_element(moves, {}, [&](const Move& m) { return validation_.error(m.set); });
  }

  std::vector<Move> additions() const {
    std::vector<Move> moves;
    for (std::size_t k = 0; k < groups_of(model_).size(); ++k) {
      if (groups_of(model_)[k].refines || !options_.usable.has(k) || set_.has(k)) continue;
      const Groups family = family_of(model_, k) & options_.usable;
      moves.push_back({family, set_ | family, k});
    }
    return moves;
  }

  bool grow() {
    const std::vector<Move> moves = additions();
    if (moves.empty()) return false;
    std::vector<Request> requests;
    for (const Move& move : moves) {
      // Fresh values alternate in sign from origin to origin: what has a sign is tried with both.
      Request request = {move.set, {{set_, {}}}, kFewStarts};
      if (effects_of_groups(model_, move.groups).has(Effect::kSmoothTerminator)) {
        request.origins.push_back({set_, {}});
      }
      for (const Groups donor : {before_ | move.groups, options_.usable}) {
        if (validation_.knows(donor)) request.origins.push_back({set_, donor});
      }
      // From everything, less what is off: where effects are together they may stand elsewhere than one by
      // one.
      request.origins.push_back({options_.usable, {}});
      requests.push_back(std::move(request));
    }
    validation_.fit(requests);
    settle_in(moves);
    const Move& best = best_of(moves);
    if (!(validation_.error(best.set) < (1.0 - options_.threshold) * validation_.error(set_))) return false;
    step_to(best, false);
    return true;
  }

  // The set itself again, from what was found for sets around it: else a gain may be no more than a better
  // minimum.
  void settle_in(const std::vector<Move>& moves) {
    Request request = {set_, {}, 0};
    for (const Move& move : moves) request.origins.push_back({move.set, {}});
    validation_.fit({request});
  }

  // From a set's own fits with one effect anew, or the three that shape the diffuse side: a descent does not
  // take a term out of a wrong role, or across to the other sign.
  std::vector<CrossValidation::Origin> kicks_of(Groups set) const {
    const Groups shape = groups_of_effects(model_, Effects()
                                                       .with(Effect::kDiffuseFresnel)
                                                       .with(Effect::kRetroreflection)
                                                       .with(Effect::kSmoothTerminator)) &
                         set;
    std::vector<CrossValidation::Origin> origins;
    if (!shape.empty()) origins.push_back({set, {}, shape});
    for (std::size_t k = 0; k < groups_of(model_).size(); ++k) {
      if (set.has(k) && !groups_of(model_)[k].refines)
        origins.push_back({set, {}, family_of(model_, k) & set});
    }
    return origins;
  }

  // Begins again from everything where that is better by more than the threshold. Everything is fitted from
  // what was found so far too: its error must not be that of a poor minimum.
  bool compare_with_all() {
    const Groups all = options_.usable;
    if (all == set_) return false;
    validation_.fit({{all, {{set_, {}}, {set_, {}}, {set_, all}}, 0}});
    validation_.fit({{all, kicks_of(all), 0}});
    std::vector<CrossValidation::Origin> origins = kicks_of(set_);
    origins.push_back({all, {}});
    validation_.fit({{set_, origins, 0}});
    if (!(validation_.error(set_) > (1.0 + options_.threshold) * validation_.error(all))) return false;
    step_to({all.without(set_), all, 0}, false);
    return true;
  }

  std::vector<Move> removals(Groups from) const {
    std::vector<Move> moves;
    for (std::size_t k = 0; k < groups_of(model_).size(); ++k) {
      if (!from.has(k)) continue;
      const Groups family = family_of(model_, k) & from;
      if (!(family & options_.required).empty()) continue;
      moves.push_back({family, from.without(family), k});
    }
    return moves;
  }

  double bound() const {
    double least = std::min(validation_.error(set_), least_);
    least = std::min(least, validation_.error(options_.usable));
    return (1.0 + kRemovalShare * options_.threshold) * least;
  }

  bool prune() {
    least_ = std::min(least_, validation_.error(set_));
    std::vector<Move> moves = removals(set_);
    std::erase_if(moves, [&](const Move& move) { return needed_.has(move.head); });
    if (moves.empty()) return false;
    std::vector<Request> requests;
    for (const Move& move : moves) {
      requests.push_back({move.set, {{set_, {}}}, move.groups.size() > 1 ? kFewStarts : 0});
    }
    validation_.fit(requests);
    for (const Move& move : moves) {
      if (validation_.error(move.set) > (1.0 + kNeeded) * bound()) needed_ = needed_.with(move.head);
    }
    const Move& best = best_of(moves);
    if (!(validation_.error(best.set) <= bound())) return false;
    step_to(best, true);
    return true;
  }

  CrossValidation& validation_;
  Model model_;
  const SelectionOptions& options_;
  Groups set_;
  Groups before_;
  Groups needed_;  // that pruning need not try again
  double least_ = std::numeric_limits<double>::infinity();
  Selection result_;
};

}  // namespace

Selection select_groups(CrossValidation& validation, Model model, const SelectionOptions& options) {
  return Selector(validation, model, options).run();
}

void fit_ladder(const CrossValidation& validation, const SampleSet& samples, Selection& selection) {
  const SampleSet part = samples.thinned((samples.size() + kSamplesOfLadder - 1) / kSamplesOfLadder);
  tbb::parallel_for(std::size_t{0}, selection.ladder.size() + 1, [&](std::size_t k) {
    if (k == 0) {
      selection.material_without = validation.fitted_to(part, selection.required);
    } else {
      LadderStep& step = selection.ladder[k - 1];
      step.material = validation.fitted_to(part, step.set);
    }
  });
}

}  // namespace brdfit::fit
