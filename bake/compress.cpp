// Solving for and dropping lobes of one texel.
#include "bake/compress.h"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace brdfit::bake {
namespace {

// Below this part of the largest diagonal entry a direction holds no information.
constexpr double kRankTolerance = 1e-12;

std::uint32_t all_lobes(Eigen::Index count) {
  return count == 32 ? ~0U : (1U << static_cast<unsigned>(count)) - 1U;
}

}  // namespace

std::vector<int> lobes_of(std::uint32_t mask, Eigen::Index count) {
  std::vector<int> lobes;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    if ((mask >> k & 1U) != 0) lobes.push_back(k);
  }
  return lobes;
}

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

LobeVector solve(const TexelEquations& equations) {
  const std::vector<int> lobes = lobes_of(all_lobes(equations.b.size()), equations.b.size());
  const TexelEquations all = restricted(equations, lobes);
  return all.a.llt().solve(all.b);
}

namespace {

// Adds to `losses` what each lobe's going would add to the error: a_k^2 / (A^-1)_kk.
void add_losses(const TexelEquations& equations, const std::vector<int>& kept, LobeVector& losses) {
  const TexelEquations part = restricted(equations, kept);
  const auto size = static_cast<Eigen::Index>(kept.size());
  const auto factor = part.a.llt();
  const LobeVector amplitudes = factor.solve(part.b);
  const LobeMatrix inverse = factor.solve(LobeMatrix::Identity(size, size));
  losses.array() += amplitudes.array().square() / inverse.diagonal().array();
}

}  // namespace

std::uint32_t dominant_mask(std::span<const TexelEquations> channels, int count) {
  if (count < 0) throw std::invalid_argument("dominant_mask: a negative number of lobes");
  if (channels.empty()) throw std::invalid_argument("dominant_mask: no equations");
  const Eigen::Index lobes = channels[0].b.size();
  std::vector<int> kept = lobes_of(all_lobes(lobes), lobes);
  while (static_cast<int>(kept.size()) > count) {
    LobeVector losses = LobeVector::Zero(static_cast<Eigen::Index>(kept.size()));
    for (const TexelEquations& equations : channels) add_losses(equations, kept, losses);
    Eigen::Index least = 0;
    losses.minCoeff(&least);
    kept.erase(kept.begin() + least);
  }
  std::uint32_t mask = 0;
  for (const int lobe : kept) mask |= 1U << static_cast<unsigned>(lobe);
  return mask;
}

LobeVector refit(const TexelEquations& equations, std::uint32_t mask) {
  LobeVector out = LobeVector::Zero(equations.b.size());
  const std::vector<int> kept = lobes_of(mask, equations.b.size());
  const TexelEquations part = restricted(equations, kept);
  const LobeVector amplitudes = part.a.llt().solve(part.b);
  for (std::size_t k = 0; k < kept.size(); ++k) out[kept[k]] = amplitudes[static_cast<Eigen::Index>(k)];
  return out;
}

}  // namespace brdfit::bake
