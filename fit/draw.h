// The samples of a fit, and those of its folds.
#ifndef BRDFIT_FIT_DRAW_H_
#define BRDFIT_FIT_DRAW_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "fit/fit.h"
#include "measured/nested_sample.h"
#include "measured/sampling.h"

namespace brdfit::fit {

// A search looks at a part of the cells of a table, about this many; where the size of the sample is chosen,
// it begins with them. Fewer lose minima, more only cost time.
inline constexpr std::size_t kExploredOfTable = 1600;

// Observations, and the cells that they come from.
struct Drawn {
  SampleSet samples;
  std::vector<std::size_t> cells;
  std::optional<NestedSample> nested;  // whose first sample they are, where the size is chosen
};

// Throws std::invalid_argument when there is nothing to observe. The table must outlive the result.
Drawn draw_samples(const MeasuredTable& table, const FitOptions& options);

// Enough of them for the folds of a choice of groups: the samples themselves, or a larger nested sample,
// which has no check cells either.
Drawn draw_for_folds(const Drawn& drawn);

// Every observed cell.
SampleSet draw_all(const MeasuredTable& table, const FitOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_DRAW_H_
