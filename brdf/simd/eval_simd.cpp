// Vectorised evaluation of materials. Compiled once for every instruction set.
#include <cstring>

#include "brdf/simd/model_lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

template <class ModelLanes>
HWY_INLINE void eval_at(const ModelLanes& model, const kernel::Geometry<V>& g,
                        const kernel::GeometryLogs<V>& logs, std::size_t at, double* const out[3]) {
  const auto terms = model.terms(g, logs);
  for (int c = 0; c < 3; ++c) {
    kernel::above_horizon(model.combine(c, terms), g.cos_i, g.cos_o).store(out[c] + at);
  }
}

template <class ModelLanes>
HWY_FLATTEN void eval_model(const Coefficients& k, const GeometryColumns& columns, std::size_t count,
                            double* const out[3]) {
  const ModelLanes model(k);
  for (std::size_t at = 0; at < count; at += V::size) {
    kernel::GeometryLogs<V> logs = {V(0.0), V(0.0), V(0.0), V(0.0)};
    if constexpr (ModelLanes::uses_logs) logs = load_logs(columns, at);
    eval_at(model, load_geometry(columns, at), logs, at, out);
  }
}

template <class ModelLanes>
HWY_FLATTEN void eval_model(const Coefficients& k, const DirectionColumns& w, std::size_t count,
                            double* const out[3]) {
  const ModelLanes model(k);
  for (std::size_t at = 0; at < count; at += V::size) {
    const kernel::Geometry<V> g =
        kernel::geometry_from_directions(V::load(w.wi_x + at), V::load(w.wi_y + at), V::load(w.wi_z + at),
                                         V::load(w.wo_x + at), V::load(w.wo_y + at), V::load(w.wo_z + at));
    kernel::GeometryLogs<V> logs = {V(0.0), V(0.0), V(0.0), V(0.0)};
    if constexpr (ModelLanes::uses_logs) logs = kernel::geometry_logs(g);
    eval_at(model, g, logs, at, out);
  }
}

template <class Columns>
void eval_any(const Coefficients& k, const Columns& columns, std::size_t count, double* const out[3]) {
  if (k.model == 0) return eval_model<LambertGgxLanes>(k, columns, count, out);
  if (k.model == 1) return eval_model<BurleyLanes>(k, columns, count, out);
  eval_model<CallistoLanes>(k, columns, count, out);
}

// One of the lines that the lanes of a struct of V hold, in all lanes.
template <class Line>
HWY_INLINE Line spread(const Line& lines, std::size_t lane) {
  constexpr std::size_t kMembers = sizeof(Line) / sizeof(V);
  double from[kMembers][V::size];
  V to[kMembers];
  std::memcpy(from, &lines, sizeof(Line));
  for (std::size_t m = 0; m < kMembers; ++m) to[m] = V(from[m][lane]);
  Line line;
  std::memcpy(&line, to, sizeof(Line));
  return line;
}

template <class ModelLanes, class Line>
HWY_INLINE void eval_pairs(const ModelLanes& model, const Line& line, kernel::Geometry<V> g,
                           const LineColumns& columns, std::size_t first, std::size_t count,
                           double* const f[3], double* const swapped[3]) {
  for (std::size_t at = first; at < first + count; at += V::size) {
    const V cos_i = V::load(columns.cos_i + at);
    const V cos_o = V::load(columns.cos_o + at);
    const auto put = [&](V lobe, double* const out[3]) HWY_ATTR {
      const auto terms = model.terms(line, lobe, g);
      const V inverse = V(1.0) / g.cos_i;
      for (int c = 0; c < 3; ++c) (model.combine(c, terms) * inverse).store(out[c] + at);
    };
    g.cos_i = cos_i;
    g.cos_o = cos_o;
    const V lobe = model.lobe(line, g);
    put(lobe, f);
    if (swapped == nullptr) continue;
    g.cos_i = cos_o;
    g.cos_o = cos_i;
    put(lobe, swapped);
  }
}

template <class ModelLanes>
HWY_FLATTEN void eval_lines_of(const Coefficients& k, const LineColumns& columns, double* const f[3],
                               double* const swapped[3]) {
  static_assert(kLines % V::size == 0 && kLineBlock % V::size == 0);
  const ModelLanes model(k);
  kernel::Geometry<V> g;
  g.h_x = V(columns.sin_h);
  g.h_y = V(0.0);
  g.cos_h = V(columns.cos_h);
  g.one_minus_cos_h = V(columns.one_minus_cos_h);
  g.cos_i = g.cos_o = V(1.0);
  g.wi_x = g.wi_y = g.wo_x = g.wo_y = V(0.0);
  kernel::GeometryLogs<V> logs;
  logs.cos_h = V(columns.log_cos_h);
  logs.one_minus_cos_h = V(columns.log_one_minus_cos_h);
  for (std::size_t first = 0; first < kLines; first += V::size) {
    g.cos_d = V::load(columns.cos_d + first);
    g.one_minus_cos_d = V::load(columns.one_minus_cos_d + first);
    logs.cos_d = V::load(columns.log_cos_d + first);
    logs.one_minus_cos_d = V::load(columns.log_one_minus_cos_d + first);
    const auto lines = model.line(g, logs);
    for (std::size_t lane = 0; lane < V::size; ++lane) {
      const std::size_t i = first + lane;
      kernel::Geometry<V> of_line = g;
      of_line.cos_d = V(columns.cos_d[i]);
      of_line.cos_k = kernel::cos_k_from_cos_d(of_line.cos_d);
      of_line.one_minus_cos_d = V(columns.one_minus_cos_d[i]);
      eval_pairs(model, spread(lines, lane), of_line, columns, i * columns.stride, columns.count[i], f,
                 swapped);
    }
  }
}

}  // namespace

void eval_lines(const Coefficients& k, const LineColumns& columns, double* const f[3],
                double* const swapped[3]) {
  if (k.model == 0) return eval_lines_of<LambertGgxLanes>(k, columns, f, swapped);
  if (k.model == 1) return eval_lines_of<BurleyLanes>(k, columns, f, swapped);
  eval_lines_of<CallistoLanes>(k, columns, f, swapped);
}

void eval_columns(const Coefficients& k, const GeometryColumns& columns, std::size_t count,
                  double* const out[3]) {
  eval_any(k, columns, count, out);
}

void eval_directions(const Coefficients& k, const DirectionColumns& columns, std::size_t count,
                     double* const out[3]) {
  eval_any(k, columns, count, out);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
