// The pictures that compare a reference with models: for `compare` and `report`.
#ifndef BRDFIT_CLI_COMPARISON_H_
#define BRDFIT_CLI_COMPARISON_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "cli/picture_options.h"
#include "render/difference.h"
#include "render/image.h"
#include "render/panel.h"
#include "render/subject.h"

namespace brdfit::cli {

// The pictures in the order in which they are drawn.
inline constexpr std::array<const char*, 6> kComparisonPictures = {"slices",       "spheres", "patches",
                                                                   "environments", "lobes",   "polar"};

struct ComparisonOptions {
  std::vector<std::string> pictures;  // of kComparisonPictures; empty: all
  int slice_size = 320;
  int sphere_size = 160;
  render::ViewOptions view;
  SliceArguments slice;
  // Of all pictures. Where it is not given, slices show log-ratios, as signed differences of f are those of
  // the highlight alone, and spheres signed differences.
  std::optional<render::DifferenceKind> difference;
  double range = 0.0;

  bool has(const std::string& picture) const;
};

// One picture, either drawn or as SVG text (with an XML header).
struct ComparisonPicture {
  std::string name;  // of kComparisonPictures
  std::string caption;
  std::string alt;
  render::Picture picture;
  std::string svg;  // used where the picture is empty
};

// title: the material's name. reference may be absent: the first of the candidates stands in its place. lines
// of a column stand below the slices alone. Throws std::invalid_argument when there is nothing to draw.
std::vector<ComparisonPicture> draw_comparison(const std::string& title,
                                               std::span<const render::Column> columns,
                                               const ComparisonOptions& options);

// What stands below a column, "name\tvalue": the errors of a candidate against the reference (sphere dE
// included), its effects and parameters; or what a reference table holds.
std::vector<std::string> candidate_lines(const render::Subject& candidate, const MeasuredTable* reference);
std::vector<std::string> reference_lines(const MeasuredTable& reference);
std::vector<std::string> material_lines(const Material& material);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COMPARISON_H_
