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

// Average variation of lit and of shadowed areas, without the texels that have both around them.
struct Averages {
  double lit = 0.0;
  double shadowed = 0.0;
};

Averages average_variation(std::span<const float> v, std::span<const std::uint8_t> is_lit,
                           std::span<const std::uint8_t> is_border) {
  double sum[2] = {0.0, 0.0};
  double count[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (is_border[k] != 0) continue;
    sum[is_lit[k]] += v[k];
    count[is_lit[k]] += 1.0;
  }
  return {count[1] > 0.0 ? sum[1] / count[1] : 0.0, count[0] > 0.0 ? sum[0] / count[0] : 0.0};
}

// Distance in pixels to the nearest contour; infinite where there is none.
cv::Mat distance_to(std::span<const std::uint8_t> is_contour, int width, int height) {
  cv::Mat empty(height, width, CV_8U);
  std::transform(is_contour.begin(), is_contour.end(), empty.begin<std::uint8_t>(),
                 [](std::uint8_t contour) { return static_cast<std::uint8_t>(contour != 0 ? 0 : 1); });
  cv::Mat distance(height, width, CV_32F, cv::Scalar(std::numeric_limits<float>::infinity()));
  if (std::ranges::any_of(is_contour, [](std::uint8_t contour) { return contour != 0; })) {
    cv::distanceTransform(empty, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  }
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

ShadowContours find_contours(const ShadowPicture& picture, int width, int height,
                             const ContourOptions& options) {
  check(options);
  check_size(picture.luminance.size(), width, height);
  check_size(picture.unshadowed.size(), width, height);
  check_size(picture.facing.size(), width, height);
  const std::vector<float> v = variation(picture.luminance, width, height);
  ShadowContours result;
  result.is_lit.resize(v.size());
  result.is_contour.assign(v.size(), 0);
  for (std::size_t k = 0; k < v.size(); ++k) result.is_lit[k] = litness(picture, k) > 0.5 ? 1 : 0;
  std::vector<std::uint8_t> is_border(v.size(), 0);
  for_texels(width, height, [&](int x, int y, std::size_t at) {
    for_neighbours(x, y, width, height, [&](std::size_t neighbour) {
      if (result.is_lit[neighbour] != result.is_lit[at]) is_border[at] = 1;
    });
  });
  const Averages average = average_variation(v, result.is_lit, is_border);
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (is_border[k] == 0) continue;
    const double likelihood = std::max(static_cast<double>(picture.facing[k]), 0.0);
    const double usual = std::lerp(average.shadowed, average.lit, litness(picture, k));
    if (likelihood * v[k] > options.threshold * usual) result.is_contour[k] = 1;
  }
  return result;
}

std::vector<float> contour_weights(const ShadowContours& reference, const ShadowContours& render, int width,
                                   int height, const ContourOptions& options) {
  check(options);
  for (const auto* size : {&reference.is_lit, &reference.is_contour, &render.is_lit, &render.is_contour}) {
    check_size(size->size(), width, height);
  }
  const cv::Mat to_reference = distance_to(reference.is_contour, width, height);
  const cv::Mat to_render = distance_to(render.is_contour, width, height);
  std::vector<float> weights(reference.is_lit.size(), 1.0F);
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
