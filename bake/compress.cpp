// Dropping lobes and rounding amplitudes of one texel.
#include "bake/compress.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "brdf/kernel/realis.h"

namespace brdfit::bake {
namespace {

// Below this part of the largest diagonal entry a direction holds no information.
constexpr double kRankTolerance = 1e-12;

std::vector<int> lobes_of(std::uint32_t mask, Eigen::Index count) {
  std::vector<int> lobes;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    if ((mask >> k & 1U) != 0) lobes.push_back(k);
  }
  return lobes;
}

std::uint32_t all_lobes(Eigen::Index count) {
  return count == 32 ? ~0U : (1U << static_cast<unsigned>(count)) - 1U;
}

// The equations of some lobes, with just enough added to the diagonal that empty directions stay at 0.
TexelEquations restricted(const TexelEquations& equations, const std::vector<int>& lobes) {
  const auto count = static_cast<Eigen::Index>(lobes.size());
  TexelEquations out{LobeMatrix(count, count), LobeVector(count)};
  for (Eigen::Index r = 0; r < count; ++r) {
    out.b[r] = equations.b[lobes[static_cast<std::size_t>(r)]];
    for (Eigen::Index c = 0; c < count; ++c) {
      out.a(r, c) = equations.a(lobes[static_cast<std::size_t>(r)], lobes[static_cast<std::size_t>(c)]);
    }
  }
  const double largest = count > 0 ? out.a.diagonal().maxCoeff() : 0.0;
  out.a.diagonal().array() += largest > 0.0 ? kRankTolerance * largest : 1.0;
  return out;
}

}  // namespace

LobeVector solve(const TexelEquations& equations) {
  const std::vector<int> lobes = lobes_of(all_lobes(equations.b.size()), equations.b.size());
  const TexelEquations all = restricted(equations, lobes);
  return all.a.llt().solve(all.b);
}

Dominant dominant_lobes(const TexelEquations& equations, int count) {
  if (count < 0) throw std::invalid_argument("dominant_lobes: a negative number of lobes");
  std::vector<int> kept = lobes_of(all_lobes(equations.b.size()), equations.b.size());
  Dominant out{LobeVector::Zero(equations.b.size()), 0};
  while (true) {
    const TexelEquations part = restricted(equations, kept);
    const auto size = static_cast<Eigen::Index>(kept.size());
    const auto factor = part.a.llt();
    const LobeVector amplitudes = factor.solve(part.b);
    if (static_cast<int>(kept.size()) <= count) {
      for (Eigen::Index k = 0; k < size; ++k)
        out.amplitudes[kept[static_cast<std::size_t>(k)]] = amplitudes[k];
      break;
    }
    // Without lobe k the error rises by a_k^2 / (A^-1)_kk.
    const LobeMatrix inverse = factor.solve(LobeMatrix::Identity(size, size));
    Eigen::Index least = 0;
    (amplitudes.array().square() / inverse.diagonal().array()).minCoeff(&least);
    kept.erase(kept.begin() + least);
  }
  for (const int lobe : kept) out.mask |= 1U << static_cast<unsigned>(lobe);
  return out;
}

double Quantiser::amplitude(int lobe, int code) const {
  return kernel::realis_amplitude(static_cast<double>(code), static_cast<double>(largest_code()),
                                  precision[static_cast<std::size_t>(lobe)]);
}

std::vector<double> precision_per_lobe(std::span<const float> amplitudes, std::size_t lobes,
                                       double quantile) {
  if (lobes == 0 || amplitudes.size() % lobes != 0)
    throw std::invalid_argument("precision_per_lobe: sizes disagree");
  if (!(quantile > 0.0 && quantile <= 1.0))
    throw std::invalid_argument("precision_per_lobe: quantile outside (0, 1]");
  const std::size_t texels = amplitudes.size() / lobes;
  std::vector<std::uint8_t> used(texels, 0);
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    if (amplitudes[k] != 0.0F) used[k % texels] = 1;
  }
  std::vector<double> precision(lobes, 0.0);
  std::vector<float> sizes;
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    sizes.clear();
    for (std::size_t texel = 0; texel < texels; ++texel) {
      if (used[texel] != 0) sizes.push_back(std::abs(amplitudes[lobe * texels + texel]));
    }
    if (sizes.empty()) continue;
    const auto rank =
        static_cast<std::ptrdiff_t>(std::ceil(quantile * static_cast<double>(sizes.size()))) - 1;
    std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
    precision[lobe] = static_cast<double>(sizes[static_cast<std::size_t>(rank)]);
  }
  return precision;
}

std::vector<int> quantise(const TexelEquations& equations, const Quantiser& quantiser, std::uint32_t mask,
                          std::span<const double> dither) {
  std::vector<int> codes(static_cast<std::size_t>(equations.b.size()), 0);
  std::vector<int> kept;
  for (const int lobe : lobes_of(mask, equations.b.size())) {
    if (quantiser.precision[static_cast<std::size_t>(lobe)] > 0.0) kept.push_back(lobe);
  }
  const TexelEquations part = restricted(equations, kept);
  const auto factor = part.a.llt();
  const LobeVector best = factor.solve(part.b);
  const LobeMatrix upper = factor.matrixU();
  LobeVector moved = LobeVector::Zero(best.size());  // what rounding has added so far
  for (Eigen::Index k = best.size() - 1; k >= 0; --k) {
    const int lobe = kept[static_cast<std::size_t>(k)];
    double target = best[k];
    for (Eigen::Index j = k + 1; j < best.size(); ++j) target -= upper(k, j) / upper(k, k) * moved[j];
    const double shift = dither.empty() ? 0.0 : dither[static_cast<std::size_t>(lobe)];
    const double steps =
        target / quantiser.precision[static_cast<std::size_t>(lobe)] * quantiser.largest_code();
    const double largest = quantiser.largest_code();
    const double code = std::clamp(std::floor(steps + 0.5 + shift), -largest, largest);
    codes[static_cast<std::size_t>(lobe)] = static_cast<int>(code);
    moved[k] = quantiser.amplitude(lobe, static_cast<int>(code)) - best[k];
  }
  return codes;
}

double dither_threshold(std::uint32_t x, std::uint32_t y, int lobe) {
  const double shifted = static_cast<double>(x) + 5.588238 * lobe;
  const double inner = 0.06711056 * shifted + 0.00583715 * static_cast<double>(y);
  const double noise = 52.9829189 * (inner - std::floor(inner));
  return noise - std::floor(noise) - 0.5;
}

}  // namespace brdfit::bake
