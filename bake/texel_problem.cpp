// Residuals and modulations of blocks.
#include "bake/texel_problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

void check(const StackInfo& info, const TexelBlock& block, const BlockRender& render) {
  const std::size_t planes = block.lights * block.count();
  const bool fits = info.lights.size() == block.lights && block.rgb.size() == 3 * planes &&
                    render.rgb.size() == 3 * planes && render.shade.size() == planes &&
                    (block.weight.empty() || block.weight.size() == planes) &&
                    (render.albedo.empty() || render.albedo.size() == 3 * block.count());
  if (!fits) throw std::invalid_argument("TexelProblem: sizes of block and render disagree");
}

// What differs between the problems of a block: the mix of channels.
TexelProblem problem_of(const StackInfo& info, const TexelBlock& block, const BlockRender& render,
                        const Rgb& mix) {
  check(info, block, render);
  const std::size_t texels = block.count();
  TexelProblem problem;
  problem.lights = block.lights;
  problem.texels = texels;
  problem.residual.resize(block.lights * texels);
  problem.modulation.resize(block.lights * texels);
  problem.weight = block.weight;
  for (std::size_t l = 0; l < block.lights; ++l) {
    for (std::size_t i = 0; i < texels; ++i) {
      double residual = 0.0;
      double colour = 0.0;
      for (std::size_t c = 0; c < 3; ++c) {
        if (mix[c] == 0.0) continue;
        const std::size_t at = (l * 3 + c) * texels + i;
        const double albedo = render.albedo.empty() ? 1.0 : render.albedo[c * texels + i];
        residual += mix[c] * (static_cast<double>(block.rgb[at]) - render.rgb[at]);
        colour += mix[c] * info.lights[l].intensity[c] * albedo;
      }
      const std::size_t at = problem.at(l, i);
      const auto value = static_cast<float>(residual);
      const auto modulation = static_cast<float>(colour * render.shade[at]);
      if (std::isfinite(value) && std::isfinite(modulation)) {
        problem.residual[at] = value;
        problem.modulation[at] = std::max(modulation, 0.0F);
      } else {
        if (problem.weight.empty()) problem.weight.assign(block.lights * texels, 1.0F);
        problem.weight[at] = 0.0F;
      }
    }
  }
  if (!has_near_lights(info)) return problem;
  problem.directions.resize(block.lights * 3 * texels);
  for (std::size_t l = 0; l < block.lights; ++l) {
    float* plane = problem.directions.data() + l * 3 * texels;
    for (std::size_t i = 0; i < texels; ++i) {
      const Vec3 d = incidence(info, l, block.texels[i]).direction;
      plane[i] = static_cast<float>(d.x);
      plane[texels + i] = static_cast<float>(d.y);
      plane[2 * texels + i] = static_cast<float>(d.z);
    }
  }
  return problem;
}

// Chosen columns, and of them chosen rows, of planes.
std::vector<float> chosen(const std::vector<float>& planes, std::size_t columns,
                          std::span<const std::size_t> rows_chosen,
                          std::span<const std::size_t> columns_chosen) {
  std::vector<float> out;
  if (planes.empty()) return out;
  out.reserve(rows_chosen.size() * columns_chosen.size());
  for (const std::size_t row : rows_chosen) {
    for (const std::size_t column : columns_chosen) out.push_back(planes[row * columns + column]);
  }
  return out;
}

std::vector<std::size_t> counted(std::size_t count) {
  std::vector<std::size_t> all(count);
  for (std::size_t k = 0; k < count; ++k) all[k] = k;
  return all;
}

TexelProblem chosen_part(const TexelProblem& problem, std::span<const std::size_t> lights,
                         std::span<const std::size_t> texels) {
  TexelProblem part;
  part.lights = lights.size();
  part.texels = texels.size();
  part.residual = chosen(problem.residual, problem.texels, lights, texels);
  part.modulation = chosen(problem.modulation, problem.texels, lights, texels);
  part.weight = chosen(problem.weight, problem.texels, lights, texels);
  std::vector<std::size_t> rows;
  for (const std::size_t l : lights) rows.insert(rows.end(), {3 * l, 3 * l + 1, 3 * l + 2});
  part.directions = chosen(problem.directions, problem.texels, rows, texels);
  return part;
}

}  // namespace

Vec3 TexelProblem::direction(std::size_t light, std::size_t texel, const Vec3& common) const {
  if (directions.empty()) return common;
  const float* plane = directions.data() + light * 3 * texels + texel;
  return {plane[0], plane[texels], plane[2 * texels]};
}

TexelProblem luminance_problem(const StackInfo& info, const TexelBlock& block, const BlockRender& render) {
  return problem_of(info, block, render, kLuminance);
}

std::array<TexelProblem, 3> rgb_problems(const StackInfo& info, const TexelBlock& block,
                                         const BlockRender& render) {
  return {problem_of(info, block, render, {1.0, 0.0, 0.0}), problem_of(info, block, render, {0.0, 1.0, 0.0}),
          problem_of(info, block, render, {0.0, 0.0, 1.0})};
}

std::vector<float> chroma_scales(std::span<const TexelProblem, 3> channels, std::span<const float> sums) {
  const std::size_t texels = channels[0].texels;
  if (sums.size() != channels[0].lights * texels) {
    throw std::invalid_argument("chroma_scales: sums do not fit the problem");
  }
  std::vector<float> scales(3 * texels, 1.0F);
  for (std::size_t c = 0; c < 3; ++c) {
    const TexelProblem& channel = channels[c];
    for (std::size_t i = 0; i < texels; ++i) {
      double product = 0.0;
      double square = 0.0;
      for (std::size_t l = 0; l < channel.lights; ++l) {
        const std::size_t at = channel.at(l, i);
        const double correction = static_cast<double>(channel.modulation[at]) * sums[at];
        product += channel.weight_of(l, i) * correction * channel.residual[at];
        square += channel.weight_of(l, i) * correction * correction;
      }
      const auto scale = static_cast<float>(product / square);
      if (square > 0.0 && std::isfinite(scale)) scales[c * texels + i] = scale;
    }
  }
  return scales;
}

TexelProblem with_lights(const TexelProblem& problem, std::span<const std::size_t> lights) {
  return chosen_part(problem, lights, counted(problem.texels));
}

TexelProblem with_texels(const TexelProblem& problem, std::span<const std::size_t> texels) {
  return chosen_part(problem, counted(problem.lights), texels);
}

std::vector<double> mean_squared_modulation(const TexelProblem& problem) {
  std::vector<double> means(problem.lights, 0.0);
  for (std::size_t l = 0; l < problem.lights; ++l) {
    for (std::size_t i = 0; i < problem.texels; ++i) {
      const double m = problem.modulation[problem.at(l, i)];
      means[l] += problem.weight_of(l, i) * m * m;
    }
    if (problem.texels > 0) means[l] /= static_cast<double>(problem.texels);
  }
  return means;
}

}  // namespace brdfit::bake
