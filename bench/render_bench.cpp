// What pictures cost, as ratios: all contenders take turns in one run, and a ratio is the median over the
// turns.
//
//   render_bench [turns]
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "measured/grid_geometry.h"
#include "render/slice.h"
#include "render/view.h"
#include "tests/product_eval.h"
#include "tests/random_parameters.h"

namespace {

using namespace brdfit;

// Pixels of the kernels' measurements, spread over the picture; few enough for the cache.
constexpr std::size_t kPixels = 4096;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Results go here, so that they are not optimised away.
volatile double g_sink;

struct Contender {
  std::string name;
  std::size_t pixels;
  std::function<void()> run;
  std::vector<double> ns_per_pixel;
};

class Race {
 public:
  void add(const std::string& name, std::size_t pixels, std::function<void()> run) {
    contenders_.push_back({name, pixels, std::move(run), {}});
  }

  void run(int turns) {
    for (Contender& contender : contenders_) contender.run();
    for (int turn = 0; turn < turns; ++turn) {
      for (Contender& contender : contenders_) {
        const auto begin = std::chrono::steady_clock::now();
        contender.run();
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
        contender.ns_per_pixel.push_back(time.count() / static_cast<double>(contender.pixels));
      }
    }
  }

  void print_times() const {
    for (const Contender& c : contenders_) {
      std::printf("  %-58s %8.2f ns per pixel\n", c.name.c_str(), median(c.ns_per_pixel));
    }
  }

  double ratio(const std::string& above, const std::string& below) const {
    const std::vector<double>& a = find(above).ns_per_pixel;
    const std::vector<double>& b = find(below).ns_per_pixel;
    std::vector<double> ratios;
    for (std::size_t k = 0; k < a.size(); ++k) ratios.push_back(a[k] / b[k]);
    return median(ratios);
  }

 private:
  const Contender& find(const std::string& name) const {
    return *std::ranges::find(contenders_, name, &Contender::name);
  }

  std::vector<Contender> contenders_;
};

struct Subject {
  std::string name;
  Material material;
};

std::vector<Subject> subjects() {
  std::vector<Subject> result;
  for (const Model model : all_models()) {
    for (const bool all : {false, true}) {
      if (all && effects_of(model) == Effects()) continue;
      // Pictures of isotropic materials: the anisotropic effect has no table to be compared with.
      const Effects effects = all ? effects_of(model).without(Effect::kAnisotropic) : Effects();
      testing_support::Random random(2);
      result.push_back({std::string(name_of(model)) + (all ? ", all effects" : ""),
                        testing_support::interior_material(model, effects, random)});
    }
  }
  return result;
}

// Pairs of directions of pixels, in all the forms in which code takes them.
struct Pixels {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  std::vector<kernel::Geometry<double>> geometry;
  std::vector<kernel::GeometryLogs<double>> logs;
  std::vector<double> directions[6];
  std::vector<double> columns[11];

  Pixels(const render::SliceOptions& options, std::size_t stride) {
    const auto size = static_cast<std::size_t>(options.size);
    for (std::size_t k = stride / 2; k < size * size; k += stride) {
      add(render::slice_angles(options, static_cast<int>(k % size), static_cast<int>(k / size)));
    }
  }

  std::size_t size() const { return wi.size(); }

  simd::DirectionColumns direction_columns() const {
    const auto& w = directions;
    return {w[0].data(), w[1].data(), w[2].data(), w[3].data(), w[4].data(), w[5].data()};
  }
  simd::GeometryColumns geometry_columns() const {
    const auto& c = columns;
    return {c[0].data(), c[1].data(), c[2].data(), c[3].data(), c[4].data(), c[5].data(),
            c[6].data(), c[7].data(), c[8].data(), c[9].data(), c[10].data()};
  }

