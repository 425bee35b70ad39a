// Where the time of a bake goes, in units of decoding the pictures.
#ifndef BRDFIT_CLI_BAKE_TIMINGS_H_
#define BRDFIT_CLI_BAKE_TIMINGS_H_

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/common.h"
#include "io/json.h"
#include "io/stack_source.h"

namespace brdfit::cli {

// Of the clock on the wall, and of all processors together: on a machine that others use the second says
// more.
struct TimeTaken {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
};

// Starts when it is made.
class BothClocks {
 public:
  BothClocks();
  TimeTaken taken() const;

 private:
  Stopwatch watch_;
  double cpu_start_;
};

class BakeTimings {
 public:
  // Decodes all pictures and throws the rows away: the unit is the mean of all calls.
  void measure_decoding(const io::StackSource& source);
  // Phases are listed in the order in which they were first met.
  void add(const std::string& phase, const TimeTaken& time);
  void set_total(const TimeTaken& time) { total_ = time; }

  // What `work` gives, its time added to a phase.
  template <class Work>
  auto timed(const std::string& phase, const Work& work) {
    const BothClocks clocks;
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      add(phase, clocks.taken());
    } else {
      auto result = work();
      add(phase, clocks.taken());
      return result;
    }
  }

  // {phase: wall seconds}, with "total".
  io::Json seconds_json() const;
  // {"decoding_seconds", "decoding_cpu_seconds", "peak_memory_mib", "phases": {phase: [wall, CPU] in units of
  // decoding}}, with "total" among the phases.
  io::Json units_json() const;
  // The same as a table.
  std::string text() const;

 private:
  TimeTaken decoding() const;

  std::vector<std::pair<std::string, TimeTaken>> phases_;
  std::vector<TimeTaken> decodings_;
  TimeTaken total_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_TIMINGS_H_
