// Means over squares of texels, and the way back.
#include "bake/shrunk_stack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace brdfit::bake {
namespace {

int shrunk(int size, int shrink) {
  return (size + shrink - 1) / shrink;
}

// Which texels of a run of rows make which square.
class Squares {
 public:
  Squares(const StackInfo& info, const StackInfo& whole, int shrink, const TexelBlock& block, int rows)
      : count_(static_cast<std::size_t>(info.width) * static_cast<std::size_t>(rows)), of_(block.count()) {
    const auto width = static_cast<std::size_t>(whole.width);
    const auto side = static_cast<std::size_t>(shrink);
    for (std::size_t k = 0; k < of_.size(); ++k) {
      of_[k] = k / width / side * static_cast<std::size_t>(info.width) + k % width / side;
    }
  }

  std::size_t count() const { return count_; }

  std::vector<double> sums(std::span<const float> values, const float* weight) const {
    std::vector<double> sum(count_, 0.0);
    for (std::size_t k = 0; k < of_.size(); ++k) {
      sum[of_[k]] +=
          static_cast<double>(values[k]) * (weight == nullptr ? 1.0 : static_cast<double>(weight[k]));
    }
    return sum;
  }

  // Means of one plane; 0 where nothing has weight.
  void append_means(std::span<const float> values, const float* weight, std::vector<float>& to) const {
    const std::vector<double> total = sums(std::vector<float>(of_.size(), 1.0F), weight);
    const std::vector<double> sum = sums(values, weight);
    for (std::size_t s = 0; s < count_; ++s) {
      to.push_back(total[s] > 0.0 ? static_cast<float>(sum[s] / total[s]) : 0.0F);
    }
  }

 private:
  std::size_t count_;
  std::vector<std::size_t> of_;
};

std::span<const float> plane_of(const std::vector<float>& planes, std::size_t plane, std::size_t count) {
  return std::span(planes).subspan(plane * count, count);
}

// Unit again; those that cancel face the viewer.
void normalise(std::vector<float>& normals, const Vec3& view) {
  const std::size_t count = normals.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    float* const parts[3] = {&normals[k], &normals[count + k], &normals[2 * count + k]};
    const double length =
        std::sqrt(std::accumulate(std::begin(parts), std::end(parts), 0.0, [](double sum, const float* p) {
          return sum + static_cast<double>(*p) * static_cast<double>(*p);
        }));
    const double towards_view[3] = {view.x, view.y, view.z};
    for (std::size_t c = 0; c < 3; ++c) {
      *parts[c] =
          static_cast<float>(length > 1e-6 ? static_cast<double>(*parts[c]) / length : towards_view[c]);
    }
  }
}

}  // namespace

ShrunkStack::ShrunkStack(ImageStack& whole, int shrink, std::size_t memory_bytes)
    : whole_(whole), shrink_(shrink), memory_bytes_(memory_bytes), info_(whole.info()) {
  if (shrink < 1 || shrink > kMostShrink)
    throw std::invalid_argument("ShrunkStack: shrink is not in [1, 64]");
  info_.width = shrunk(whole.info().width, shrink);
  info_.height = shrunk(whole.info().height, shrink);
  // The centre of the first square, and from one to the next.
  const double half = 0.5 * (shrink - 1) * info_.plane.pixel_size;
  info_.plane.origin.x += half;
  info_.plane.origin.y -= half;
  info_.plane.pixel_size *= shrink;
}

TexelBlock ShrunkStack::strip(int first_row, int rows) {
  const int first = first_row * shrink_;
  TexelBlock block = whole_.read_rows(first, std::min(rows * shrink_, whole_.info().height - first));
  const Squares squares(info_, whole_.info(), shrink_, block, rows);
  const std::size_t count = block.count();
  TexelBlock out;
  out.lights = block.lights;
  out.channels = block.channels;
  out.texels.resize(squares.count());
  std::iota(out.texels.begin(), out.texels.end(),
            static_cast<std::uint32_t>(first_row) * static_cast<std::uint32_t>(info_.width));
  out.rgb.reserve(block.lights * block.channels * squares.count());
  out.weight.reserve(block.weight.empty() ? 0 : block.lights * squares.count());
  for (std::size_t light = 0; light < block.lights; ++light) {
    const float* weight = block.weight.empty() ? nullptr : block.weight.data() + light * count;
    for (std::size_t c = 0; c < block.channels; ++c)
      squares.append_means(block.plane(light, c), weight, out.rgb);
    if (weight != nullptr) squares.append_means(plane_of(block.weight, light, count), nullptr, out.weight);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (!block.normals.empty()) squares.append_means(plane_of(block.normals, c, count), nullptr, out.normals);
    if (!block.albedo.empty()) squares.append_means(plane_of(block.albedo, c, count), nullptr, out.albedo);
  }
  normalise(out.normals, info_.view);
  whole_.give_back(std::move(block));
  return out;
}

int ShrunkStack::strip_rows() const {
  // Of a row of squares: three channels and a weight of every texel in it.
  const std::size_t texels =
      static_cast<std::size_t>(info_.width) * static_cast<std::size_t>(shrink_ * shrink_);
  const std::size_t row_bytes = 4 * sizeof(float) * std::max<std::size_t>(info_.lights.size(), 1) * texels;
  return static_cast<int>(
      std::clamp<std::size_t>(memory_bytes_ / row_bytes, 1, static_cast<std::size_t>(info_.height)));
}

