// A picture of where the lights of a capture are: the hemisphere seen from above.
#ifndef BRDFIT_RENDER_LIGHT_MAP_H_
#define BRDFIT_RENDER_LIGHT_MAP_H_

#include <string>
#include <vector>

#include "brdf/vec3.h"
#include "render/image.h"

namespace brdfit::render {

struct MappedLight {
  Vec3 direction;  // unit, z >= 0
  std::string label;
  bool is_near = false;     // drawn as a ring
  bool is_suspect = false;  // drawn in another colour, with its label
};

struct LightMapOptions {
  std::string title;
  std::string note;  // below the hemisphere
  int width_px = 640;
};

// Directions by their x (right) and y (up), so that the rim is the horizon; rings every 15 degrees of height.
// Labels stand at all lights where there are few, else at the suspects. Throw std::invalid_argument for a
// width below 320.
std::string light_map_svg(const std::vector<MappedLight>& lights, const LightMapOptions& options);

// The same as pixels. Throws as Canvas::text where there is no font.
Picture light_map_picture(const std::vector<MappedLight>& lights, const LightMapOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_LIGHT_MAP_H_
