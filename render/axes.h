// Axes of a slice: ticks in degrees, names, and the names of its four regions.
#ifndef BRDFIT_RENDER_AXES_H_
#define BRDFIT_RENDER_AXES_H_

#include <vector>

#include "render/canvas.h"
#include "render/slice.h"

namespace brdfit::render {

struct Tick {
  int deg = 0;
  int pixel = 0;  // from the angle 0 of the axis, at the outer edge of the pixels: 0 ... size
};

// 0, 15, ..., 90 degrees; on the square-root axis 1 and 5 too.
std::vector<Tick> theta_h_ticks(ThetaHAxis axis, int size);
std::vector<Tick> theta_d_ticks(int size);

// How much of the axes is drawn.
enum class AxisDetail {
  kTicks,  // marks alone
  kFull,   // numbers and names too
};

// Room that the axes of a slice of that size take beside it.
struct AxisRoom {
  int left = 0;
  int right = 0;
  int top = 0;
  int bottom = 0;
};
AxisRoom axis_room(AxisDetail detail, int text_px);

// Around a picture of the slice whose top left pixel is at (x, y). A number that would touch its neighbour is
// left out, its mark stays.
void draw_axes(Canvas& canvas, int x, int y, const SliceOptions& slice, AxisDetail detail, int text_px);

// Onto the picture, in white with a dark outline, smaller than text_px where there is no room. The regions
// are those of a slice at phi_d near 90 degrees (Burley 2012).
void draw_region_names(Canvas& canvas, int x, int y, int size, int text_px);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_AXES_H_
