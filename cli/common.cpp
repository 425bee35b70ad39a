// Options, outputs and interruption shared by the subcommands.
#include "cli/common.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <cstdio>

namespace brdfit::cli {
namespace {

std::atomic<bool> interruption{false};

void on_signal(int signal) {
  interruption = true;
  // A second request ends the program at once.
  std::signal(signal, SIG_DFL);
}

}  // namespace

void add_common_options(CLI::App& app, CommonOptions& options, bool writes_files) {
  app.add_flag("--json", options.json, "print the result as JSON to standard output");
  app.add_flag("-q,--quiet", options.quiet, "print nothing but the result and errors");
  app.add_option("--threads", options.threads, "number of threads; 0: all of the machine")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  if (writes_files) app.add_flag("--force", options.force, "overwrite files that exist");
}

void prepare_output(const std::filesystem::path& file, bool force) {
  if (!force && std::filesystem::exists(file)) {
    throw UsageError(file.string() + " exists; give --force to overwrite it");
  }
  const std::filesystem::path folder = file.parent_path();
  if (folder.empty() || std::filesystem::is_directory(folder)) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw io::IoError(io::IoError::Side::kOutput, folder.string(), "cannot be made: " + error.message(),
                      "a folder for the output");
  }
}

std::string base_name(const std::filesystem::path& file) {
  return file.stem().string();
}

std::string quoted_word(const std::string& word) {
  const bool is_plain =
      !word.empty() && word.find_first_of(" \t\n'\"\\$*?[]{}();&|<>~#!`") == std::string::npos;
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void watch_for_interruption() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() {
  return interruption;
}

void say(const CommonOptions& options, const std::string& line) {
  if (!options.quiet) fmt::print(stderr, "{}\n", line);
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace brdfit::cli
