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

JudgedFit fit_and_judge(const MeasuredTable& table, const fit::FitOptions& options, const TableJudge& judge) {
  JudgedFit result;
  if (options.choose_loss) {
    result.fit = fit::fit_under_best_loss(
        table, options, [&judge](const Material& material) { return judge(material).delta_e.mean; });
  } else {
    result.fit = fit::fit(table, options);
  }
  result.sphere = judge(result.fit.material);
  return result;
}

}  // namespace brdfit::cli
