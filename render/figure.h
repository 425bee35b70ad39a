// A single picture with what a reader needs around it: title, axes in degrees, region names, a legend of the
// pixels that have no value.
#ifndef BRDFIT_RENDER_FIGURE_H_
#define BRDFIT_RENDER_FIGURE_H_

#include <string>

#include "render/image.h"
#include "render/slice.h"
#include "render/view.h"

namespace brdfit::render {

struct FigureOptions {
  std::string title;
  ViewOptions view;
  bool axes = true;
  bool regions = false;  // names of the four regions: Fresnel, specular, retroreflection, diffuse
};

// Size of the text beside a picture of that many pixels: legible at half size too.
int figure_text_px(int picture_px);

// The states other than kValue and kOutside that a picture shows, in words: "312 pixels not measured
// (hatched grey); 3 pixels negative (hatched cyan)"; empty if there are none.
std::string describe_missing(const Image& image);

// A slice with axes. Text grows with the picture, so that it is legible at half size.
Picture slice_figure(const Image& slice, const SliceOptions& slice_options, const FigureOptions& options);

// Any other picture, with a title, and a caption below it (light angle, exposure, units).
Picture plain_figure(const Image& image, const std::string& caption, const FigureOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_FIGURE_H_
