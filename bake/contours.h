// Shadow contours in a photograph and in its render, and the weight of texels that lie between the two
// (Jimenez et al. 2023, slides on shadowing mismatch): there the error is one of where a shadow falls, and
// not one of the material.
#ifndef BRDFIT_BAKE_CONTOURS_H_
#define BRDFIT_BAKE_CONTOURS_H_

#include <array>
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

// Rows [first, last) of a picture, or of a part of it that is made of whole rows.
struct Rows {
  int first = 0;
  int last = 0;
};

// V = mean of |neighbour - centre| over the up to eight neighbours of each texel.
std::vector<float> variation(std::span<const float> luminance, int width, int height);

// Variation of lit and of shadowed areas, away from where they meet. Rows of a picture that are added in
// their order give the same to the bit however they are cut into parts.
struct VariationSums {
  std::array<double, 2> sum{};    // of V: in shadow, lit
  std::array<double, 2> count{};  // of texels
};

// Adds rows of a part of a picture; one row on either side of them must be in the part, unless they are the
// picture's own first or last.
void add_variation(VariationSums& sums, const ShadowPicture& part, int width, int height, const Rows& rows);

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

// The same of a part of a picture, with the sums of all of it. Wrong in the part's first and last row, unless
// they are the picture's.
ShadowContours find_contours(const ShadowPicture& part, int width, int height, const VariationSums& sums,
                             const ContourOptions& options);

// Rows on either side of some others that must be in a part, so that the weights of those are the picture's.
int contour_halo(const ContourOptions& options);

// Weights in (0, 1] of texels: less the farther apart the two contours are for those in between, that is lit
// in one picture and shadowed in the other with both contours within reach; 1 elsewhere.
std::vector<float> contour_weights(const ShadowContours& reference, const ShadowContours& render, int width,
                                   int height, const ContourOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CONTOURS_H_
