// The command line: one parser, one place that turns errors into exit codes.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "cli/common.h"
#include "cli/cost/cost_command.h"
#include "cli/version.h"
#include "fit/solve.h"

namespace brdfit::cli {
namespace {

int exit_code_of(const CLI::ParseError& error, const CLI::App& program) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return program.exit(error);
  std::string name = "brdfit";
  for (const CLI::App* app : program.get_subcommands()) name += " " + app->get_name();
  fmt::print(stderr, "{}: {}; see {} --help\n", name, error.what(), name);
  return kWrongUsage;
}

// What was typed, with quotes where a shell needs them; the program by its name alone.
std::string command_line_of(int argc, char** argv) {
  std::string line = "brdfit";
  for (int k = 1; k < argc; ++k) {
    line += " " + quoted_word(argv[k]);
  }
  return line;
}

// Runs the subcommand and says what went wrong in one line.
int run_command(const Command& command, const std::string& command_line) {
  const std::string name = "brdfit " + command.app->get_name();
  try {
    return command.run(command_line);
  } catch (const UsageError& error) {
    fmt::print(stderr, "{}: {}; see {} --help\n", name, error.what(), name);
    return kWrongUsage;
  } catch (const io::IoError& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return error.side() == io::IoError::Side::kInput ? kUnusableInput : kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return kFailed;
  }
}

int run(int argc, char** argv) {
  CLI::App program(
      "Measured reflectance into materials that a renderer can use.\n"
      "Exit codes: 0 done, 1 failed while running, 2 wrong usage, 3 input unusable, 4 done but some "
      "inputs failed or a threshold is not met.",
      "brdfit");
  program.set_version_flag("--version", std::string("brdfit ") + kVersion);
  program.require_subcommand(1);
  const std::vector<Command> commands = {
      add_fit_command(program),    add_table_command(program),  add_info_command(program),
      add_slice_command(program),  add_sphere_command(program), add_compare_command(program),
      add_report_command(program), add_bake_command(program),   add_relight_command(program),
      add_synth_command(program),  add_export_command(program), add_verify_command(program),
      add_cost_command(program),   add_demo_command(program)};
  for (const Command& command : commands) {
    command.app->set_version_flag("--version", std::string("brdfit ") + kVersion);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return exit_code_of(error, program);
  }
  fit::silence_solver_logging();
  watch_for_interruption();
  for (const Command& command : commands) {
    if (command.app->parsed()) return run_command(command, command_line_of(argc, argv));
  }
  return kWrongUsage;
}

}  // namespace
}  // namespace brdfit::cli

int main(int argc, char** argv) {
  return brdfit::cli::run(argc, argv);
}
