// Loading a MERL file of the usual size, against the floor: reading its bytes and converting them to float.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "io/merl.h"
#include "io/sha256.h"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kValues = std::size_t{3} * 90 * 90 * 180;

// A table of the usual size, a quarter of it not measured, in the folder for temporary files.
class SampleFile {
 public:
  SampleFile()
      : path_(std::filesystem::temp_directory_path() / ("brdfit-load-bench-" + std::to_string(getpid()))) {
    const brdfit::Grid grid;
    brdfit::io::write_merl(path_, grid, [](int i_h, int i_d, int i_p) {
      const double f = (i_h + i_d) % 4 == 0 ? -1.0 : 0.1 + 1e-3 * i_h + 1e-4 * i_p;
      return brdfit::Rgb{f, f, f};
    });
  }
  SampleFile(const SampleFile&) = delete;
  SampleFile& operator=(const SampleFile&) = delete;
  ~SampleFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  static const std::filesystem::path& path() {
    static const SampleFile file;
    return file.path_;
  }

 private:
  std::filesystem::path path_;
};

// All bytes of the file's planes.
void read_bytes(std::span<double> values) {
  const int descriptor = open(SampleFile::path().c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw std::runtime_error("the sample file is gone");
  auto bytes = std::as_writable_bytes(values);
  auto offset = static_cast<off_t>(kHeaderBytes);
  while (!bytes.empty()) {
    const ssize_t count = pread(descriptor, bytes.data(), bytes.size(), offset);
    if (count <= 0) throw std::runtime_error("the sample file cannot be read");
    offset += count;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  close(descriptor);
}

void convert(std::span<const double> values, float* f) {
  for (std::size_t k = 0; k < values.size(); ++k) f[k] = static_cast<float>(values[k]);
  benchmark::DoNotOptimize(f);
  benchmark::ClobberMemory();
}

// Buffers that live on: no page is touched for the first time.
class ReusedFloor {
 public:
  void run() {
    read_bytes({values_.get(), kValues});
    convert({values_.get(), kValues}, f_.get());
  }

 private:
  std::unique_ptr<double[]> values_ = std::make_unique<double[]>(kValues);
  std::unique_ptr<float[]> f_ = std::make_unique<float[]>(kValues);
};

void run_fresh_floor() {
  const auto values = std::make_unique_for_overwrite<double[]>(kValues);
  const auto f = std::make_unique_for_overwrite<float[]>(kValues);
  read_bytes({values.get(), kValues});
  convert({values.get(), kValues}, f.get());
}

void load() {
  const brdfit::MeasuredTable table = brdfit::io::read_merl(SampleFile::path());
  benchmark::DoNotOptimize(table.plane(0).data());
}

template <typename Work>
double seconds(const Work& work) {
  const Clock::time_point start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void BM_FloorReusedBuffers(benchmark::State& state) {
  ReusedFloor floor;
  for (auto _ : state) floor.run();
}
BENCHMARK(BM_FloorReusedBuffers)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_FloorFreshBuffers(benchmark::State& state) {
  for (auto _ : state) run_fresh_floor();
}
BENCHMARK(BM_FloorFreshBuffers)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_ReadMerl(benchmark::State& state) {
  for (auto _ : state) load();
}
BENCHMARK(BM_ReadMerl)->Unit(benchmark::kMillisecond)->UseRealTime();

// All three in turn, so that whatever else the machine does meets them alike. The counters load_to_floor_*
// are the ratios of their times; they should stay below 2.
void BM_LoadToFloor(benchmark::State& state) {
  ReusedFloor reused;
  double reused_s = 0.0;
  double fresh_s = 0.0;
  double load_s = 0.0;
  for (auto _ : state) {
    reused_s += seconds([&] { reused.run(); });
    fresh_s += seconds(run_fresh_floor);
    load_s += seconds(load);
  }
  state.counters["load_to_floor_reused"] = load_s / reused_s;
  state.counters["load_to_floor_fresh"] = load_s / fresh_s;
}
BENCHMARK(BM_LoadToFloor)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_Sha256(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(brdfit::io::sha256_of_file(SampleFile::path()));
}
BENCHMARK(BM_Sha256)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
