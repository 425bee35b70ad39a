// What is drawn: a measured table or a material. The two are alike to every picture.
#ifndef BRDFIT_RENDER_SUBJECT_H_
#define BRDFIT_RENDER_SUBJECT_H_

#include <cstddef>
#include <span>

#include "brdf/half_diff.h"
#include "brdf/material.h"
#include "brdf/vec3.h"
#include "measured/table.h"
#include "render/image.h"

namespace brdfit::render {

// How a pixel that shows one cell of a table is shown.
PixelState pixel_state_of(CellState state);

// The stored cell that contains these angles; phi_d is folded into [0, pi).
std::size_t cell_of(const Grid& grid, const HalfDiff& angles);

// Refers to a table or a material, which must outlive it.
class Subject {
 public:
  Subject(const MeasuredTable& table) : table_(&table) {}      // NOLINT: a table is a subject
  Subject(const Material& material) : material_(&material) {}  // NOLINT: a material is a subject

  const MeasuredTable* table() const { return table_; }   // nullptr for a material
  const Material* material() const { return material_; }  // nullptr for a table

  // f cos_i in sr^-1 for pairs of directions, and the state of each: kValue, kBelowHorizon, or for a table
  // where no corner of the cell around was measured the reason. f is 0 where the state is not kValue. A table
  // is interpolated (MeasuredTable::interpolate). Throws std::invalid_argument if the sizes differ.
  void eval_cos(std::span<const Vec3> wi, std::span<const Vec3> wo, std::span<Rgb> out,
                std::span<PixelState> state) const;

 private:
  const MeasuredTable* table_ = nullptr;
  const Material* material_ = nullptr;
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_SUBJECT_H_
