// What was asked of a fit: its identity, and the words that ask for it again.
#ifndef BRDFIT_CLI_FIT_REQUEST_H_
#define BRDFIT_CLI_FIT_REQUEST_H_

#include <string>

#include "cli/common.h"
#include "cli/fit_options.h"
#include "fit/fit.h"

namespace brdfit::cli {

// SHA-256 of everything that a fit depends on beside its input and the program's version: the model, its
// options, the material to start from, how the table is read. Not of where results go or how many threads
// work.
std::string request_of(const fit::FitOptions& options, const FitArguments& arguments);

// The fitting options that were given to a subcommand, " --model callisto --fix metallic=0", so that a result
// of many files can name the line that makes it alone.
std::string given_fit_options(const CLI::App& app);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_FIT_REQUEST_H_
