// The options of `fit` and `table` that say how to fit.
#ifndef BRDFIT_CLI_FIT_OPTIONS_H_
#define BRDFIT_CLI_FIT_OPTIONS_H_

#include <optional>
#include <string>
#include <vector>

#include "cli/common.h"
#include "fit/fit.h"
#include "io/merl.h"

namespace brdfit::cli {

// As given on the command line; defaults come from fit::FitOptions, so that --help and the code say the same.
struct FitArguments {
  FitArguments();

  std::vector<std::string> models = {"all"};
  std::string tier;
  std::vector<std::string> effects = {"auto"};
  std::string on;
  std::vector<double> phi_d_deg;
  double max_theta_deg;
  std::string samples = "auto";
  std::string loss;
  int starts;
  std::uint64_t seed;
  std::string masking;
  std::string burley_g;
  std::string diffuse;
  std::string cell = "lower-edge";
  bool lenient = false;
  int held_out_folds = 0;
  std::vector<std::string> init;
  std::vector<std::string> fix;
};

void add_fit_arguments(CLI::App& app, FitArguments& arguments);

// One set of options per model that is asked for, in the order of all_models(). Throws UsageError, and
// IoError for a material to start from.
std::vector<fit::FitOptions> make_fit_options(const FitArguments& arguments);

io::MerlReadOptions make_read_options(const FitArguments& arguments);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_FIT_OPTIONS_H_
