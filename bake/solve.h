// Amplitudes of texels: weighted ridge least squares in the modulated domain.
//
// A texel's amplitudes a minimise
//   sum over lights of weight (residual - modulation sum_k a_k lobe_k)^2 + a^T penalty a.
// Its leave-one-out error, what would be left under each light had it not been there, is known in closed
// form: the residual over 1 minus the light's diagonal of the hat matrix (Allen 1974).
#ifndef BRDFIT_BAKE_SOLVE_H_
#define BRDFIT_BAKE_SOLVE_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/lobes.h"
#include "bake/texel_problem.h"
#include "brdf/simd/dispatch.h"

namespace brdfit::bake {

// What all texels of an asset share: lobes, lights and the ridge. Blocks that are solved with the same system
// get the same amplitudes however the asset is cut into blocks.
class LobeSystem {
 public:
  // lobes: at most kMaxLobes. directions: of the lights (of near ones, as seen from the centre).
  // squared_modulation: per light, the asset's mean of weight x modulation^2 (mean_squared_modulation of a
  // sample). ridge >= 0: the penalty, relative to the mean diagonal of the lobes' Gram matrix under these.
  // Throws std::invalid_argument where sizes disagree or values are outside.
  LobeSystem(LobeSet lobes, std::span<const Vec3> directions, std::span<const double> squared_modulation,
             double ridge);

  // The same with the penalty itself in place of the ridge, for lobes whose penalty another stack has chosen.
  static LobeSystem with_penalty(LobeSet lobes, std::span<const Vec3> directions,
                                 std::span<const double> squared_modulation, double penalty);

  const LobeSet& lobes() const { return lobes_; }
  const std::vector<Vec3>& directions() const { return directions_; }
  const std::vector<double>& squared_modulation() const { return squared_modulation_; }
  const Eigen::MatrixXd& basis() const { return basis_; }  // lights x lobes
  // (lobe, lobe) below and on the diagonal by rows, x lights: products of two lobes' values.
  const Eigen::MatrixXd& products() const { return products_; }
  double ridge() const { return ridge_; }
  double penalty() const { return penalty_; }  // the penalty's diagonal
  // Of the Gram matrix of the average texel, without ridge; infinite where lobes cannot be told apart.
  double condition() const { return condition_; }

  // For vector code: see SolveJob.
  struct Packed {
    int width = 0;
    std::vector<float> basis;
    std::vector<float> products;
    std::vector<float> penalty;
    std::vector<float> mixes;
  };
  const Packed& packed() const { return packed_; }

 private:
  void pack(const Eigen::MatrixXd& gram);

  LobeSet lobes_;
  std::vector<Vec3> directions_;
  std::vector<double> squared_modulation_;
  Eigen::MatrixXd basis_;
  Eigen::MatrixXd products_;
  double ridge_;
  double penalty_;
  double condition_;
  Packed packed_;
};

struct SolveOptions {
  // Errors are those of leaving each light out; otherwise those of training.
  bool leave_one_out = true;
  // Texels whose error is no less with lobes than without get amplitudes 0.
  bool select = true;
  simd::Isa isa = simd::best_isa();
};

// All finite.
struct SolveResult {
  std::vector<float> amplitudes;  // [lobe][texel]
  std::vector<float> confidence;  // [texel] in [0, 1]: the share of the squared error that lobes take away;
                                  // 0 where they take none
  std::vector<float> error_with;  // [texel]: sum over lights of weight x error^2 with lobes
  std::vector<float> error_without;  // and without
};

// In parallel over texels; identical for any number of threads.
SolveResult solve(const LobeSystem& system, const TexelProblem& problem, const SolveOptions& options = {});

// [light][texel]: the sum over lobes of amplitude x lobe under lights from these directions; of near ones,
// under near_directions (as TexelProblem::directions; empty: there are none).
std::vector<float> lobe_sums(const LobeSet& lobes, std::span<const Vec3> directions,
                             std::span<const float> near_directions, std::span<const float> amplitudes,
                             std::size_t texels);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_H_
