// Vectorised evaluation of materials. Compiled once for every instruction set.
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

}  // namespace

void eval_columns(const Coefficients& k, const GeometryColumns& columns, std::size_t count,
                  double* const out[3]) {
  eval_any(k, columns, count, out);
}

void eval_directions(const Coefficients& k, const DirectionColumns& columns, std::size_t count,
                     double* const out[3]) {
  eval_any(k, columns, count, out);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
