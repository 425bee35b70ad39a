// Blocks cut into chunks: lights per texel, padding, moving to and fro.
#include "bake/chunk.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace brdfit::bake {

LightChoice all_lights(const StackInfo& info) {
  LightChoice lights(info.lights.size());
  std::iota(lights.begin(), lights.end(), 0U);
  return lights;
}

LightChoice without(const StackInfo& info, std::span<const std::uint32_t> held_out) {
  LightChoice lights = all_lights(info);
  std::erase_if(lights,
                [&](std::uint32_t light) { return std::ranges::find(held_out, light) != held_out.end(); });
  return lights;
}

template <class S>
ChunkLightsOf<S>::ChunkLightsOf(const StackInfo& info, std::span<const std::uint32_t> lights)
    : info_(info), lights_(lights.begin(), lights.end()), near_(has_near_lights(info)) {
  for (const std::uint32_t light : lights_) {
    const StackLight& source = info.lights[light];
    for (const double part : {source.direction.x, source.direction.y, source.direction.z}) {
      direction_.push_back(static_cast<S>(part));
    }
    falloff_.push_back(S(1));
    for (const double channel : source.intensity) intensity_.push_back(static_cast<S>(channel));
  }
}

template <class S>
LightColumnsOf<S> ChunkLightsOf<S>::columns(std::span<const std::uint32_t> texels,
                                            std::vector<S>& at_texels) const {
  if (!near_) return {lights_.size(), 1, direction_.data(), falloff_.data(), intensity_.data()};
  at_texels.resize(lights_.size() * 4 * kChunk);
  S* direction = at_texels.data();
  S* falloff = direction + lights_.size() * 3 * kChunk;
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    for (std::size_t t = 0; t < kChunk; ++t) {
      const Incidence at = incidence(info_, lights_[k], texels[std::min(t, texels.size() - 1)]);
      direction[(k * 3 + 0) * kChunk + t] = static_cast<S>(at.direction.x);
      direction[(k * 3 + 1) * kChunk + t] = static_cast<S>(at.direction.y);
      direction[(k * 3 + 2) * kChunk + t] = static_cast<S>(at.direction.z);
      falloff[k * kChunk + t] = static_cast<S>(at.falloff);
    }
  }
  return {lights_.size(), kChunk, direction, falloff, intensity_.data()};
}

template class ChunkLightsOf<float>;
template class ChunkLightsOf<double>;

ValueColumns chunk_values(const TexelBlock& block, std::span<const std::uint32_t> lights, std::size_t first,
                          std::vector<float>& padded) {
  const std::size_t count = block.count();
  ValueColumns columns;
  columns.light = lights.data();
  if (first + kChunk <= count) {
    columns.value = block.rgb.data() + first;
    columns.light_stride = 3 * count;
    columns.channel_stride = count;
    if (!block.weight.empty()) columns.weight = block.weight.data() + first;
    columns.weight_stride = count;
    return columns;
  }
  const std::size_t rest = count - first;
  padded.assign(block.lights * 4 * kChunk, 0.0F);
  float* weight = padded.data() + block.lights * 3 * kChunk;
  for (std::size_t row = 0; row < block.lights * 3; ++row) {
    std::copy_n(block.rgb.data() + row * count + first, rest, padded.data() + row * kChunk);
  }
  for (std::size_t light = 0; light < block.lights; ++light) {
    for (std::size_t t = 0; t < rest; ++t) weight[light * kChunk + t] = block.weight_of(light, first + t);
  }
  columns.value = padded.data();
  columns.light_stride = 3 * kChunk;
  columns.channel_stride = kChunk;
  columns.weight = weight;
  columns.weight_stride = kChunk;
  return columns;
}

template <class S>
void copy_chunk(std::span<const float> matrix, std::size_t columns, std::size_t first, S* to) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t t = 0; t < kChunk; ++t) {
      to[row * kChunk + t] = matrix[row * columns + std::min(first + t, columns - 1)];
    }
  }
}

template void copy_chunk(std::span<const float>, std::size_t, std::size_t, float*);
template void copy_chunk(std::span<const float>, std::size_t, std::size_t, double*);

void store_chunk(const float* from, std::size_t rows, std::size_t columns, std::size_t first,
                 std::span<float> matrix) {
  const std::size_t length = std::min(kChunk, columns - first);
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(from + row * kChunk, length,
                matrix.begin() + static_cast<std::ptrdiff_t>(row * columns + first));
  }
}

}  // namespace brdfit::bake
