// What texels share, prepared for the vector code.
#include "bake/solve.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bake/solve_parallel.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void solve_texels(const bake::SolveJob&))

}  // namespace brdfit::simd

namespace brdfit::bake {
namespace {

// Eigenvalues below this share of the largest count as 0.
constexpr double kSingular = 1e-10;
// Texels that a task solves.
constexpr std::size_t kGrain = 512;

// The rotation Q for which M Q is an upper triangle: the QR decomposition of M with its rows turned over and
// transposed, turned back.
Eigen::MatrixXd turn_to_upper_triangle(const Eigen::MatrixXd& m) {
  const Eigen::MatrixXd turned = m.colwise().reverse().transpose();
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(turned).householderQ();
  return q.rowwise().reverse();
}

SolveFunction solve_function(simd::Isa isa) {
  using namespace simd;  // where the macro finds the instruction sets
  return BRDFIT_PICK(isa, solve_texels);
}

void check(const LobeSystem& system, const TexelProblem& problem) {
  const std::size_t size = problem.lights * problem.texels;
  const bool fits = system.directions().size() == problem.lights && problem.residual.size() == size &&
                    problem.modulation.size() == size &&
                    (problem.weight.empty() || problem.weight.size() == size) &&
                    (problem.directions.empty() || problem.directions.size() == 3 * size);
  if (!fits) throw std::invalid_argument("solve: the problem's sizes disagree");
}

}  // namespace

LobeSystem::LobeSystem(LobeSet lobes, std::span<const Vec3> directions,
                       std::span<const double> squared_modulation, double ridge)
    : lobes_(std::move(lobes)),
      directions_(directions.begin(), directions.end()),
      squared_modulation_(squared_modulation.begin(), squared_modulation.end()),
      basis_(lobe_values(lobes_, directions)),
      ridge_(ridge) {
  if (lobes_.empty() || lobes_.size() > static_cast<std::size_t>(kMaxLobes)) {
    throw std::invalid_argument("LobeSystem: 1 to 16 lobes");
  }
  if (squared_modulation.size() != directions.size()) {
    throw std::invalid_argument("LobeSystem: one modulation per light");
  }
  if (!(ridge >= 0.0) || !std::isfinite(ridge)) {
    throw std::invalid_argument("LobeSystem: the ridge must be finite and not negative");
  }
  const Eigen::Map<const Eigen::VectorXd> weights(squared_modulation.data(),
                                                  static_cast<Eigen::Index>(squared_modulation.size()));
  Eigen::MatrixXd gram = basis_.transpose() * weights.asDiagonal() * basis_;
  if (!gram.allFinite()) throw std::invalid_argument("LobeSystem: a modulation is not finite");
  products_.resize(basis_.cols() * (basis_.cols() + 1) / 2, basis_.rows());
  for (Eigen::Index i = 0, entry = 0; i < basis_.cols(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      products_.row(entry++) = basis_.col(i).cwiseProduct(basis_.col(j)).transpose();
    }
  }
  const double scale = gram.diagonal().mean();
  if (!(scale > 0.0)) gram.setIdentity();  // no light reaches a lobe: any unit will do
  penalty_ = ridge * (scale > 0.0 ? scale : 1.0);
  pack(gram);
}

LobeSystem LobeSystem::with_penalty(LobeSet lobes, std::span<const Vec3> directions,
                                    std::span<const double> squared_modulation, double penalty) {
  const LobeSystem unit(lobes, directions, squared_modulation, 1.0);
  return {std::move(lobes), directions, squared_modulation, penalty / unit.penalty()};
}

void LobeSystem::pack(const Eigen::MatrixXd& gram) {
  const Eigen::Index count = gram.rows();
  packed_.width = static_cast<int>((count + 3) / 4 * 4);
  const auto width = static_cast<std::size_t>(packed_.width);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const double largest = eigen.eigenvalues().maxCoeff();
  const double smallest = eigen.eigenvalues().minCoeff();
  condition_ = smallest > kSingular * largest ? largest / smallest : std::numeric_limits<double>::infinity();

  // Unknowns are mixes of lobes along eigenvectors, of the size at which the average texel's matrix, penalty
  // and all, is the identity, turned until mixes are an upper triangle. Unknowns that nothing determines stay
  // 0, as does the padding.
  Eigen::MatrixXd mixes = Eigen::MatrixXd::Zero(count, packed_.width);
  Eigen::MatrixXd penalty = Eigen::MatrixXd::Identity(packed_.width, packed_.width);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double size = eigen.eigenvalues()[k] + penalty_;
    if (size <= kSingular * (largest + penalty_)) continue;
    mixes.col(k) = eigen.eigenvectors().col(k) / std::sqrt(size);
    penalty(k, k) = penalty_ / size;
  }
  const Eigen::MatrixXd turn = turn_to_upper_triangle(mixes.leftCols(count));
  mixes.leftCols(count) = (mixes.leftCols(count) * turn).triangularView<Eigen::Upper>();
  penalty.topLeftCorner(count, count) = turn.transpose() * penalty.topLeftCorner(count, count) * turn;
  const Eigen::MatrixXd basis = basis_ * mixes;

