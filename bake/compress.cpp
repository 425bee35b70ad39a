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

}  // namespace brdfit::bake
