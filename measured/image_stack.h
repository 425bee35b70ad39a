// A stack of registered photographs, one per light: what a capture is to everything that works on it.
//
// Frame: x to the right of the picture, y up, z towards the viewer. Pixel (0, 0) is the upper left one; rows
// go down. Values are linear Rec.709 radiances, divided by exposure: a white Lambert surface that faces a
// light of intensity 1 has radiance 1, so that a render is pi f(wi, wo) cos_i times the light's irradiance.
#ifndef BRDFIT_MEASURED_IMAGE_STACK_H_
#define BRDFIT_MEASURED_IMAGE_STACK_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/vec3.h"

namespace brdfit {

// One light of a capture.
struct StackLight {
  std::string name;              // of its picture
  Vec3 direction;                // unit, towards the light; of a near light as seen from the picture's centre
  std::optional<Vec3> position;  // of a near point light, in the stack's units
  Rgb intensity{1.0, 1.0, 1.0};  // linear; of a near light at the distance of the picture's centre
};

// Where texels lie in space; needed for near lights only.
struct ImagePlane {
  Vec3 origin{0.0, 0.0, 0.0};  // centre of the upper left pixel, in the stack's units
  double pixel_size = 1.0;     // in the same units
};

// What is known of a stack before its pixels are read.
struct StackInfo {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<StackLight> lights;
  Vec3 view{0.0, 0.0, 1.0};  // unit, towards the camera, the same for all texels
  ImagePlane plane;
  bool has_normals = false;
  bool has_albedo = false;
  std::size_t texel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

// Direction towards a light and its irradiance factor (1 for a directional light; the inverse square of the
// distance, over that of the picture's centre, for a near one) at a texel.
struct Incidence {
  Vec3 direction;
  double falloff = 1.0;
};
Incidence incidence(const StackInfo& info, std::size_t light, std::uint32_t texel);
// Of all lights, in their order; of near ones as seen from the picture's centre.
std::vector<Vec3> directions_of(const StackInfo& info);
// Whether any light is near, that is whether directions differ between texels.
bool has_near_lights(const StackInfo& info);

// Texels with their values under every light, as planes: a run of rows, or any choice of texels.
struct TexelBlock {
  std::vector<std::uint32_t> texels;  // index y * width + x of each
  std::size_t lights = 0;
  std::vector<float> rgb;      // [light][channel][texel], linear, finite
  std::vector<float> weight;   // [light][texel] in [0, 1]: 0 where a value cannot be used (not finite,
                               // saturated, masked). Empty: all 1.
  std::vector<float> normals;  // [3][texel], unit; empty unless the stack has them
  std::vector<float> albedo;   // [channel][texel]; empty unless the stack has it
  std::size_t channels = 3;    // of rgb; 1 where it holds luminance alone

  std::size_t count() const { return texels.size(); }
  std::span<float> plane(std::size_t light, std::size_t channel) {
    return std::span(rgb).subspan((light * channels + channel) * count(), count());
  }
  std::span<const float> plane(std::size_t light, std::size_t channel) const {
    return std::span(rgb).subspan((light * channels + channel) * count(), count());
  }
  float weight_of(std::size_t light, std::size_t texel) const {
    return weight.empty() ? 1.0F : weight[light * count() + texel];
  }
};

// A stack that hands out its rows. Rows are cheapest from top to bottom: many formats decode only that way.
class ImageStack {
 public:
  virtual ~ImageStack() = default;
  virtual const StackInfo& info() const = 0;
  // The texels of rows [first_row, first_row + rows) under every light. Throws what the source throws when it
  // cannot be read. Not to be called from two threads at once; decodes in parallel inside.
  virtual TexelBlock read_rows(int first_row, int rows) = 0;
  // The same with luminance (ITU-R BT.709) in place of colours: channels is 1. A third of the memory, and
  // cheaper where pictures are decoded.
  virtual TexelBlock read_luminance(int first_row, int rows);
  // Any texels (ascending indices), in one pass over the pictures.
  virtual TexelBlock read_texels(std::span<const std::uint32_t> texels) = 0;
  // A block that is used no more: the next one takes its memory, which costs less than new pages.
  virtual void give_back(TexelBlock) {}
};

// A stack that is already in memory: for tests, and for stages that work on a choice of texels.
class MemoryStack : public ImageStack {
 public:
  // block must hold all texels of info in order. Throws std::invalid_argument where sizes disagree.
  MemoryStack(StackInfo info, TexelBlock block);
  const StackInfo& info() const override { return info_; }
  TexelBlock read_rows(int first_row, int rows) override;
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override;

 private:
  StackInfo info_;
  TexelBlock block_;
};

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_IMAGE_STACK_H_
