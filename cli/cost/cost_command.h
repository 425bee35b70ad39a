// brdfit cost, as cli/main.cpp registers it.
#ifndef BRDFIT_CLI_COST_COST_COMMAND_H_
#define BRDFIT_CLI_COST_COST_COMMAND_H_

#include "cli/common.h"

namespace brdfit::cli {

// As the commands of cli/common.h.
Command add_cost_command(CLI::App& program);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_COST_COMMAND_H_
