// How far a long run is: a bar on a terminal, plain lines elsewhere.
#ifndef BRDFIT_CLI_PROGRESS_H_
#define BRDFIT_CLI_PROGRESS_H_

#include <cstddef>
#include <mutex>
#include <string>

#include "cli/common.h"

namespace brdfit::cli {

// Writes to stderr, from any thread. Quiet shows nothing but errors.
class Progress {
 public:
  Progress(std::size_t total, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  // One of the total is done.
  void step(const std::string& what);
  // A line that stays, above the bar.
  void note(const std::string& line);
  void error(const std::string& line);

 private:
  void draw_bar(const std::string& what);
  void wipe_bar();

  std::mutex mutex_;
  Stopwatch watch_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool quiet_;
  bool is_terminal_;
  std::string last_;  // what the bar shows behind it
};

// Throws std::runtime_error after Ctrl-C, for commands that write whole files as they go.
void stop_if_interrupted();

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_PROGRESS_H_
