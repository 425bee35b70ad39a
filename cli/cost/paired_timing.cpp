// Rounds, medians and quartiles.
#include "cli/cost/paired_timing.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "cli/common.h"
#include "cli/run_scaling.h"

namespace brdfit::cli {

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double quantile_of(std::vector<double> values, double q) {
  if (values.empty()) throw std::invalid_argument("a quantile of nothing");
  std::ranges::sort(values);
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

void Repeats::add(double time, double reference) {
  times_.push_back(time);
  ratios_.push_back(time / reference);
}

RepeatedTime Repeats::summary() const {
  if (times_.empty()) return {};
  return {quantile_of(times_, 0.5), quantile_of(times_, 0.25), quantile_of(times_, 0.75),
          static_cast<int>(times_.size()), quantile_of(ratios_, 0.5)};
}

ReferenceTime time_reference() {
  const double cpu_start = thread_cpu_seconds();
  const Stopwatch watch;
  constexpr int kTerms = 2'000'000;
  plain_loop(kTerms);
  return {watch.seconds(), thread_cpu_seconds() - cpu_start};
}

TimesInTurns time_in_turns(std::size_t count, const TimedWork& work, const TurnOptions& options) {
  std::vector<Repeats> repeats(count);
  Repeats references;
  for (int round = 0; round < options.repeats; ++round) {
    for (std::size_t turn = 0; turn < count; ++turn) {
      const std::size_t what = (turn + static_cast<std::size_t>(round)) % count;
      options.before_each();
      const ReferenceTime reference = time_reference();
      const double seconds = options.cpu_time ? reference.cpu_seconds : reference.wall_seconds;
      references.add(seconds, seconds);
      repeats[what].add(work(what), seconds * options.per_second);
    }
  }
  TimesInTurns times;
  for (const Repeats& each : repeats) times.works.push_back(each.summary());
  times.reference_seconds = references.summary();
  return times;
}

}  // namespace brdfit::cli
