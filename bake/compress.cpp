// Solving for and dropping lobes of one texel.
#include "bake/compress.h"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <vector>

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

// A texel's best amplitudes with ever fewer lobes. Leaving a lobe out is a step of Gauss and Jordan's
// elimination on the inverse, so none is taken twice.
class Elimination {
 public:
  explicit Elimination(const TexelEquations& equations) {
    const Eigen::Index count = equations.b.size();
    const TexelEquations all = restricted(equations, lobes_of(all_lobes(count), count));
    const auto factor = all.a.llt();
    best_ = factor.solve(all.b);
    inverse_ = factor.solve(LobeMatrix::Identity(count, count));
  }

  // What the lobe's going would add to the error: a_k^2 / (A^-1)_kk.
  double loss(Eigen::Index lobe) const { return best_[lobe] * best_[lobe] / inverse_(lobe, lobe); }

  void drop(Eigen::Index lobe) {
    const LobeVector column = inverse_.col(lobe) / inverse_(lobe, lobe);
    best_ -= column * best_[lobe];
    inverse_ -= column * inverse_.row(lobe);
  }

 private:
  LobeVector best_;
  LobeMatrix inverse_;
};

}  // namespace

std::uint32_t dominant_mask(std::span<const TexelEquations> channels, int count) {
  if (count < 0) throw std::invalid_argument("dominant_mask: a negative number of lobes");
  if (channels.empty()) throw std::invalid_argument("dominant_mask: no equations");
  const Eigen::Index lobes = channels[0].b.size();
  std::uint32_t mask = all_lobes(lobes);
  if (count >= lobes) return mask;
  std::vector<Elimination> eliminations(channels.begin(), channels.end());
  for (Eigen::Index kept = lobes; kept > count; --kept) {
    Eigen::Index least = -1;
    double least_loss = 0.0;
    for (Eigen::Index lobe = 0; lobe < lobes; ++lobe) {
      if ((mask >> lobe & 1U) == 0) continue;
      double loss = 0.0;
      for (const Elimination& channel : eliminations) loss += channel.loss(lobe);
      if (least >= 0 && !(loss < least_loss)) continue;
      least = lobe;
      least_loss = loss;
    }
    for (Elimination& channel : eliminations) channel.drop(least);
    mask &= ~(1U << static_cast<unsigned>(least));
  }
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
