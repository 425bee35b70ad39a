// Texels grouped by modulation, and the covariance of each group.
#include "bake/residual_classes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "bake/k_means.h"

namespace brdfit::bake {
namespace {

constexpr Eigen::Index kSpareRank = 8;
constexpr int kPowerRounds = 2;
// Texels whose residuals are added to a covariance at once.
constexpr std::size_t kBatch = 256;

double energy_of(const TexelProblem& problem, std::size_t texel) {
  double energy = 0.0;
  for (std::size_t l = 0; l < problem.lights; ++l) {
    const double e = problem.residual[problem.at(l, texel)];
    energy += problem.weight_of(l, texel) * e * e;
  }
  return energy;
}

// The mean direction of the light that a texel gets: which of its lights count.
Vec3 feature(const TexelProblem& problem, std::span<const Vec3> directions, std::size_t texel) {
  Vec3 sum{0.0, 0.0, 0.0};
  double mass = 0.0;
  for (std::size_t l = 0; l < problem.lights; ++l) {
    const double m = problem.modulation[problem.at(l, texel)];
    const double q = problem.weight_of(l, texel) * m * m;
    const Vec3 d = problem.direction(l, texel, directions[l]);
    sum = {sum.x + q * d.x, sum.y + q * d.y, sum.z + q * d.z};
    mass += q;
  }
  if (!(mass > 0.0)) return {0.0, 0.0, 0.0};
  return {sum.x / mass, sum.y / mass, sum.z / mass};
}

// A factor of the largest part of a covariance: its range found by random vectors (Halko et al. 2011).
Eigen::MatrixXd low_rank_factor(const Eigen::MatrixXd& covariance, int rank, std::uint64_t seed) {
  const Eigen::Index side = covariance.rows();
  const Eigen::Index width = std::min<Eigen::Index>(side, rank + kSpareRank);
  Eigen::MatrixXd range(side, width);
  std::mt19937_64 random(seed);
  for (Eigen::Index i = 0; i < range.size(); ++i) {
    range.data()[i] = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
  }
  for (int round = 0; round <= kPowerRounds; ++round) {
    const Eigen::MatrixXd image = covariance * range;
    range =
        Eigen::HouseholderQR<Eigen::MatrixXd>(image).householderQ() * Eigen::MatrixXd::Identity(side, width);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(range.transpose() * covariance * range);
  const Eigen::Index kept = std::min<Eigen::Index>(rank, width);
  const Eigen::VectorXd roots = eigen.eigenvalues().tail(kept).cwiseMax(0.0).cwiseSqrt();
  return range * eigen.eigenvectors().rightCols(kept) * roots.asDiagonal();
}

ResidualClass class_of(const TexelProblem& problem, std::span<const Vec3> directions,
                       const std::vector<std::size_t>& members, const ClassOptions& options) {
  const auto lights = static_cast<Eigen::Index>(problem.lights);
  ResidualClass result;
  result.texels = members.size();
  result.modulation = Eigen::VectorXd::Zero(lights);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(lights, lights);
  std::vector<Vec3> sums(problem.lights, Vec3{0.0, 0.0, 0.0});
  for (std::size_t first = 0; first < members.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, members.size() - first);
    Eigen::MatrixXd residuals(lights, static_cast<Eigen::Index>(count));
    for (std::size_t l = 0; l < problem.lights; ++l) {
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = members[first + k];
        const double weight = problem.weight_of(l, i);
        const double m = problem.modulation[problem.at(l, i)];
        const Vec3 d = problem.direction(l, i, directions[l]);
        residuals(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(k)) =
            std::sqrt(weight) * problem.residual[problem.at(l, i)];
        result.modulation[static_cast<Eigen::Index>(l)] += weight * m * m;
        sums[l] = {sums[l].x + d.x, sums[l].y + d.y, sums[l].z + d.z};
      }
    }
    covariance.selfadjointView<Eigen::Lower>().rankUpdate(residuals);
  }
  covariance = Eigen::MatrixXd(covariance.selfadjointView<Eigen::Lower>());
  result.modulation = (result.modulation / static_cast<double>(members.size())).cwiseSqrt();
  for (const Vec3& sum : sums) {
    const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    result.directions.push_back(length > 0.0 ? Vec3{sum.x / length, sum.y / length, sum.z / length} : Vec3{});
  }
  result.energy = covariance.trace();
  result.factor = low_rank_factor(covariance, options.rank, options.seed);
  return result;
}

}  // namespace

std::vector<ResidualClass> residual_classes(const TexelProblem& problem, std::span<const Vec3> directions,
                                            const ClassOptions& options) {
  std::vector<Vec3> features;
  std::vector<double> energies;
  for (std::size_t i = 0; i < problem.texels; ++i) {
    features.push_back(feature(problem, directions, i));
    energies.push_back(energy_of(problem, i));
  }
  const Clusters clusters = k_means(features, energies, options.classes, options.seed);
  std::vector<std::vector<std::size_t>> members(clusters.centres.size());
  for (std::size_t i = 0; i < problem.texels && !members.empty(); ++i) {
    if (energies[i] > 0.0) members[clusters.of[i]].push_back(i);
  }
  std::vector<ResidualClass> classes;
  for (const std::vector<std::size_t>& texels : members) {
    if (!texels.empty()) classes.push_back(class_of(problem, directions, texels, options));
  }
  return classes;
}

}  // namespace brdfit::bake
