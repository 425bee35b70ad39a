// The error that a set of lobes leaves, each light left out in turn, as a smooth function of the lobes.
#ifndef BRDFIT_BAKE_LOBE_OBJECTIVE_H_
#define BRDFIT_BAKE_LOBE_OBJECTIVE_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/lobes.h"
#include "bake/residual_classes.h"

namespace brdfit::bake {

// Bounds of what is searched. Parameters live on the whole line and are mapped into them.
struct LobeBounds {
  double sharpness_low = 0.05;
  double sharpness_high = 100.0;
  double least_cut_off = 0.2;  // angle in radians; the largest is pi
  double ridge_low = 1e-5;     // relative, as LobeSystem's
  double ridge_high = 1e2;
};
// What a set of lights can tell apart: no lobe falls to less than a tenth, nor ends, before the next light.
LobeBounds bounds_of(std::span<const Vec3> directions);

// A class's loss, and its derivatives by what the lobes are worth under the lights and by the penalty.
struct ClassLoss {
  double loss = 0.0;
  double by_penalty = 0.0;
  Eigen::MatrixXd by_basis;  // lights x lobes
};

// Sum over classes j and lights l of [(I - H_j) C_j (I - H_j)]_ll / (1 - h_jl)^2, with H_j the hat matrix of
// the class's modulation and h_j its diagonal, over the sum of the covariances' traces: about the share of
// the squared error that stays. Allen 1974 for the form.
//
// Parameters: per lobe an axis (three numbers, of any length), the sharpness and the cut-off; then the ridge.
class LobeObjective {
 public:
  // Keeps references to classes, which must not be empty.
  LobeObjective(std::span<const ResidualClass> classes, int lobes, const LobeBounds& bounds);

  int parameters() const { return 5 * lobes_ + 1; }
  std::vector<double> pack(const LobeSet& lobes, double ridge) const;
  LobeSet lobes(std::span<const double> parameters) const;
  double ridge(std::span<const double> parameters) const;
  // Of lobes as they are, within bounds or not.
  double evaluate(const LobeSet& lobes, double ridge) const;
  // gradient: as many numbers as parameters, or null.
  double evaluate(std::span<const double> parameters, double* gradient) const;

 private:
  struct Range {
    double low;
    double high;
    double value(double t) const;
    double slope(double t) const;
    double inverse(double value) const;
  };

  void add_chain(const std::vector<Vec3>& directions, const Eigen::MatrixXd& by_basis, const LobeSet& lobes,
                 std::span<const double> parameters, double* gradient) const;

  // Classes that see their lights alike share the lobes' values: all of them do where lights are far away.
  std::vector<std::vector<const ResidualClass*>> groups_;
  int lobes_;
  Range sharpness_;
  Range width_;  // 1 / (1 - cos cut-off)
  Range ridge_;
  double unit_ = 1.0;  // of the ridge
  double energy_ = 0.0;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LOBE_OBJECTIVE_H_
