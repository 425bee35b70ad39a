// Evaluates a recipe's material over its grid, with noise and holes.
#include "data/synthetic/generate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <span>
#include <stdexcept>

#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "data/synthetic/counter_random.h"
#include "data/synthetic/holes.h"
#include "data/synthetic/streams.h"
#include "io/merl.h"

namespace brdfit::synthetic {
namespace {

constexpr Rgb kNotMeasured = {-1.0, -1.0, -1.0};

// The measured cells of one theta_h row, and their directions.
struct Row {
  std::vector<std::size_t> cell;
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  std::size_t dropped = 0;
};

Row measured_cells(const Grid& grid, const Holes& holes, int i_theta_h) {
  Row row;
  for (int d = 0; d < grid.n_theta_d; ++d) {
    for (int p = 0; p < grid.n_phi_d; ++p) {
      const DirectionPair pair = directions_from_half_diff(grid.angles(i_theta_h, d, p));
      if (!above_horizon(pair)) continue;
      if (holes.dropped(i_theta_h, d, p, pair)) {
        ++row.dropped;
        continue;
      }
      row.cell.push_back(grid.index(i_theta_h, d, p));
      row.wi.push_back(pair.wi);
      row.wo.push_back(pair.wo);
    }
  }
  return row;
}

// The mean of both ways round.
std::vector<Rgb> evaluate(const Material& material, const Row& row) {
  std::vector<Rgb> forth(row.cell.size());
  std::vector<Rgb> back(row.cell.size());
  eval(material, row.wi, row.wo, forth);
  eval(material, row.wo, row.wi, back);
  for (std::size_t k = 0; k < forth.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) forth[k][c] = 0.5 * (forth[k][c] + back[k][c]);
  }
  return forth;
}

class Measurement {
 public:
  explicit Measurement(const Recipe& recipe)
      : noise_(recipe.noise),
        multiplicative_(recipe.seed, kMultiplicativeStream),
        additive_(recipe.seed, kAdditiveStream) {}

  // The value that a cell's channel is measured at; below 0 where additive noise takes it there.
  double measure(double exact, std::size_t cell, std::size_t channel) const {
    const std::uint64_t counter = 3 * static_cast<std::uint64_t>(cell) + channel;
    double value = exact;
    if (noise_.multiplicative > 0.0)
      value *= std::exp(noise_.multiplicative * multiplicative_.normal(counter));
    if (noise_.additive > 0.0) value += noise_.additive * additive_.normal(counter);
    return value;
  }

 private:
  Noise noise_;
  CounterRandom multiplicative_;
  CounterRandom additive_;
};

// Fills the row's cells; the report of this row alone.
GenerateReport generate_row(const Recipe& recipe, const Holes& holes, const Measurement& measurement,
                            int i_theta_h, std::span<Rgb> values) {
  const Row row = measured_cells(recipe.grid, holes, i_theta_h);
  const std::vector<Rgb> exact = evaluate(recipe.material, row);
  GenerateReport report;
  report.valid = row.cell.size();
  report.dropped = row.dropped;
  for (std::size_t k = 0; k < row.cell.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = measurement.measure(exact[k][c], row.cell[k], c);
      report.floored_at_zero += value < 0.0 ? 1 : 0;
      values[row.cell[k]][c] = value < 0.0 ? 0.0 : value;
    }
  }
  return report;
}

GenerateReport sum_of(const Recipe& recipe, const std::vector<GenerateReport>& rows) {
  GenerateReport sum;
  sum.cells = recipe.grid.cell_count();
  sum.seed = recipe.seed;
  for (const GenerateReport& row : rows) {
    sum.valid += row.valid;
    sum.dropped += row.dropped;
    sum.floored_at_zero += row.floored_at_zero;
  }
  return sum;
}

}  // namespace

std::vector<Rgb> generate_values(const Recipe& recipe, GenerateReport* report) {
  std::string why;
  if (!recipe.is_valid(&why)) throw std::invalid_argument("recipe: " + why);
  std::vector<Rgb> values(recipe.grid.cell_count(), kNotMeasured);
  std::vector<GenerateReport> rows(static_cast<std::size_t>(recipe.grid.n_theta_h));
  const Holes holes(recipe);
  const Measurement measurement(recipe);
  tbb::parallel_for(
      tbb::blocked_range<int>(0, recipe.grid.n_theta_h), [&](const tbb::blocked_range<int>& range) {
        for (int h = range.begin(); h < range.end(); ++h) {
          rows[static_cast<std::size_t>(h)] = generate_row(recipe, holes, measurement, h, values);
        }
      });
  if (report != nullptr) *report = sum_of(recipe, rows);
  return values;
}

MeasuredTable generate_table(const Recipe& recipe, GenerateReport* report) {
  const std::vector<Rgb> values = generate_values(recipe, report);
  std::vector<float> planes(3 * values.size());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < values.size(); ++k)
      planes[c * values.size() + k] = static_cast<float>(values[k][c]);
  }
  return MeasuredTable(recipe.grid, std::move(planes));
}

GenerateReport generate(const Recipe& recipe, const std::filesystem::path& merl_file) {
  GenerateReport report;
  const std::vector<Rgb> values = generate_values(recipe, &report);
  if (report.valid == 0) {
    throw io::IoError(io::IoError::Side::kOutput, merl_file.string(), "the recipe leaves no valid cell",
                      "at least one",
                      "lower invalid.fraction or invalid.blocks, or raise invalid.max_theta_deg");
  }
  io::write_merl(merl_file, recipe.grid,
                 [&](int h, int d, int p) { return values[recipe.grid.index(h, d, p)]; });
  return report;
}

}  // namespace brdfit::synthetic
