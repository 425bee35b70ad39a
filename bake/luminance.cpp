// Choices of texels, errors of renders.
#include "bake/luminance.h"

#include <cmath>

namespace brdfit::bake {
namespace {

std::vector<float> chosen_columns(const std::vector<float>& values, std::size_t columns,
                                  std::span<const std::uint32_t> places) {
  if (values.empty()) return {};
  const std::size_t rows = values.size() / columns;
  std::vector<float> out;
  out.reserve(rows * places.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (const std::uint32_t place : places) out.push_back(values[row * columns + place]);
  }
  return out;
}

}  // namespace

TexelBlock chosen_texels(const TexelBlock& block, std::span<const std::uint32_t> places) {
  TexelBlock out;
  out.lights = block.lights;
  for (const std::uint32_t place : places) out.texels.push_back(block.texels[place]);
  out.rgb = chosen_columns(block.rgb, block.count(), places);
  out.weight = chosen_columns(block.weight, block.count(), places);
  out.normals = chosen_columns(block.normals, block.count(), places);
  out.albedo = chosen_columns(block.albedo, block.count(), places);
  return out;
}

TexelBlock thinned(const TexelBlock& block, std::size_t at_most) {
  if (block.count() <= at_most) return block;
  std::vector<std::uint32_t> places;
  for (std::size_t k = 0; k < at_most; ++k) {
    places.push_back(static_cast<std::uint32_t>(k * block.count() / at_most));
  }
  return chosen_texels(block, places);
}

Surface chosen_texels(const Surface& surface, std::span<const std::uint32_t> places) {
  Surface out;
  out.normals = chosen_columns(surface.normals, surface.count(), places);
  out.albedo = chosen_columns(surface.albedo, surface.count(), places);
  for (const std::uint32_t place : places) out.state.push_back(surface.state[place]);
  return out;
}

double luminance_rmse(const TexelBlock& block, std::span<const float> render, const LightChoice& lights) {
  double squares = 0.0;
  double weights = 0.0;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    for (std::size_t t = 0; t < block.count(); ++t) {
      const double weight = block.weight_of(lights[k], t);
      if (weight <= 0.0) continue;
      double difference = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        difference +=
            kLuminance[c] * (block.plane(lights[k], c)[t] - render[(3 * k + c) * block.count() + t]);
      }
      squares += weight * difference * difference;
      weights += weight;
    }
  }
  return weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
}

}  // namespace brdfit::bake