  const auto lights = static_cast<std::size_t>(basis.rows());
  const std::size_t padded = (lights + kLightGroup - 1) / kLightGroup * kLightGroup;
  const std::size_t products = width * (width + 1) / 2;
  packed_.basis.assign(padded * width, 0.0F);
  packed_.products.assign(padded * products, 0.0F);
  for (std::size_t l = 0; l < lights; ++l) {
    const Eigen::RowVectorXd row = basis.row(static_cast<Eigen::Index>(l));
    std::size_t entry = l * products;
    for (Eigen::Index i = 0; i < row.size(); ++i) {
      packed_.basis[l * width + static_cast<std::size_t>(i)] = static_cast<float>(row[i]);
      for (Eigen::Index j = 0; j <= i; ++j) packed_.products[entry++] = static_cast<float>(row[i] * row[j]);
    }
  }
  for (Eigen::Index i = 0; i < penalty.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) packed_.penalty.push_back(static_cast<float>(penalty(i, j)));
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index i = 0; i < mixes.cols(); ++i) packed_.mixes.push_back(static_cast<float>(mixes(k, i)));
  }
}

SolveJob solve_job(const LobeSystem& system, std::size_t lights, std::size_t texels,
                   const SolveOptions& options, SolveResult& result) {
  result.amplitudes.assign(system.lobes().size() * texels, 0.0F);
  result.confidence.assign(texels, 0.0F);
  result.error_with.assign(texels, 0.0F);
  result.error_without.assign(texels, 0.0F);
  const LobeSystem::Packed& packed = system.packed();
  SolveJob job;
  job.width = packed.width;
  job.lobes = static_cast<int>(system.lobes().size());
  job.lights = lights;
  job.stride = texels;
  job.basis = packed.basis.data();
  job.products = packed.products.data();
  job.penalty = packed.penalty.data();
  job.mixes = packed.mixes.data();
  job.leave_one_out = options.leave_one_out;
  job.select = options.select;
  job.amplitudes = result.amplitudes.data();
  job.confidence = result.confidence.data();
  job.error_with = result.error_with.data();
  job.error_without = result.error_without.data();
  return job;
}

std::vector<double> lobe_numbers(const LobeSet& lobes) {
  std::vector<double> numbers;
  for (const Lobe& lobe : lobes) {
    numbers.insert(numbers.end(), {lobe.axis.x, lobe.axis.y, lobe.axis.z, lobe.sharpness, lobe.cos_cut_off});
  }
  return numbers;
}

void solve_parallel(const SolveJob& job, simd::Isa isa) {
  const SolveFunction run = solve_function(isa);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, job.stride, kGrain), [&](const auto& range) {
    const std::size_t planes = 3 + (job.near != nullptr ? static_cast<std::size_t>(job.width) : 0);
    std::vector<float> scratch(planes * kMostTexelsAtOnce * (job.lights + kLightGroup));
    SolveJob part = job;
    part.first = range.begin();
    part.count = range.size();
    part.scratch = scratch.data();
    run(part);
  });
}

SolveResult solve(const LobeSystem& system, const TexelProblem& problem, const SolveOptions& options) {
  check(system, problem);
  SolveResult result;
  SolveJob job = solve_job(system, problem.lights, problem.texels, options, result);
  job.residual = problem.residual.data();
  job.modulation = problem.modulation.data();
  job.weight = problem.weight.empty() ? nullptr : problem.weight.data();
  const std::vector<double> lobes = lobe_numbers(system.lobes());
  const NearLights near{problem.directions.data(), lobes.data()};
  if (!problem.directions.empty()) job.near = &near;
  solve_parallel(job, options.isa);
  return result;
}

std::vector<float> lobe_sums(const LobeSet& lobes, std::span<const Vec3> directions,
                             std::span<const float> near_directions, std::span<const float> amplitudes,
                             std::size_t texels) {
  const std::size_t lights = directions.size();
  if (amplitudes.size() != lobes.size() * texels ||
      (!near_directions.empty() && near_directions.size() != 3 * lights * texels)) {
    throw std::invalid_argument("lobe_sums: sizes disagree");
  }
  std::vector<float> sums(lights * texels, 0.0F);
  for (std::size_t l = 0; l < lights; ++l) {
    for (std::size_t k = 0; k < lobes.size(); ++k) {
      const double common = eval(lobes[k], directions[l]);
      for (std::size_t i = 0; i < texels; ++i) {
        double value = common;
        if (!near_directions.empty()) {
          const float* d = near_directions.data() + l * 3 * texels + i;
          value = eval(lobes[k], {d[0], d[texels], d[2 * texels]});
        }
        sums[l * texels + i] += static_cast<float>(value * amplitudes[k * texels + i]);
      }
    }
  }
  return sums;
}

}  // namespace brdfit::bake
