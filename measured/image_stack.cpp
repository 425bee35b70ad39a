// Incidence of near lights; the stack in memory.
#include "measured/image_stack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace brdfit {
namespace {

Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

double squared_length(const Vec3& v) {
  return v.x * v.x + v.y * v.y + v.z * v.z;
}

// Centre of a pixel; coordinates may lie between pixels.
Vec3 point_of(const ImagePlane& plane, double x, double y) {
  return {plane.origin.x + x * plane.pixel_size, plane.origin.y - y * plane.pixel_size, plane.origin.z};
}

// Moves chosen columns of a matrix of `rows` rows.
std::vector<float> chosen_columns(const std::vector<float>& values, std::size_t columns,
                                  std::span<const std::uint32_t> chosen) {
  if (values.empty()) return {};
  const std::size_t rows = values.size() / columns;
  std::vector<float> out(rows * chosen.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      out[row * chosen.size() + k] = values[row * columns + chosen[k]];
    }
  }
  return out;
}

}  // namespace

Incidence incidence(const StackInfo& info, std::size_t light, std::uint32_t texel) {
  const StackLight& source = info.lights[light];
  if (!source.position) return {source.direction, 1.0};
  const auto width = static_cast<std::uint32_t>(info.width);
  const Vec3 centre = point_of(info.plane, 0.5 * (info.width - 1), 0.5 * (info.height - 1));
  const Vec3 here = point_of(info.plane, texel % width, texel / width);
  const Vec3 towards = minus(*source.position, here);
  const double squared = squared_length(towards);
  const double length = std::sqrt(squared);
  return {{towards.x / length, towards.y / length, towards.z / length},
          squared_length(minus(*source.position, centre)) / squared};
}

std::vector<Vec3> directions_of(const StackInfo& info) {
  std::vector<Vec3> directions;
  for (const StackLight& light : info.lights) directions.push_back(light.direction);
  return directions;
}

bool has_near_lights(const StackInfo& info) {
  return std::any_of(info.lights.begin(), info.lights.end(),
                     [](const StackLight& light) { return light.position.has_value(); });
}

TexelBlock ImageStack::read_luminance(int first_row, int rows) {
  TexelBlock block = read_rows(first_row, rows);
  std::vector<float> luminance(block.lights * block.count());
  for (std::size_t light = 0; light < block.lights; ++light) {
    const auto red = block.plane(light, 0), green = block.plane(light, 1), blue = block.plane(light, 2);
    for (std::size_t k = 0; k < block.count(); ++k) {
      luminance[light * block.count() + k] = 0.2126F * red[k] + 0.7152F * green[k] + 0.0722F * blue[k];
    }
  }
  block.rgb = std::move(luminance);
  block.channels = 1;
  return block;
}

MemoryStack::MemoryStack(StackInfo info, TexelBlock block)
    : info_(std::move(info)), block_(std::move(block)) {
  const std::size_t texels = info_.texel_count();
  const std::size_t lights = info_.lights.size();
  const bool fits = block_.count() == texels && block_.lights == lights && block_.channels == 3 &&
                    block_.rgb.size() == lights * 3 * texels &&
                    (block_.weight.empty() || block_.weight.size() == lights * texels) &&
                    block_.normals.size() == (info_.has_normals ? 3 * texels : 0) &&
                    block_.albedo.size() == (info_.has_albedo ? 3 * texels : 0);
  if (!fits) throw std::invalid_argument("MemoryStack: sizes disagree");
  for (std::size_t k = 0; k < texels; ++k) {
    if (block_.texels[k] != k) throw std::invalid_argument("MemoryStack: texels are not in order");
  }
}

TexelBlock MemoryStack::read_rows(int first_row, int rows) {
  if (first_row < 0 || rows < 0 || first_row + rows > info_.height) {
    throw std::invalid_argument("MemoryStack: rows outside the picture");
  }
  const auto width = static_cast<std::size_t>(info_.width);
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(rows) * width);
  std::iota(texels.begin(), texels.end(),
            static_cast<std::uint32_t>(static_cast<std::size_t>(first_row) * width));
  return read_texels(texels);
}

TexelBlock MemoryStack::read_texels(std::span<const std::uint32_t> texels) {
  if (std::any_of(texels.begin(), texels.end(), [this](std::uint32_t k) { return k >= block_.count(); })) {
    throw std::invalid_argument("MemoryStack: texel outside the picture");
  }
  TexelBlock out;
  out.texels.assign(texels.begin(), texels.end());
  out.lights = block_.lights;
  out.rgb = chosen_columns(block_.rgb, block_.count(), texels);
  out.weight = chosen_columns(block_.weight, block_.count(), texels);
  out.normals = chosen_columns(block_.normals, block_.count(), texels);
  out.albedo = chosen_columns(block_.albedo, block_.count(), texels);
  return out;
}

}  // namespace brdfit
