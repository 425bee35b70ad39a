// Loading a MERL file of the usual size, against the floor: reading its bytes and converting them to float.
#include <benchmark/benchmark.h>

#include "bench/load_floor.h"
#include "io/merl.h"
#include "io/sha256.h"

namespace {

using brdfit::bench::LoadFloor;
using brdfit::bench::seconds_of;
using brdfit::bench::TemporaryFile;

// A table of the usual size, a quarter of it not measured.
const std::filesystem::path& sample_file() {
  static const TemporaryFile file("brdfit-load-bench");
  static const bool written = [] {
    brdfit::io::write_merl(file.path(), brdfit::Grid(), [](int i_h, int i_d, int i_p) {
      const double f = (i_h + i_d) % 4 == 0 ? -1.0 : 0.1 + 1e-3 * i_h + 1e-4 * i_p;
      return brdfit::Rgb{f, f, f};
    });
    return true;
  }();
  benchmark::DoNotOptimize(written);
  return file.path();
}

void load() {
  const brdfit::MeasuredTable table = brdfit::io::read_merl(sample_file());
  benchmark::DoNotOptimize(table.plane(0).data());
}

void BM_FloorReusedBuffers(benchmark::State& state) {
  LoadFloor floor(sample_file());
  for (auto _ : state) floor.run_reused();
}
BENCHMARK(BM_FloorReusedBuffers)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_FloorFreshBuffers(benchmark::State& state) {
  const LoadFloor floor(sample_file());
  for (auto _ : state) floor.run_fresh();
}
BENCHMARK(BM_FloorFreshBuffers)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadMerl(benchmark::State& state) {
  sample_file();
  for (auto _ : state) load();
}
BENCHMARK(BM_ReadMerl)->Unit(benchmark::kMillisecond)->UseRealTime();

// All three in turn, so that whatever else the machine does meets them alike. The counters load_to_floor_*
// are the ratios of their times; they should stay below 2.
void BM_LoadToFloor(benchmark::State& state) {
  LoadFloor floor(sample_file());
  floor.run_reused();
  double reused_s = 0.0;
  double fresh_s = 0.0;
  double load_s = 0.0;
  for (auto _ : state) {
    reused_s += seconds_of([&] { floor.run_reused(); });
    fresh_s += seconds_of([&] { floor.run_fresh(); });
    load_s += seconds_of(load);
  }
  state.counters["load_to_floor_reused"] = load_s / reused_s;
  state.counters["load_to_floor_fresh"] = load_s / fresh_s;
}
BENCHMARK(BM_LoadToFloor)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_Sha256(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(brdfit::io::sha256_of_file(sample_file()));
}
BENCHMARK(BM_Sha256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
