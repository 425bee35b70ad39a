// Phases, and the unit that they are given in.
#include "cli/bake_timings.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "cli/common.h"
#include "io/decode_floor.h"

namespace brdfit::cli {
namespace {

double peak_mib() {
  return static_cast<double>(peak_memory_bytes()) / static_cast<double>(1 << 20);
}

}  // namespace

void BakeTimings::measure_decoding(const io::StackSource& source) {
  const BothClocks clocks;
  io::decode_all(source);
  decodings_.push_back(clocks.taken());
}

void BakeTimings::add(const std::string& phase, const TimeTaken& time) {
  auto found =
      std::find_if(phases_.begin(), phases_.end(), [&](const auto& known) { return known.first == phase; });
  if (found == phases_.end()) found = phases_.insert(phases_.end(), {phase, {}});
  found->second = found->second + time;
}

double BakeTimings::beside_seconds() const {
  double sum = 0.0;
  for (const auto& [phase, meter] : beside_) sum += meter.seconds();
  return sum;
}

std::vector<std::pair<std::string, TimeTaken>> BakeTimings::phases() const {
  std::vector<std::pair<std::string, TimeTaken>> whole = phases_;
  for (const auto& [phase, meter] : beside_) {
    const auto found = std::ranges::find(whole, phase, [](const auto& known) { return known.first; });
    if (found != whole.end()) {
      found->second.cpu_seconds += meter.seconds();
    } else if (meter.seconds() > 0.0) {
      whole.emplace_back(phase, TimeTaken{0.0, meter.seconds()});
    }
  }
  return whole;
}

TimeTaken BakeTimings::decoding() const {
  TimeTaken mean;
  for (const TimeTaken& one : decodings_) {
    mean.wall_seconds += one.wall_seconds / static_cast<double>(decodings_.size());
    mean.cpu_seconds += one.cpu_seconds / static_cast<double>(decodings_.size());
  }
  return mean;
}

io::Json BakeTimings::seconds_json() const {
  io::Json json = io::Json::object();
  for (const auto& [phase, time] : phases()) json[phase] = time.wall_seconds;
  json["total"] = total_.wall_seconds;
  return json;
}

io::Json BakeTimings::units_json() const {
  const TimeTaken unit = decoding();
  const auto in_units = [&](const TimeTaken& time) {
    return io::Json::array({time.wall_seconds / unit.wall_seconds, time.cpu_seconds / unit.cpu_seconds});
  };
  io::Json in_each = io::Json::object();
  for (const auto& [phase, time] : phases()) in_each[phase] = in_units(time);
  in_each["total"] = in_units(total_);
  return {{"decoding_seconds", unit.wall_seconds},
          {"decoding_cpu_seconds", unit.cpu_seconds},
          {"peak_memory_mib", peak_mib()},
          {"phases", in_each}};
}

std::string BakeTimings::text() const {
  const TimeTaken unit = decoding();
  std::string out = fmt::format("{:<16}{:>10}{:>14}{:>10}{:>14}\n", "phase", "seconds", "of decoding",
                                "CPU s", "of decoding");
  const auto row = [&](const std::string& phase, const TimeTaken& time) {
    fmt::format_to(std::back_inserter(out), "{:<16}{:>10.2f}{:>14.2f}{:>10.2f}{:>14.2f}\n", phase,
                   time.wall_seconds, time.wall_seconds / unit.wall_seconds, time.cpu_seconds,
                   time.cpu_seconds / unit.cpu_seconds);
  };
  row("decoding alone", unit);
  for (const auto& [phase, time] : phases()) row(phase, time);
  row("all", total_);
  fmt::format_to(std::back_inserter(out), "peak memory {:.0f} MiB\n", peak_mib());
  return out;
}

}  // namespace brdfit::cli
