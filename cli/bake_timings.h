// Where the time of a bake goes, in units of decoding the pictures.
#ifndef BRDFIT_CLI_BAKE_TIMINGS_H_
#define BRDFIT_CLI_BAKE_TIMINGS_H_

#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/clocks.h"
#include "io/json.h"
#include "io/stack_source.h"

namespace brdfit::cli {

class BakeTimings {
 public:
  // Decodes all pictures and throws the rows away: the unit is the mean of all calls.
  void measure_decoding(const io::StackSource& source);
  // Phases are listed in the order in which they were first met.
  void add(const std::string& phase, const TimeTaken& time);
  void set_total(const TimeTaken& time) { total_ = time; }

  // For work of a phase that goes on while others do: its CPU time is the phase's and not theirs. Called
  // before that work begins; stays where it is.
  CpuMeter& beside(const std::string& phase) { return beside_[phase]; }

  // What `work` gives, its time added to a phase.
  template <class Work>
  auto timed(const std::string& phase, const Work& work) {
    const BothClocks clocks;
    const double before = beside_seconds();
    const auto end = [&] {
      TimeTaken time = clocks.taken();
      time.cpu_seconds -= beside_seconds() - before;
      add(phase, time);
    };
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      end();
    } else {
      auto result = work();
      end();
      return result;
    }
  }

  // In the order in which they were first met; those that only went on beside others last.
  std::vector<std::pair<std::string, TimeTaken>> phases() const;
  // {phase: wall seconds}, with "total".
  io::Json seconds_json() const;
  // {"decoding_seconds", "decoding_cpu_seconds", "peak_memory_mib", "phases": {phase: [wall, CPU] in units of
  // decoding}}, with "total" among the phases.
  io::Json units_json() const;
  // The same as a table.
  std::string text() const;

 private:
  TimeTaken decoding() const;
  double beside_seconds() const;

  std::vector<std::pair<std::string, TimeTaken>> phases_;  // without what went on beside others
  std::map<std::string, CpuMeter> beside_;
  std::vector<TimeTaken> decodings_;
  TimeTaken total_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_TIMINGS_H_
