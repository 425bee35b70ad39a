// Fitting a model to a measured table: options in, material and evidence out.
#ifndef BRDFIT_FIT_FIT_H_
#define BRDFIT_FIT_FIT_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "fit/identifiability.h"
#include "fit/loss.h"
#include "fit/metrics.h"
#include "fit/parameters.h"
#include "fit/sample_size.h"
#include "fit/select.h"
#include "measured/sampling.h"
#include "measured/table.h"

namespace brdfit::fit {

// Valid cells of a table for which the size of a sample is chosen.
inline constexpr std::size_t kLeastToChoose = 8000;

// What a material is fitted to.
enum class FitOn { kTable, kSlices };

std::string_view name_of(FitOn on);  // "table", "slices"
std::optional<FitOn> fit_on_by_name(std::string_view name);

struct FitOptions {
  Model model = Model::kCallisto;
  MaterialOptions material_options;
  Tier tier = Tier::kFull;
  // The effects that the fit may use; all of the model's where absent. (Anisotropy never is: data are
  // isotropic.)
  std::optional<Effects> effects;
  // Finer: the groups (fit/groups.h) of these effects that the fit may use; all where absent.
  std::optional<Groups> groups;
  // Uses of those groups only what lowers the held-out error by more than a threshold; see fit/select.h. A
  // group with a fixed parameter stays on. On slices near phi_d = 90 deg, where cos_i = cos_o, the smooth
  // terminator stays off unless `effects` or `groups` name what may be used.
  bool choose_groups = false;
  double group_threshold = kGroupThreshold;  // a share of the held-out error
  FixedValues fixed;
  // A material to start from, of the same model; its values hold where nothing is free.
  std::optional<Material> init;

  FitOn on = FitOn::kTable;
  std::vector<double> phi_d_deg = {90.0};  // for slices
  double max_theta_deg = 90.0;
  std::size_t samples = 20000;  // cells of the table; kAllSamples for every one
  // In place of `samples` as many cells of the table as change the result; see fit/sample_size.h. A table
  // with fewer than kLeastToChoose valid cells is fitted whole.
  bool choose_samples = false;
  double sample_threshold = kSizeThreshold;  // a share of the held-out error
  Loss loss = Loss::kLogRatio;
  // Asks for the loss whose result looks best; fit() itself takes `loss` (see fit/choose_loss.h).
  bool choose_loss = false;
  // Asks for errors on blocks of angles that nothing of a fit saw; 0 for none, else 2 or more folds. fit()
  // itself does not look at it (see fit/held_out.h).
  int held_out_folds = 0;
  int starts = 0;  // points from which the search begins; 0: 4 to 12, by the number of free parameters
  std::uint64_t seed = 1;

  // Whether the options make sense together and for the model; if not, *why (when not null) says what does
  // not.
  bool is_valid(std::string* why) const;
};

struct FitTimings {
  double sample_seconds = 0.0;
  double select_seconds = 0.0;    // which groups to use
  double explore_seconds = 0.0;   // all starts, on a part of the samples
  double refine_seconds = 0.0;    // the best of them, on all; and how many these must be
  double evidence_seconds = 0.0;  // identifiability, the dielectric test
  double measure_seconds = 0.0;   // error measures on slice and table
  double total_seconds = 0.0;
};

// A loss, and how its result was judged.
struct LossTrial {
  Loss loss = Loss::kLogRatio;
  double judged = 0.0;
};

struct FitResult {
  Material material;
  FitOptions options;
  std::size_t observations = 0;           // cells that were fitted
  std::optional<SampleSize> sample_size;  // how many these had to be, where that was chosen
  double cost = 0.0;  // half of the weighted mean square of the residuals, summed over channels
  int starts = 0;
  int starts_near_best = 0;  // that ended within 5% of the best cost
  int iterations = 0;        // of the published solve
  int evaluations = 0;       // over all solves
  bool converged = false;
  std::string termination;  // in words
  int free_parameters = 0;
  Groups groups;                           // that were used
  std::optional<Selection> selection;      // how they were chosen, where they were
  std::vector<LossTrial> losses;           // that were tried, where the loss was chosen
  std::vector<ParameterState> parameters;  // every free or fixed public parameter
  std::vector<CorrelatedPair> correlated;
  std::vector<std::string> notes;  // what a reader of the result must know, in sentences
  Evaluation evaluation;
  double largest_albedo =
      0.0;  // directional, over channels and angles up to 80 deg; above 1 it is in the notes
  FitTimings timings;
};

// Throws std::invalid_argument when the options are not valid for the model, or no cell is left to fit.
// Parallel over starts with TBB; the result does not depend on the number of threads.
FitResult fit(const MeasuredTable& table, const FitOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_FIT_H_
