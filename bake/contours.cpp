// Shadow contours in pictures, and the weight of what lies between two of them.
#include "bake/contours.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace brdfit::bake {
namespace {

void check_size(std::size_t size, int width, int height) {
  if (width < 1 || height < 1 || size != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::invalid_argument("contours: sizes disagree");
  }
}

void check(const ContourOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("contours: " + why);
}

// Calls use(index of the texel, index of a neighbour) for each of the up to eight neighbours.
template <class Use>
void for_neighbours(int x, int y, int width, int height, const Use& use) {
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
      if (u == x && v == y) continue;
      use(static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u));
    }
  }
}

template <class Use>
void for_texels(int width, int height, const Use& use) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      use(x, y, static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
  }
}

// How lit a texel is, from 0 to 1.
double litness(const ShadowPicture& picture, std::size_t at) {
  if (!(picture.unshadowed[at] > 0.0F)) return 0.0;
  return std::clamp(static_cast<double>(picture.luminance[at]) / picture.unshadowed[at], 0.0, 1.0);
}

std::vector<std::uint8_t> lit_texels(const ShadowPicture& picture) {
  std::vector<std::uint8_t> is_lit(picture.luminance.size());
  for (std::size_t k = 0; k < is_lit.size(); ++k) is_lit[k] = litness(picture, k) > 0.5 ? 1 : 0;
  return is_lit;
}

// Texels that have lit and shadowed ones about them.
std::vector<std::uint8_t> border_texels(std::span<const std::uint8_t> is_lit, int width, int height) {
  std::vector<std::uint8_t> is_border(is_lit.size(), 0);
  for_texels(width, height, [&](int x, int y, std::size_t at) {
    for_neighbours(x, y, width, height, [&](std::size_t neighbour) {
      if (is_lit[neighbour] != is_lit[at]) is_border[at] = 1;
    });
  });
  return is_border;
}

void check(const ShadowPicture& picture, int width, int height) {
  check_size(picture.luminance.size(), width, height);
  check_size(picture.unshadowed.size(), width, height);
  check_size(picture.facing.size(), width, height);
}

bool is_any(std::span<const std::uint8_t> flags) {
  return std::ranges::any_of(flags, [](std::uint8_t flag) { return flag != 0; });
}

// Distance in pixels to the nearest contour, of which there is one at least.
cv::Mat distance_to(std::span<const std::uint8_t> is_contour, int width, int height) {
  cv::Mat empty(height, width, CV_8U);
  std::transform(is_contour.begin(), is_contour.end(), empty.begin<std::uint8_t>(),
                 [](std::uint8_t contour) { return static_cast<std::uint8_t>(contour != 0 ? 0 : 1); });
  cv::Mat distance;
  cv::distanceTransform(empty, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

}  // namespace

bool ContourOptions::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (!(threshold > 0.0)) return fails("threshold must be positive");
  if (!(reach > 0.0)) return fails("reach must be positive");
  if (!(half_weight_gap > 0.0)) return fails("half_weight_gap must be positive");
  return true;
}

std::vector<float> variation(std::span<const float> luminance, int width, int height) {
  check_size(luminance.size(), width, height);
  std::vector<float> v(luminance.size(), 0.0F);
  for_texels(width, height, [&](int x, int y, std::size_t at) {
    float sum = 0.0F;
    int count = 0;
    for_neighbours(x, y, width, height, [&](std::size_t neighbour) {
      sum += std::abs(luminance[neighbour] - luminance[at]);
      ++count;
    });
    if (count > 0) v[at] = sum / static_cast<float>(count);
  });
  return v;
}

void add_variation(VariationSums& sums, const ShadowPicture& part, int width, int height, const Rows& rows) {
  check(part, width, height);
  if (rows.first < 0 || rows.first > rows.last || rows.last > height) {
    throw std::invalid_argument("contours: rows outside the part");
  }
  const std::vector<float> v = variation(part.luminance, width, height);
  const std::vector<std::uint8_t> is_lit = lit_texels(part);
  const std::vector<std::uint8_t> is_border = border_texels(is_lit, width, height);
  const auto stride = static_cast<std::size_t>(width);
  for (std::size_t k = static_cast<std::size_t>(rows.first) * stride;
       k < static_cast<std::size_t>(rows.last) * stride; ++k) {
    if (is_border[k] != 0) continue;
    sums.sum[is_lit[k]] += v[k];
    sums.count[is_lit[k]] += 1.0;
  }
}

ShadowContours find_contours(const ShadowPicture& picture, int width, int height,
                             const ContourOptions& options) {
  VariationSums sums;
  add_variation(sums, picture, width, height, {0, height});
  return find_contours(picture, width, height, sums, options);
}

ShadowContours find_contours(const ShadowPicture& part, int width, int height, const VariationSums& sums,
                             const ContourOptions& options) {
  check(options);
  check(part, width, height);
  const std::vector<float> v = variation(part.luminance, width, height);
  ShadowContours result;
  result.is_lit = lit_texels(part);
  result.is_contour.assign(v.size(), 0);
  const std::vector<std::uint8_t> is_border = border_texels(result.is_lit, width, height);
  const auto average = [&](std::size_t kind) {
    return sums.count[kind] > 0.0 ? sums.sum[kind] / sums.count[kind] : 0.0;
  };
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (is_border[k] == 0) continue;
    const double likelihood = std::max(static_cast<double>(part.facing[k]), 0.0);
    const double usual = std::lerp(average(0), average(1), litness(part, k));
    if (likelihood * v[k] > options.threshold * usual) result.is_contour[k] = 1;
  }
  return result;
}

int contour_halo(const ContourOptions& options) {
  return static_cast<int>(std::ceil(options.reach)) + 1;
}

std::vector<float> contour_weights(const ShadowContours& reference, const ShadowContours& render, int width,
                                   int height, const ContourOptions& options) {
  check(options);
  for (const auto* size : {&reference.is_lit, &reference.is_contour, &render.is_lit, &render.is_contour}) {
    check_size(size->size(), width, height);
  }
  std::vector<float> weights(reference.is_lit.size(), 1.0F);
  if (!is_any(reference.is_contour) || !is_any(render.is_contour)) return weights;
  const cv::Mat to_reference = distance_to(reference.is_contour, width, height);
  const cv::Mat to_render = distance_to(render.is_contour, width, height);
  for_texels(width, height, [&](int x, int y, std::size_t at) {
    if (reference.is_lit[at] == render.is_lit[at]) return;
    const double gap = to_reference.at<float>(y, x) + to_render.at<float>(y, x);
    if (!(gap <= options.reach)) return;
    const double share = gap / options.half_weight_gap;
    weights[at] = static_cast<float>(1.0 / (1.0 + share * share));
  });
  return weights;
}

}  // namespace brdfit::bake
