// Fitting: Gram matrices and costs per observation for every model and instruction set, sampling, measures,
// and whole fits of a synthetic table in units of the load floor.
#include <benchmark/benchmark.h>

#include <string>

#include "bench/load_floor.h"
#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "fit/fit.h"
#include "fit/metrics.h"
#include "fit/problem.h"
#include "io/merl.h"

namespace {

using namespace brdfit;
using bench::LoadFloor;
using bench::seconds_of;
using bench::TemporaryFile;

Material material_of(Model model) {
  return synthetic::random_material(model, Tier::kFull, effects_of(model), MaterialOptions(), 1);
}

// A table of the usual size that no model fits exactly: Callisto with a little noise.
const std::filesystem::path& sample_file() {
  static const TemporaryFile file("brdfit-fit-bench");
  static const synthetic::GenerateReport report = [] {
    synthetic::Recipe recipe;
    recipe.name = "bench";
    recipe.material = material_of(Model::kCallisto);
    recipe.noise.multiplicative = 0.02;
    return synthetic::generate(recipe, file.path());
  }();
  benchmark::DoNotOptimize(report.valid);
  return file.path();
}

const MeasuredTable& sample_table_of_file() {
  static const MeasuredTable table = io::read_merl(sample_file());
  return table;
}

// What an evaluation of the residuals reads.
struct Observations {
  SampleSet samples;
  fit::Targets targets;
  fit::GramJob job;

  explicit Observations(Model model)
      : samples(sample_table(sample_table_of_file(), 2000, 1, {})),
        targets(fit::make_targets(samples, fit::Loss::kLogRatio)) {
    job.coefficients = simd::coefficients_of(material_of(model));
    job.geometry = samples.geometry();
    job.sqrt_weight = targets.sqrt_weight.data();
    for (std::size_t c = 0; c < 3; ++c) {
      job.target[c] = targets.value[c].data();
      job.clipped_target[c] = targets.clipped[c].data();
    }
    job.count = samples.padded_size();
    job.loss = static_cast<int>(fit::Loss::kLogRatio);
    job.robust_width = targets.robust_width;
    job.clipped_width = targets.clipped_width;
    job.clipped_share = targets.clipped_share.data();
  }

  // The counter time_per_observation is in seconds (three channels).
  void report(benchmark::State& state) const {
    state.counters["time_per_observation"] =
        benchmark::Counter(static_cast<double>(job.count),
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }
};

void gram(benchmark::State& state, Model model, simd::Isa isa) {
  const Observations observations(model);
  const fit::GramFunction function = fit::gram_function(isa);
  fit::Gram result;
  for (auto _ : state) {
    function(observations.job, result);
    benchmark::ClobberMemory();
  }
  observations.report(state);
}

void cost(benchmark::State& state, Model model, simd::Isa isa) {
  const Observations observations(model);
  const fit::CostFunction function = fit::cost_function(isa);
  for (auto _ : state) benchmark::DoNotOptimize(function(observations.job));
  observations.report(state);
}

void sampling(benchmark::State& state) {
  const MeasuredTable& table = sample_table_of_file();
  for (auto _ : state) benchmark::DoNotOptimize(sample_table(table, 20000, 1, {}).size());
}

void measures(benchmark::State& state, Model model) {
  const MeasuredTable& table = sample_table_of_file();
  const Material material = material_of(model);
  for (auto _ : state) benchmark::DoNotOptimize(fit::evaluate(material, table).table.log_ratio_pct);
}

// Load floor, load and fit in turn, so that whatever else the machine does meets them alike. The counters
// *_to_floor are ratios of their times to the floor with reused buffers.
void whole_fit(benchmark::State& state, Model model) {
  LoadFloor floor(sample_file());
  floor.run_reused();
  fit::FitOptions options;
  options.model = model;
  double floor_s = 0.0;
  double load_s = 0.0;
  double fit_s = 0.0;
  for (auto _ : state) {
    MeasuredTable table;
    floor_s += seconds_of([&] { floor.run_reused(); });
    load_s += seconds_of([&] { table = io::read_merl(sample_file()); });
    fit_s += seconds_of([&] { benchmark::DoNotOptimize(fit::fit(table, options).cost); });
  }
  const auto n = static_cast<double>(state.iterations());
  state.counters["floor_s"] = floor_s / n;
  state.counters["fit_s"] = fit_s / n;
  state.counters["load_to_floor"] = load_s / floor_s;
  state.counters["fit_to_floor"] = fit_s / floor_s;
}

template <class F, class... Args>
benchmark::internal::Benchmark* add(const std::string& name, const F& f, const Args&... args) {
  return benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { f(state, args...); })
      ->UseRealTime();
}

bool register_all() {
  for (const Model model : all_models()) {
    const std::string name(name_of(model));
    for (const simd::Isa isa : simd::available_isas()) {
      const std::string isa_name(name_of(isa));
      add(name + "/gram_" + isa_name, gram, model, isa);
      add(name + "/cost_" + isa_name, cost, model, isa);
    }
    add(name + "/measures", measures, model)->Unit(benchmark::kMillisecond);
    add(name + "/fit", whole_fit, model)->Unit(benchmark::kMillisecond);
  }
  add("sampling", sampling)->Unit(benchmark::kMillisecond);
  return true;
}

const bool kRegistered = register_all();

}  // namespace
