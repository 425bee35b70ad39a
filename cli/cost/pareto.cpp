// Fronts by comparing every pair: sweeps have a hundred points.
#include "cli/cost/pareto.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brdfit::cli {
namespace {

// One row of figures per point; empty where one of them was not measured.
std::vector<std::vector<double>> rows_of(std::span<const CostPoint> points,
                                         std::span<const CostFigure> figures) {
  std::vector<std::vector<double>> rows;
  for (const CostPoint& point : points) {
    std::vector<double> row;
    for (const CostFigure& figure : figures) row.push_back(figure(point));
    if (std::ranges::any_of(row, [](double value) { return std::isnan(value); })) row.clear();
    rows.push_back(std::move(row));
  }
  return rows;
}

bool at_least_as_good(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b, std::less_equal<>());
}

}  // namespace

double make_seconds_of(const CostPoint& point) {
  return point.make_seconds.is_measured() ? point.make_seconds.median : kNotMeasured;
}

double evaluation_ns_of(const CostPoint& point) {
  return point.evaluation_ns.is_measured() ? point.evaluation_ns.median : kNotMeasured;
}

double bytes_of(const CostPoint& point) {
  return point.bytes;
}

std::vector<bool> front_of(std::span<const CostPoint> points, std::span<const CostFigure> figures) {
  const auto rows = rows_of(points, figures);
  const auto beats = [&](std::size_t a, std::size_t b) {
    if (a == b || rows[a].empty() || !at_least_as_good(rows[a], rows[b])) return false;
    return rows[a] != rows[b] || a < b;
  };
  std::vector<bool> front(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    front[k] = !rows[k].empty();
    for (std::size_t other = 0; other < points.size() && front[k]; ++other) front[k] = !beats(other, k);
  }
  return front;
}

void mark_fronts(CostRun& run) {
  const CostFigure error = [&run](const CostPoint& point) {
    return point.sweep == "device" ? kNotMeasured : error_of(point, run.leading_error);
  };
  const std::vector<bool> make = front_of(run.points, std::array{error, CostFigure(make_seconds_of)});
  const std::vector<bool> evaluation = front_of(run.points, std::array{error, CostFigure(evaluation_ns_of)});
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    run.points[k].on_make_front = make[k];
    run.points[k].on_run_front = evaluation[k];
  }
}

std::vector<std::size_t> by_cost(std::span<const CostPoint> points, bool CostPoint::*is_on_front,
                                 const CostFigure& cost) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k].*is_on_front) indices.push_back(k);
  }
  std::ranges::stable_sort(indices, {}, [&](std::size_t k) { return cost(points[k]); });
  return indices;
}

}  // namespace brdfit::cli