TexelBlock ShrunkStack::read_rows(int first_row, int rows) {
  if (rows <= strip_rows()) return strip(first_row, rows);
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(info_.width) * static_cast<std::size_t>(rows));
  std::iota(texels.begin(), texels.end(),
            static_cast<std::uint32_t>(first_row) * static_cast<std::uint32_t>(info_.width));
  return read_texels(texels);
}

TexelBlock ShrunkStack::read_texels(std::span<const std::uint32_t> texels) {
  const auto width = static_cast<std::size_t>(info_.width);
  TexelBlock out = std::exchange(given_back_, {});
  for (std::vector<float>* planes : {&out.rgb, &out.weight, &out.normals, &out.albedo}) planes->clear();
  out.texels.assign(texels.begin(), texels.end());
  const auto copy = [&](const std::vector<float>& from, std::size_t planes, std::vector<float>& to,
                        const TexelBlock& block, std::size_t begin, std::size_t end) {
    if (from.empty()) return;
    to.resize(planes * texels.size());
    for (std::size_t p = 0; p < planes; ++p) {
      for (std::size_t k = begin; k < end; ++k) {
        to[p * texels.size() + k] = from[p * block.count() + (texels[k] - block.texels.front())];
      }
    }
  };
  for (std::size_t begin = 0; begin < texels.size();) {
    const int first = static_cast<int>(texels[begin] / width);
    const int rows = std::min(strip_rows(), info_.height - first);
    const std::size_t beyond = static_cast<std::size_t>(first + rows) * width;
    const auto end = static_cast<std::size_t>(
        std::lower_bound(texels.begin(), texels.end(), beyond,
                         [](std::uint32_t texel, std::size_t limit) { return texel < limit; }) -
        texels.begin());
    const TexelBlock block = strip(first, rows);
    out.lights = block.lights;
    out.channels = block.channels;
    copy(block.rgb, block.lights * block.channels, out.rgb, block, begin, end);
    // Strips without weights count in full, whatever others have.
    if (!block.weight.empty() && out.weight.empty()) out.weight.assign(block.lights * texels.size(), 1.0F);
    copy(block.weight, block.lights, out.weight, block, begin, end);
    copy(block.normals, 3, out.normals, block, begin, end);
    copy(block.albedo, 3, out.albedo, block, begin, end);
    begin = end;
  }
  return out;
}

ShrunkPlace shrunk_place(const StackInfo& whole, int shrink, std::uint32_t texel) {
  const auto along = [shrink](std::uint32_t at, int size, std::uint32_t& lower, std::uint32_t& upper) {
    const double last = shrunk(size, shrink) - 1;
    const double place = std::clamp((at + 0.5) / shrink - 0.5, 0.0, last);
    lower = static_cast<std::uint32_t>(place);
    upper = static_cast<std::uint32_t>(std::min(std::floor(place) + 1.0, last));
    return place - lower;
  };
  const auto width = static_cast<std::uint32_t>(whole.width);
  std::uint32_t x[2];
  std::uint32_t y[2];
  const double right = along(texel % width, whole.width, x[0], x[1]);
  const double down = along(texel / width, whole.height, y[0], y[1]);
  const auto shrunk_width = static_cast<std::uint32_t>(shrunk(whole.width, shrink));
  ShrunkPlace place;
  for (std::size_t k = 0; k < 4; ++k) {
    place.texels[k] = y[k / 2] * shrunk_width + x[k % 2];
    place.shares[k] = (k % 2 == 0 ? 1.0 - right : right) * (k / 2 == 0 ? 1.0 - down : down);
  }
  return place;
}

std::vector<float> magnified(const StackInfo& whole, int shrink, std::span<const float> planes,
                             std::span<const std::uint32_t> shrunk_texels,
                             std::span<const std::uint32_t> texels) {
  const std::size_t columns = shrunk_texels.size();
  const std::size_t count = columns == 0 ? 0 : planes.size() / columns;
  std::vector<float> out(count * texels.size());
  for (std::size_t k = 0; k < texels.size(); ++k) {
    const ShrunkPlace place = shrunk_place(whole, shrink, texels[k]);
    std::array<std::size_t, 4> from{};
    for (std::size_t j = 0; j < 4; ++j) {
      const auto found = std::ranges::lower_bound(shrunk_texels, place.texels[j]);
      if (found == shrunk_texels.end() || *found != place.texels[j]) {
        throw std::invalid_argument("magnified: a shrunk texel is missing");
      }
      from[j] = static_cast<std::size_t>(found - shrunk_texels.begin());
    }
    for (std::size_t p = 0; p < count; ++p) {
      double sum = 0.0;
      for (std::size_t j = 0; j < 4; ++j)
        sum += place.shares[j] * static_cast<double>(planes[p * columns + from[j]]);
      out[p * texels.size() + k] = static_cast<float>(sum);
    }
  }
  return out;
}

}  // namespace brdfit::bake
