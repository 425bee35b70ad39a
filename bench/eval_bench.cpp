// Evaluation of a pair of directions, for each model and number type. `time_per_pair` is seconds per pair
// (three channels).
#include <benchmark/benchmark.h>
#include <ceres/jet.h>

#include <string>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "tests/product_eval.h"
#include "tests/random_parameters.h"

namespace {

using namespace brdfit;

constexpr std::size_t kPairs = 4096;

template <class Real>
struct GeoOf {
  using Type = Real;
};
template <class Scalar, int N>
struct GeoOf<ceres::Jet<Scalar, N>> {
  using Type = Scalar;
};

std::vector<testing_support::Pair> pairs() {
  testing_support::Random random(1);
  return testing_support::random_pairs(kPairs, random);
}

Material material_of(Model model, bool with_effects) {
  testing_support::Random random(2);
  return testing_support::interior_material(model, with_effects ? effects_of(model) : Effects(), random);
}

void report_time_per_pair(benchmark::State& state) {
  state.counters["time_per_pair"] =
      benchmark::Counter(static_cast<double>(kPairs),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Parameters as variables where Real carries derivatives.
template <class Real>
std::vector<Real> variables(const std::vector<double>& q) {
  std::vector<Real> result;
  for (std::size_t k = 0; k < q.size(); ++k) {
    if constexpr (std::is_floating_point_v<Real>) {
      result.push_back(static_cast<Real>(q[k]));
    } else {
      result.emplace_back(q[k], static_cast<int>(k));
    }
  }
  return result;
}

// Coefficients and geometry are made once, as a fit makes them.
template <class Real, class MakeCoefficients>
void scalar(benchmark::State& state, const Material& material, const MakeCoefficients& make) {
  using Geo = typename GeoOf<Real>::Type;
  const std::vector<Real> q = variables<Real>(product_form(material));
  const auto coefficients = make(q.data(), material);
  std::vector<kernel::Geometry<Geo>> geometry;
  std::vector<kernel::GeometryLogs<Geo>> logs;
  for (const auto& pair : pairs()) {
    geometry.push_back(testing_support::kernel_geometry<Geo>(pair));
    logs.push_back(kernel::geometry_logs(geometry.back()));
  }
  for (auto _ : state) {
    for (std::size_t k = 0; k < kPairs; ++k) {
      auto f = testing_support::eval_coefficients(coefficients, material.options(), material.effects(),
                                                  geometry[k], logs[k]);
      benchmark::DoNotOptimize(f);
    }
  }
  report_time_per_pair(state);
}

template <class Real>
void scalar_lambert_ggx(benchmark::State& state, bool with_effects) {
  scalar<Real>(state, material_of(Model::kLambertGgx, with_effects),
               [](const Real* q, const Material&) { return lambert_ggx_coefficients(q); });
}

template <class Real>
void scalar_burley(benchmark::State& state, bool with_effects) {
  scalar<Real>(state, material_of(Model::kBurley, with_effects), [](const Real* q, const Material& material) {
    return burley_coefficients(q, static_cast<int>(material.effects().bits()));
  });
}

template <class Real>
void scalar_callisto(benchmark::State& state, bool with_effects) {
  scalar<Real>(state, material_of(Model::kCallisto, with_effects),
               [](const Real* q, const Material&) { return callisto_coefficients(q); });
}

// Columns of unit directions, as vector code takes them.
struct Columns {
  std::array<std::vector<double>, 9> columns;

  Columns() {
    for (const auto& [wi, wo] : pairs()) {
      const std::array<double, 6> w = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (std::size_t k = 0; k < w.size(); ++k) columns[k].push_back(w[k]);
    }
    for (std::size_t k = 6; k < columns.size(); ++k) columns[k].resize(kPairs);
  }
};

void vector_directions(benchmark::State& state, Model model, bool with_effects, simd::Isa isa) {
  const simd::Coefficients coefficients = simd::coefficients_of(material_of(model, with_effects));
  Columns data;
  auto& c = data.columns;
  const simd::DirectionColumns directions = {c[0].data(), c[1].data(), c[2].data(),
                                             c[3].data(), c[4].data(), c[5].data()};
  double* const out[3] = {c[6].data(), c[7].data(), c[8].data()};
  const simd::EvalDirections evaluate = simd::eval_directions(isa);
  for (auto _ : state) {
    evaluate(coefficients, directions, kPairs, out);
    benchmark::ClobberMemory();
  }
  report_time_per_pair(state);
}

// Columns of precomputed geometry, as a fit keeps them.
void vector_geometry(benchmark::State& state, Model model, bool with_effects, simd::Isa isa) {
  const simd::Coefficients coefficients = simd::coefficients_of(material_of(model, with_effects));
  std::array<std::vector<double>, 14> c;
  for (const auto& pair : pairs()) {
    const auto g = testing_support::kernel_geometry(pair);
    const auto logs = kernel::geometry_logs(g);
    const std::array<double, 11> values = {g.cos_i,
                                           g.cos_o,
                                           std::hypot(g.h_x, g.h_y),
                                           g.cos_h,
                                           g.cos_d,
                                           g.one_minus_cos_h,
                                           g.one_minus_cos_d,
                                           logs.cos_h,
                                           logs.cos_d,
                                           logs.one_minus_cos_h,
                                           logs.one_minus_cos_d};
    for (std::size_t k = 0; k < values.size(); ++k) c[k].push_back(values[k]);
  }
  for (std::size_t k = 11; k < c.size(); ++k) c[k].resize(kPairs);
  const simd::GeometryColumns columns = {c[0].data(), c[1].data(), c[2].data(), c[3].data(),
                                         c[4].data(), c[5].data(), c[6].data(), c[7].data(),
                                         c[8].data(), c[9].data(), c[10].data()};
  double* const out[3] = {c[11].data(), c[12].data(), c[13].data()};
  const simd::EvalColumns evaluate = simd::eval_columns(isa);
  for (auto _ : state) {
    evaluate(coefficients, columns, kPairs, out);
    benchmark::ClobberMemory();
  }
  report_time_per_pair(state);
}

// The public span form, transposition included.
void spans(benchmark::State& state, Model model, bool with_effects) {
  const Material material = material_of(model, with_effects);
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  for (const auto& pair : pairs()) {
    wi.push_back(pair.wi);
    wo.push_back(pair.wo);
  }
  std::vector<Rgb> out(kPairs);
  for (auto _ : state) {
    eval_cos(material, wi, wo, out);
    benchmark::ClobberMemory();
  }
  report_time_per_pair(state);
}

// The public form for one pair, which reads the material every time.
void one_pair(benchmark::State& state, Model model, bool with_effects) {
  const Material material = material_of(model, with_effects);
  const auto all = pairs();
  for (auto _ : state) {
    for (const auto& [wi, wo] : all) {
      Rgb f = eval_cos(material, wi, wo);
      benchmark::DoNotOptimize(f);
    }
  }
  report_time_per_pair(state);
}

template <class F, class... Args>
void add(const std::string& name, const F& f, const Args&... args) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { f(state, args...); });
}

template <int N>
using Jet = ceres::Jet<double, N>;

void add_scalar(bool with_effects, const std::string& suffix) {
  add("burley/double" + suffix, scalar_burley<double>, with_effects);
  add("burley/float" + suffix, scalar_burley<float>, with_effects);
  add("burley/jet" + suffix, scalar_burley<Jet<kBurleyProductSize>>, with_effects);
  add("callisto/double" + suffix, scalar_callisto<double>, with_effects);
  add("callisto/float" + suffix, scalar_callisto<float>, with_effects);
  add("callisto/jet" + suffix, scalar_callisto<Jet<kCallistoProductSize>>, with_effects);
}

bool register_all() {
  add("lambert-ggx/double", scalar_lambert_ggx<double>, false);
  add("lambert-ggx/float", scalar_lambert_ggx<float>, false);
  add("lambert-ggx/jet", scalar_lambert_ggx<Jet<kLambertGgxProductSize>>, false);
  add_scalar(false, "/no_effects");
  add_scalar(true, "/all_effects");
  for (const Model model : all_models()) {
    for (const bool with_effects : {false, true}) {
      if (with_effects && effects_of(model) == Effects()) continue;
      const std::string name(name_of(model));
      const std::string suffix = effects_of(model) == Effects() ? ""
                                 : with_effects                 ? "/all_effects"
                                                                : "/no_effects";
      for (const simd::Isa isa : simd::available_isas()) {
        const std::string isa_name(name_of(isa));
        add(name + "/simd_directions_" + isa_name + suffix, vector_directions, model, with_effects, isa);
        add(name + "/simd_geometry_" + isa_name + suffix, vector_geometry, model, with_effects, isa);
      }
      add(name + "/spans" + suffix, spans, model, with_effects);
      add(name + "/one_pair" + suffix, one_pair, model, with_effects);
    }
  }
  return true;
}

const bool kRegistered = register_all();

}  // namespace
