// The hard cases of the kernels that docs/stability.md lists: where each lies, and where models bend or jump.
#ifndef BRDFIT_TESTS_STABILITY_CASES_H_
#define BRDFIT_TESTS_STABILITY_CASES_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/slope_differences.h"

namespace brdfit::stability {

// Materials times pairs of directions. Where h or a cosine has to be exactly 0 or 1, which no pair of rounded
// directions above the horizon has, geometries stand beside the pairs: kernels take them, a device does not.
struct KernelCase {
  std::string id;
  std::vector<Material> materials;
  std::vector<testing_support::Pair> pairs;
  std::vector<kernel::Geometry<double>> geometries = {};
  // Whether every pair is at or below the horizon: the value is 0.
  bool dark = false;
};
const std::vector<KernelCase>& kernel_cases();

// A path through a branch of a kernel: t = 0 is where it switches.
struct BranchCase {
  std::string id;
  Material material;  // as far as t does not change it
  testing_support::Pair pair;
  std::function<void(double t, Material&, testing_support::Pair&)> move;
  std::vector<double> steps;  // distances from 0 to look from, in double precision, falling
  // How far f cos_i of both sides may be apart, as a multiple of the step and of the value (double only; in
  // single precision both sides must agree with double).
  double slope = 10.0;
  double power = 1.0;  // of the step; 0.5 where the model has a root
  // A jump: f cos_i of the red channel just below and just above. Empty: continuous.
  struct Limits {
    double below;
    double above;
  };
  std::optional<Limits> jump = {};
};
const std::vector<BranchCase>& branch_cases();

// A parameter at which a model has a kink: slopes from both sides exist and differ.
struct KinkCase {
  std::string id;
  Material material;  // at the kink
  testing_support::Pair pair;
  std::string parameter;
};
const std::vector<KinkCase>& kink_cases();

// Whether a slope is not looked at, as the model has a kink or a jump just there: those that kink_cases() and
// branch_cases() look at from both sides.
bool is_at_kink(const Material& material, const ProductEntry& entry, const kernel::Geometry<double>& g);

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_CASES_H_
