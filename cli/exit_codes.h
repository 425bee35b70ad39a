// What the program's exit status says.
#ifndef BRDFIT_CLI_EXIT_CODES_H_
#define BRDFIT_CLI_EXIT_CODES_H_

namespace brdfit::cli {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,         // failed while running
  kWrongUsage = 2,     // options that do not make sense
  kUnusableInput = 3,  // a file that cannot be used
  kNotAllDone = 4,     // done, but a stated threshold is not met or some of the inputs failed
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_EXIT_CODES_H_
