// Comparison panels: a reference and models side by side at one exposure, differences below, and what the
// numbers say under each column.
#ifndef BRDFIT_RENDER_PANEL_H_
#define BRDFIT_RENDER_PANEL_H_

#include <span>
#include <string>
#include <vector>

#include "render/difference.h"
#include "render/figure.h"
#include "render/slice.h"
#include "render/sphere.h"
#include "render/subject.h"
#include "render/view.h"

namespace brdfit::render {

// One column.
struct Column {
  std::string title;  // "measured", "Callisto"
  Subject subject;
  std::vector<std::string> lines;  // below the pictures: errors, effects, parameters; an empty line is a gap
};

struct PanelOptions {
  std::string title;  // the material's name
  ViewOptions view;
  DifferenceKind difference = DifferenceKind::kSigned;
  bool show_difference = true;
  double range = 0.0;  // of the colour bar; 0: chosen from the differences
  bool regions = false;
};

// All panels throw std::invalid_argument when there is no column or no light, for a range that is negative or
// not finite, and as draw_slice, draw_lit and draw_environment do. They are the same whatever the threads.

// Slices on one pixel grid (for stored sampling that of the reference's table, if it is one). slice.size is
// that of each picture. The first column is the reference.
Picture slice_panel(std::span<const Column> columns, const SliceOptions& slice, const PanelOptions& options);

// Spheres (or patches) under the given light angles, one row each, every row followed by its differences.
Picture sphere_panel(std::span<const Column> columns, Shape shape, std::span<const double> light_angles_deg,
                     int size, const PanelOptions& options);

// Spheres under both environments.
Picture environment_panel(std::span<const Column> columns, int size, const PanelOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_PANEL_H_
