// What all subcommands share: options, errors, output files, interruption, timing.
#ifndef BRDFIT_CLI_COMMON_H_
#define BRDFIT_CLI_COMMON_H_

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/exit_codes.h"
#include "io/json.h"

namespace brdfit::cli {

// Options that do not make sense together; ends in kWrongUsage.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Options of every subcommand.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  bool force = false;
  int threads = 0;  // 0: as many as the machine has
};

// Adds --json, -q, --threads and, where the subcommand writes files, --force.
void add_common_options(CLI::App& app, CommonOptions& options, bool writes_files);

// A subcommand: its parser, and what it does. run() takes the command line, for provenance, and returns an
// ExitCode.
struct Command {
  CLI::App* app = nullptr;
  std::function<int(const std::string& command_line)> run;
};

// Each adds its parser to the program's and keeps its options alive in the result.
Command add_fit_command(CLI::App& program);
Command add_table_command(CLI::App& program);
Command add_info_command(CLI::App& program);
Command add_slice_command(CLI::App& program);
Command add_sphere_command(CLI::App& program);
Command add_compare_command(CLI::App& program);
Command add_report_command(CLI::App& program);
Command add_bake_command(CLI::App& program);
Command add_relight_command(CLI::App& program);
Command add_synth_command(CLI::App& program);
Command add_export_command(CLI::App& program);
Command add_verify_command(CLI::App& program);
Command add_demo_command(CLI::App& program);

// Throws UsageError when the file exists and force is off; the folder must exist or be creatable, and is
// made.
void prepare_output(const std::filesystem::path& file, bool force);

// "black-soft-plastic" of "dir/black-soft-plastic.binary".
std::string base_name(const std::filesystem::path& file);

// A word as a shell takes it: in quotes where it needs them.
std::string quoted_word(const std::string& word);

// Whether Ctrl-C or a request to end has come since the program began; long work asks between its steps.
void watch_for_interruption();
bool interrupted();

// Prints one line to stderr unless quiet; for work that a person waits for.
void say(const CommonOptions& options, const std::string& line);

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// The largest memory that the process has held, in bytes.
std::size_t peak_memory_bytes();

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COMMON_H_
