// What `brdfit cost` measures at one point of its sweep, shared by tables and light stacks, by the front, the
// sentences and the plots.
#ifndef BRDFIT_CLI_COST_COST_POINT_H_
#define BRDFIT_CLI_COST_COST_POINT_H_

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace brdfit::cli {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

// A time measured several times: the median and the quartiles of the repeats.
struct RepeatedTime {
  double median = 0;
  double low_quartile = 0;
  double high_quartile = 0;
  int repeats = 0;  // 0: not measured
  // The median over the repeats of this time over that of the reference workload next to it: what compares
  // with another machine. 0 where there is none.
  double units = 0;

  bool is_measured() const { return repeats > 0; }
};

// One choice of a user and what it costs. Which of the figures hold depends on the kind of run; what was not
// measured is NaN in memory and absent from files.
struct CostPoint {
  std::string name;   // unique in a run, readable: "callisto base, 4000 samples"
  std::string sweep;  // the choice that this point varies: "model", "tier", "effects", "samples", "bits",
                      // ...; "default" for the point around which the others lie
  std::vector<std::pair<std::string, std::string>> settings;  // every choice, by the option's name without
                                                              // dashes
  std::vector<std::pair<std::string, double>> errors;         // every measure; the run says which one leads
  RepeatedTime make_seconds;                                  // to fit or to bake
  RepeatedTime evaluation_ns;  // of one run-time evaluation (one pair of directions, one texel and light)
  double bytes = 0;            // of a material, or of one texel of a bake
  double peak_mib = 0;         // of memory while it was made
  double free_numbers = kNotMeasured;  // that a fit could move
  double observations = kNotMeasured;  // that it was fitted to
  bool on_make_front = false;          // no other point has less error for as little time to make
  bool on_run_front = false;           // no other point has less error for as little time per evaluation
};

// All points of one input, and what makes them comparable with those of another machine.
struct CostRun {
  std::string kind;                // "table" or "stack"
  std::string input;               // file name, without folders
  std::string leading_error;       // the key of `errors` that fronts, sentences and budgets use
  RepeatedTime reference_seconds;  // a fixed workload, measured between the points
  std::vector<CostPoint> points;
  std::vector<std::string> notes;  // in sentences: what could not be measured, and why
};

// The named error of a point; kNotMeasured where it has none.
double error_of(const CostPoint& point, const std::string& key);

// The named choice of a point; empty where it has none.
std::string setting_of(const CostPoint& point, const std::string& key);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_COST_POINT_H_