 private:
  void add(const HalfDiff& angles) {
    const auto [i, o] = directions_from_half_diff(angles);
    wi.push_back(i);
    wo.push_back(o);
    geometry.push_back(testing_support::kernel_geometry(testing_support::Pair{i, o}));
    logs.push_back(kernel::geometry_logs(geometry.back()));
    const double w[] = {i.x, i.y, i.z, o.x, o.y, o.z};
    for (std::size_t k = 0; k < 6; ++k) directions[k].push_back(w[k]);
    const CellGeometry c = cell_geometry(angles);
    const double g[] = {c.cos_i,
                        c.cos_o,
                        c.sin_h,
                        c.cos_h,
                        c.cos_d,
                        c.one_minus_cos_h,
                        c.one_minus_cos_d,
                        c.log_cos_h,
                        c.log_cos_d,
                        c.log_one_minus_cos_h,
                        c.log_one_minus_cos_d};
    for (std::size_t k = 0; k < 11; ++k) columns[k].push_back(g[k]);
  }
};

// The kernels one pixel at a time, with coefficients made once.
template <class Coefs>
void add_scalar(Race& race, const std::string& name, const Material& material, const Pixels& pixels,
                const Coefs& coefs) {
  race.add(name + ": scalar, geometry ready", pixels.size(), [&material, &pixels, coefs] {
    double sum = 0.0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const auto f = testing_support::eval_coefficients(coefs, material.options(), material.effects(),
                                                        pixels.geometry[k], pixels.logs[k]);
      sum += f[0] + f[1] + f[2];
    }
    g_sink = sum;
  });
  const bool with_logs = material.model() == Model::kCallisto;
  race.add(name + ": scalar, from directions", pixels.size(), [&material, &pixels, coefs, with_logs] {
    double sum = 0.0;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const auto g = testing_support::kernel_geometry(testing_support::Pair{pixels.wi[k], pixels.wo[k]});
      kernel::GeometryLogs<double> logs{};
      if (with_logs) logs = kernel::geometry_logs(g);
      const auto f =
          testing_support::eval_coefficients(coefs, material.options(), material.effects(), g, logs);
      sum += f[0] + f[1] + f[2];
    }
    g_sink = sum;
  });
}

void add_scalar(Race& race, const Subject& subject, const Pixels& pixels) {
  const std::vector<double> q = product_form(subject.material);
  const int effects = static_cast<int>(subject.material.effects().bits());
  switch (subject.material.model()) {
    case Model::kLambertGgx:
      return add_scalar(race, subject.name, subject.material, pixels, lambert_ggx_coefficients(q.data()));
    case Model::kBurley:
      return add_scalar(race, subject.name, subject.material, pixels, burley_coefficients(q.data(), effects));
    case Model::kCallisto:
      return add_scalar(race, subject.name, subject.material, pixels, callisto_coefficients(q.data()));
  }
}

void add_vectorised(Race& race, const Subject& subject, const Pixels& pixels) {
  const auto out = std::make_shared<std::vector<double>>(3 * pixels.size());
  const simd::Coefficients coefficients = simd::coefficients_of(subject.material);
  const auto add = [&](const std::string& form, const auto& evaluate, const auto& columns) {
    race.add(subject.name + ": vectorised, " + form, pixels.size(), [=, count = pixels.size()] {
      double* const channels[3] = {out->data(), out->data() + count, out->data() + 2 * count};
      evaluate(coefficients, columns, count, channels);
      g_sink = out->back();
    });
  };
  add("geometry ready", simd::eval_columns(simd::best_isa()), pixels.geometry_columns());
  add("from directions", simd::eval_directions(simd::best_isa()), pixels.direction_columns());
}

// The whole picture, and the public evaluation of its pixels.
void add_drawing(Race& race, const Subject& subject, const Pixels& pixels,
                 const render::SliceOptions& options) {
  const auto out = std::make_shared<std::vector<Rgb>>(pixels.size());
  const Material& material = subject.material;
  race.add(subject.name + ": eval over spans of the pixels", pixels.size(),
           [&material, &pixels, out] { eval(material, pixels.wi, pixels.wo, *out); });
  race.add(subject.name + ": eval over spans, in parallel", pixels.size(), [&material, &pixels, out] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), kPixels), [&](const auto& range) {
      const auto part = [&](auto& all) { return std::span(all).subspan(range.begin(), range.size()); };
      eval(material, part(pixels.wi), part(pixels.wo), part(*out));
    });
  });
  race.add(subject.name + ": draw_slice", pixels.size(),
           [&material, options] { g_sink = render::draw_slice(material, options).rgb.back(); });
  race.add(subject.name + ": draw_slice and to_picture", pixels.size(), [&material, options] {
    g_sink = render::to_picture(render::draw_slice(material, options), {}).rgb.back();
  });
}

