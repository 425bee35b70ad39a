// Evaluation on the processor in double, and what all evaluators are asked.
#include "cli/cost/evaluators.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "brdf/product_eval.h"
#include "brdf/simd/dispatch.h"
#include "cli/cost/paired_timing.h"
#include "measured/grid_geometry.h"

namespace brdfit::cli {
namespace {

double eval_by_vectors(const Material& material, const DirectionPairs& pairs, std::span<Rgb> out) {
  const double start = thread_cpu_seconds();
  eval_cos(material, pairs.wi, pairs.wo, out);
  return 1e9 * (thread_cpu_seconds() - start);
}

// One pair after another; coefficients are made once, as a renderer keeps them.
double eval_one_by_one(const Material& material, const DirectionPairs& pairs, std::span<Rgb> out) {
  const double start = thread_cpu_seconds();
  const std::vector<double> q = product_form(material);
  with_coefficients(material.model(), material.effects(), q.data(), [&](const auto& coefficients) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Vec3& wi = pairs.wi[k];
      const Vec3& wo = pairs.wo[k];
      const auto g = kernel::geometry_from_directions(wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
      out[k] = eval_coefficients(coefficients, material.options(), material.effects(), g);
    }
  });
  return 1e9 * (thread_cpu_seconds() - start);
}

// Cells of a table with the pairs that they stand for.
struct Cells {
  std::vector<std::size_t> indices;
  DirectionPairs pairs;

  void clear() {
    indices.clear();
    pairs.wi.clear();
    pairs.wo.clear();
  }
};

// Puts the values of some cells into planes of a whole grid.
void fill(const Evaluator& evaluator, const Material& material, const Cells& cells, std::size_t plane_size,
          std::vector<float>& planes) {
  std::vector<Rgb> straight(cells.pairs.size());
  std::vector<Rgb> swapped(cells.pairs.size());
  evaluator.eval_cos(material, cells.pairs, straight);
  evaluator.eval_cos(material, {cells.pairs.wo, cells.pairs.wi}, swapped);
  for (std::size_t k = 0; k < cells.indices.size(); ++k) {
    const double cos_i = cells.pairs.wi[k].z;
    const double cos_o = cells.pairs.wo[k].z;
    for (std::size_t c = 0; c < 3; ++c) {
      planes[c * plane_size + cells.indices[k]] =
          static_cast<float>(0.5 * (straight[k][c] / cos_i + swapped[k][c] / cos_o));
    }
  }
}

}  // namespace

DirectionPairs pairs_to_time(std::size_t count) {
  std::mt19937_64 random(1);
  // The standard's distributions differ between libraries.
  const auto even = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto direction = [&] {
    const double z = 1.0 - even();
    const double phi = 2.0 * std::numbers::pi * even();
    const double r = std::sqrt(1.0 - z * z);
    return Vec3{r * std::cos(phi), r * std::sin(phi), z};
  };
  DirectionPairs pairs;
  for (std::size_t k = 0; k < count; ++k) {
    pairs.wi.push_back(direction());
    pairs.wo.push_back(direction());
  }
  return pairs;
}

Evaluators run_time_evaluators(const std::string& device) {
  Evaluators evaluators;
  const std::string_view isa = simd::name_of(simd::best_isa());
  evaluators.all.push_back({"double", "processor, vectors of " + std::string(isa), eval_by_vectors});
  evaluators.all.push_back({"double", "processor, pair by pair", eval_one_by_one});
  add_gpu_evaluators(device, evaluators);
  return evaluators;
}

double time_evaluation(const Evaluator& evaluator, const Material& material, const DirectionPairs& pairs) {
  std::vector<Rgb> out(pairs.size());
  return evaluator.eval_cos(material, pairs, out) / static_cast<double>(pairs.size());
}

MeasuredTable table_by(const Evaluator& evaluator, const Material& material, const MeasuredTable& reference) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 16;
  const Grid& grid = reference.grid();
  const double lowest = lowest_observed_cosine(90.0);
  std::vector<float> planes(3 * grid.cell_count(), -1.0F);
  Cells cells;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    if (!reference.is_valid(cell)) continue;
    const DirectionPair pair = directions_from_half_diff(grid.angles_of(cell));
    if (pair.wi.z < lowest || pair.wo.z < lowest) continue;
    cells.indices.push_back(cell);
    cells.pairs.wi.push_back(pair.wi);
    cells.pairs.wo.push_back(pair.wo);
    if (cells.indices.size() < kAtOnce) continue;
    fill(evaluator, material, cells, grid.cell_count(), planes);
    cells.clear();
  }
  if (!cells.indices.empty()) fill(evaluator, material, cells, grid.cell_count(), planes);
  return MeasuredTable(grid, std::move(planes));
}

}  // namespace brdfit::cli
