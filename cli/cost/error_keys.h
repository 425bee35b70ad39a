// The errors of points by their keys, and what people call them.
#ifndef BRDFIT_CLI_COST_ERROR_KEYS_H_
#define BRDFIT_CLI_COST_ERROR_KEYS_H_

#include <string>
#include <vector>

namespace brdfit::cli {

inline constexpr const char* kTableLeadingError = "table_log_ratio_pct";

// The keys of CostPoint::errors of a table: slice_ and table_ with every measure, sphere_delta_e,
// reciprocity_gap_pct, and with folds held_out_ with every measure over cells. The measures of the table are
// over every valid cell, of which a fit to a sample has seen a few percent. Held-out errors are those of fits
// to the table without a fold of blocks of angles, on that fold, as `brdfit fit --held-out` measures them:
// means over folds.
std::vector<std::string> table_error_keys(int folds);

// "log-ratio % on the table", for people; the key itself where it is not one of those.
std::string error_title(const std::string& key);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_ERROR_KEYS_H_
