// A light from anywhere on baked texels.
#include "bake/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "bake/base_model.h"
#include "brdf/kernel/realis.h"

namespace brdfit::bake {
namespace {

double at(std::span<const float> planes, std::size_t plane, std::size_t count, std::size_t texel) {
  return static_cast<double>(planes[plane * count + texel]);
}

// A stack of this one light, so that the base model is rendered by the code that baked.
StackInfo stack_of(const RealisAsset& asset, const RealisLight& light) {
  StackInfo info;
  info.name = asset.name;
  info.width = asset.width;
  info.height = asset.height;
  info.view = asset.view;
  info.lights = {{"", light.direction, {}, light.intensity}};
  return info;
}

double fade_of(const RealisFade& fade, const Surface& now, const Surface& then, std::size_t texel) {
  const std::size_t count = now.count();
  double distance_squared = 0.0;
  double cos_normals = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    distance_squared += std::pow(at(now.albedo, c, count, texel) - at(then.albedo, c, count, texel), 2);
    cos_normals += at(now.normals, c, count, texel) * at(then.normals, c, count, texel);
  }
  return kernel::realis_fade(std::sqrt(distance_squared), cos_normals, fade.albedo_range,
                             std::cos(fade.normal_range_deg * std::numbers::pi / 180.0));
}

void check(const RealisAsset& asset, const RunTimeTexels& texels) {
  const std::size_t count = texels.surface.count();
  const std::size_t chroma = asset.colour == RealisColour::kScaledChroma ? 3 * count : 0;
  const bool fits = texels.baked.count() == count && texels.surface.normals.size() == 3 * count &&
                    texels.surface.albedo.size() == 3 * count && texels.baked.normals.size() == 3 * count &&
                    texels.baked.albedo.size() == 3 * count && texels.chroma.size() == chroma &&
                    texels.amplitudes.size() == asset.plane_count() * count;
  if (!fits) throw std::invalid_argument("relight: sizes disagree");
}

}  // namespace

std::vector<double> correction(const RealisAsset& asset, const RunTimeTexels& texels,
                               const RealisLight& light) {
  check(asset, texels);
  const std::size_t count = texels.surface.count();
  const bool is_rgb = asset.colour == RealisColour::kRgb;
  std::vector<double> values;
  for (const Lobe& lobe : asset.lobes) values.push_back(eval(lobe, light.direction));
  std::vector<double> out(3 * count, 0.0);
  for (std::size_t texel = 0; texel < count; ++texel) {
    const double cos_i = light.direction.x * at(texels.surface.normals, 0, count, texel) +
                         light.direction.y * at(texels.surface.normals, 1, count, texel) +
                         light.direction.z * at(texels.surface.normals, 2, count, texel);
    if (!(cos_i > 0.0)) continue;
    const double shade = cos_i * fade_of(asset.fade, texels.surface, texels.baked, texel);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t lobe = 0; lobe < values.size(); ++lobe) {
        sum += at(texels.amplitudes, is_rgb ? lobe * 3 + c : lobe, count, texel) * values[lobe];
      }
      if (!texels.chroma.empty()) sum *= at(texels.chroma, c, count, texel);
      const double albedo = asset.albedo_in_modulation ? at(texels.surface.albedo, c, count, texel) : 1.0;
      out[c * count + texel] = light.intensity[c] * albedo * shade * sum;
    }
  }
  return out;
}

Relit relight(const RealisAsset& asset, const RunTimeTexels& texels, const RealisLight& light) {
  const std::vector<double> added = correction(asset, texels, light);
  const std::size_t count = texels.surface.count();
  const StackInfo info = stack_of(asset, light);
  TexelBlock block;
  block.texels.resize(count);
  std::iota(block.texels.begin(), block.texels.end(), 0U);
  block.lights = 1;
  block.rgb.assign(3 * count, 0.0F);
  BaseModel base;
  base.material = asset.base;
  Relit out;
  out.render = render_block(info, block, texels.surface, all_lights(info), base);
  out.corrected = out.render;
  for (std::size_t k = 0; k < added.size(); ++k) out.corrected[k] += static_cast<float>(added[k]);
  return out;
}

}  // namespace brdfit::bake
