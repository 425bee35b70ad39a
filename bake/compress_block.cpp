// The same for the texels of a block, in parallel.
#include "bake/compress_block.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

#include "bake/dither.h"

namespace brdfit::bake {
namespace {

// Enough that ranges fitted to them cost others no more. With many bits it is the rare large amplitudes that
// decide, and a search takes no time; with few bits it is the bulk.
std::size_t most_range_texels(int bits) {
  return is_searched(bits) ? 512 : 4096;
}

bool has_amplitudes(std::span<const float> amplitudes, std::size_t texels, std::size_t texel) {
  for (std::size_t at = texel; at < amplitudes.size(); at += texels) {
    if (amplitudes[at] != 0.0F) return true;
  }
  return false;
}

std::uint32_t mask_of(const TexelEquations& equations, const CompressOptions& options,
                      std::span<const std::uint32_t> masks, std::size_t texel) {
  return masks.empty() ? dominant_mask(std::span(&equations, 1), options.dominant) : masks[texel];
}

}  // namespace

std::vector<std::uint32_t> dominant_masks(const LobeSystem& system, std::span<const TexelProblem> problems,
                                          std::span<const SolveResult> solved, int dominant) {
  const std::size_t count = problems.empty() ? 0 : problems[0].texels;
  std::vector<std::uint32_t> masks(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t texel) {
    std::vector<TexelEquations> channels;
    for (std::size_t p = 0; p < problems.size(); ++p) {
      if (has_amplitudes(solved[p].amplitudes, count, texel))
        channels.push_back(texel_equations(system, problems[p], texel));
    }
    if (!channels.empty()) masks[texel] = dominant_mask(channels, dominant);
  });
  return masks;
}

namespace {

// Sums over lights of products of lobes, below and on the diagonal by rows, and of lobes times residuals.
struct Sums {
  std::array<double, kMaxLobes*(kMaxLobes + 1) / 2> products{};
  LobeVector right;

  // products, values: of the light.
  void add(double squared, const double* light_products, double weighted, const double* values) {
    const auto lobes = static_cast<std::size_t>(right.size());
    for (std::size_t k = 0; k < lobes * (lobes + 1) / 2; ++k) products[k] += squared * light_products[k];
    for (std::size_t k = 0; k < lobes; ++k) right[static_cast<Eigen::Index>(k)] += weighted * values[k];
  }

  TexelEquations equations(double penalty) const {
    const Eigen::Index lobes = right.size();
    TexelEquations out{LobeMatrix(lobes, lobes), right};
    std::size_t entry = 0;
    for (Eigen::Index i = 0; i < lobes; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) out.a(i, j) = out.a(j, i) = products[entry++];
      out.a(i, i) += penalty;
    }
    return out;
  }
};

}  // namespace

TexelEquations texel_equations(const LobeSystem& system, const TexelProblem& problem, std::size_t texel) {
  const std::size_t lobes = system.lobes().size();
  Sums sums;
  sums.right = LobeVector::Zero(static_cast<Eigen::Index>(lobes));
  std::array<double, kMaxLobes> values{};
  std::array<double, kMaxLobes*(kMaxLobes + 1) / 2> products{};
  for (std::size_t light = 0; light < problem.lights; ++light) {
    const double modulation = static_cast<double>(problem.modulation[problem.at(light, texel)]);
    const double weight = static_cast<double>(problem.weight_of(light, texel)) * modulation;
    if (weight == 0.0) continue;
    const double residual = static_cast<double>(problem.residual[problem.at(light, texel)]);
    const auto column = static_cast<Eigen::Index>(light);
    const double* of_light = products.data();
    if (problem.directions.empty()) {
      of_light = &system.products()(0, column);
      for (std::size_t k = 0; k < lobes; ++k)
        values[k] = system.basis()(column, static_cast<Eigen::Index>(k));
    } else {
      const Vec3 direction = problem.direction(light, texel, system.directions()[light]);
      for (std::size_t k = 0, entry = 0; k < lobes; ++k) {
        values[k] = eval(system.lobes()[k], direction);
        for (std::size_t j = 0; j <= k; ++j) products[entry++] = values[k] * values[j];
      }
    }
    sums.add(weight * modulation, of_light, weight * residual, values.data());
  }
  return sums.equations(system.penalty());
}

std::vector<RealisRange> code_ranges(const LobeSystem& system, const TexelProblem& problem,
                                     std::span<const float> amplitudes, const CompressOptions& options,
                                     std::span<const std::uint32_t> masks) {
  const std::size_t lobes = system.lobes().size();
  if (amplitudes.size() != lobes * problem.texels) throw std::invalid_argument("code_ranges: sizes disagree");
  if (options.bits == 0) return std::vector<RealisRange>(lobes);
  std::vector<std::size_t> used;
  for (std::size_t texel = 0; texel < problem.texels; ++texel) {
    if (has_amplitudes(amplitudes, problem.texels, texel)) used.push_back(texel);
  }
  const std::size_t count = std::min(used.size(), most_range_texels(options.bits));
  std::vector<CodeSearch> texels(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    const std::size_t texel = used[(2 * k + 1) * used.size() / (2 * count)];
    const TexelEquations equations = texel_equations(system, problem, texel);
    texels[k] = CodeSearch(equations, mask_of(equations, options, masks, texel));
  });
  return fitted_ranges(texels, lobes, options.bits);
}

Compressed compress_block(const LobeSystem& system, const TexelProblem& problem,
                          std::span<const float> amplitudes, std::span<const std::uint32_t> texels, int width,
                          std::span<const RealisRange> ranges, const CompressOptions& options,
                          std::span<const std::uint32_t> masks) {
  const std::size_t lobes = system.lobes().size();
  const std::size_t count = problem.texels;
  if (amplitudes.size() != lobes * count || texels.size() != count || width <= 0 ||
      (options.bits > 0 && ranges.size() != lobes)) {
    throw std::invalid_argument("compress_block: sizes disagree");
  }
  const Quantiser quantiser{options.bits, {ranges.begin(), ranges.end()}};
  Compressed out;
  out.amplitudes.assign(lobes * count, 0.0F);
  if (options.bits > 0) out.codes.assign(lobes * count, 0);
  out.masks.assign(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t texel) {
    if (!has_amplitudes(amplitudes, count, texel)) return;
    const TexelEquations equations = texel_equations(system, problem, texel);
    const std::uint32_t mask = mask_of(equations, options, masks, texel);
    out.masks[texel] = mask;
    if (options.bits == 0) {
      const LobeVector refitted = refit(equations, mask);
      for (std::size_t k = 0; k < lobes; ++k)
        out.amplitudes[k * count + texel] = static_cast<float>(refitted[static_cast<Eigen::Index>(k)]);
      return;
    }
    std::array<double, kMaxLobes> dither{};
    const auto wide = static_cast<std::uint32_t>(width);
    for (std::size_t k = 0; k < lobes && options.dither; ++k) {
      dither[k] = dither_threshold(texels[texel] % wide, texels[texel] / wide, static_cast<int>(k));
    }
    const std::span<const double> noise(dither.data(), options.dither ? lobes : 0);
    const int steps = search_steps(options.bits, static_cast<std::size_t>(std::popcount(mask)));
    const std::vector<int> codes = quantise(equations, quantiser, mask, noise, steps);
    for (std::size_t k = 0; k < lobes; ++k) {
      out.codes[k * count + texel] = codes[k];
      out.amplitudes[k * count + texel] = static_cast<float>(quantiser.amplitude(k, codes[k]));
    }
  });
  return out;
}

}  // namespace brdfit::bake
