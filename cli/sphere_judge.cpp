// Spheres judged, with the time that it takes.
#include "cli/sphere_judge.h"

#include <algorithm>

#include "fit/choose_loss.h"

namespace brdfit::cli {

TableJudge::TableJudge(const MeasuredTable& reference, std::size_t candidates)
    : judge_(reference),
      share_seconds_(watch_.seconds() / static_cast<double>(std::max<std::size_t>(candidates, 1))) {}

JudgedSphere TableJudge::operator()(const render::Subject& candidate) const {
  const Stopwatch watch;
  JudgedSphere result;
  result.delta_e = judge_(candidate);
  result.seconds = share_seconds_ + watch.seconds();
  return result;
}

fit::FitResult fit_as_asked(const MeasuredTable& table, const fit::FitOptions& options,
                            const TableJudge& judge) {
  if (!options.choose_loss) return fit::fit(table, options);
  return fit::fit_under_best_loss(
      table, options, [&judge](const Material& material) { return judge(material).delta_e.mean; });
}

fit::FitResult fit_part(const MeasuredTable& part, const fit::FitOptions& options) {
  if (!options.choose_loss) return fit::fit(part, options);
  return fit_as_asked(part, options, TableJudge(part, 1));
}

JudgedFit fit_and_judge(const MeasuredTable& table, const fit::FitOptions& options, const TableJudge& judge) {
  JudgedFit result;
  result.fit = fit_as_asked(table, options, judge);
  result.sphere = judge(result.fit.material);
  if (options.held_out_folds > 0) {
    const Stopwatch watch;
    result.held_out = fit::evaluate_held_out(table, options, fit_part);
    result.held_out_seconds = watch.seconds();
  }
  return result;
}

}  // namespace brdfit::cli