struct Ratio {
  std::string above;
  std::string below;
  double target;
  bool at_least;
};

void print_ratios(const Race& race, const std::vector<Ratio>& ratios) {
  for (const Ratio& r : ratios) {
    const double value = race.ratio(r.above, r.below);
    const bool met = r.at_least ? value >= r.target : value <= r.target;
    std::printf("  %6.2f  (target %s %.1f: %s)  %s / %s\n", value, r.at_least ? ">=" : "<=", r.target,
                met ? "met" : "missed", r.above.c_str(), r.below.c_str());
  }
}

void race_kernels(const render::SliceOptions& options, int turns) {
  const auto all = static_cast<std::size_t>(options.size) * static_cast<std::size_t>(options.size);
  const Pixels pixels(options, all / kPixels);
  const std::vector<Subject> all_subjects = subjects();
  Race race;
  std::vector<Ratio> ratios;
  for (const Subject& subject : all_subjects) {
    add_scalar(race, subject, pixels);
    add_vectorised(race, subject, pixels);
    for (const std::string form : {", geometry ready", ", from directions"}) {
      ratios.push_back({subject.name + ": scalar" + form, subject.name + ": vectorised" + form, 4.0, true});
    }
  }
  for (const std::string form : {": vectorised, geometry ready", ": vectorised, from directions"}) {
    ratios.push_back({all_subjects.back().name + form, all_subjects.front().name + form, 4.0, false});
  }
  race.run(turns);
  std::printf("\nEvaluating %zu pixels of a slice, one thread\n", pixels.size());
  race.print_times();
  std::printf("\n");
  print_ratios(race, ratios);
}

void race_drawing(const render::SliceOptions& options, int turns, int threads) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  const Pixels pixels(options, 1);
  const std::vector<Subject> all_subjects = subjects();
  Race race;
  std::vector<Ratio> ratios;
  for (const Subject& subject : all_subjects) {
    add_drawing(race, subject, pixels, options);
    ratios.push_back(
        {subject.name + ": draw_slice and to_picture",
         subject.name + (threads == 1 ? ": eval over spans of the pixels" : ": eval over spans, in parallel"),
         1.2, false});
  }
  const std::string spans = ": eval over spans of the pixels";
  ratios.push_back({all_subjects.back().name + spans, all_subjects.front().name + spans, 4.0, false});
  const render::Image image = render::draw_slice(all_subjects.front().material, options);
  for (const auto transform :
       {render::ViewTransform::kLinear, render::ViewTransform::kSrgb, render::ViewTransform::kGranTurismo}) {
    race.add("to_picture, " + std::string(render::name_of(transform)), pixels.size(), [&image, transform] {
      g_sink = render::to_picture(image, {transform, 0.0, render::Channel::kRgb}).rgb.back();
    });
  }
  const Grid grid;
  const MeasuredTable table(grid, std::vector<float>(3 * grid.cell_count(), 0.25F));
  for (const auto sampling : {render::SliceSampling::kSmooth, render::SliceSampling::kStored}) {
    render::SliceOptions table_options = options;
    table_options.sampling = sampling;
    race.add(sampling == render::SliceSampling::kSmooth ? "draw_slice of a table, smooth"
                                                        : "draw_slice of a table, stored",
             pixels.size(),
             [&table, table_options] { g_sink = render::draw_slice(table, table_options).rgb.back(); });
  }
  race.run(turns);
  std::printf("\nDrawing a slice of %d x %d pixels, %d thread%s\n", options.size, options.size, threads,
              threads == 1 ? "" : "s");
  race.print_times();
  std::printf("\n");
  print_ratios(race, ratios);
}

}  // namespace

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::max(1, std::atoi(argv[1])) : 31;
  const auto isa = simd::name_of(simd::best_isa());
  std::printf("Vector code: %.*s; medians of %d turns\n", static_cast<int>(isa.size()), isa.data(), turns);
  const render::SliceOptions options;
  race_kernels(options, 10 * turns);
  race_drawing(options, turns, 1);
  const int threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  if (threads > 1) race_drawing(options, turns, threads);
  return 0;
}
