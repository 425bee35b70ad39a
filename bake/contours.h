// Shadow contours in a photograph and in its render, and the weight of texels that lie between the two
// (Jimenez et al. 2023, slides on shadowing mismatch): there the error is one of where a shadow falls, and
// not one of the material.
#ifndef BRDFIT_BAKE_CONTOURS_H_
#define BRDFIT_BAKE_CONTOURS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace brdfit::bake {

struct ContourOptions {
  // A texel is on a contour where its variation, times n.l, exceeds this many average variations.
  double threshold = 1.5;
  // Pixels: how far apart two contours may be to count as those of one shadow.
  double reach = 24.0;
  // Pixels: half of the weight is lost where the contours are this far apart.
  double half_weight_gap = 3.0;

  bool is_valid(std::string* why) const;
};

// One picture under one light: luminances, row by row from the top.
struct ShadowPicture {
  std::span<const float> luminance;
  // What each texel would show without shadows (its albedo times irradiance and cosine), in the same unit:
  // texels below half of it are in shadow.
  std::span<const float> unshadowed;
  std::span<const float> facing;  // n.l of each texel
};

// V = mean of |neighbour - centre| over the up to eight neighbours of each texel.
std::vector<float> variation(std::span<const float> luminance, int width, int height);

struct ShadowContours {
  std::vector<std::uint8_t> is_lit;
  std::vector<std::uint8_t> is_contour;
};

// Lit texels, and those on a contour: both lit and shadowed ones are among the texel and its neighbours, and
// V max(n.l, 0) exceeds the threshold times the average variation. That is taken over lit and over shadowed
// areas apart, away from where they meet, and blended by how lit the texel is, as texture shows less in
// shadow. Throws std::invalid_argument where sizes disagree.
ShadowContours find_contours(const ShadowPicture& picture, int width, int height,
                             const ContourOptions& options = {});

// Weights in (0, 1] of texels: less the farther apart the two contours are for those in between, that is lit
// in one picture and shadowed in the other with both contours within reach; 1 elsewhere.
std::vector<float> contour_weights(const ShadowContours& reference, const ShadowContours& render, int width,
                                   int height, const ContourOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CONTOURS_H_
