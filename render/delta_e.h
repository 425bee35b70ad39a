// Colour difference of rendered spheres: what a person sees of a fit's error.
#ifndef BRDFIT_RENDER_DELTA_E_H_
#define BRDFIT_RENDER_DELTA_E_H_

#include <array>
#include <cstddef>
#include <vector>

#include "brdf/vec3.h"
#include "measured/table.h"
#include "render/sphere.h"
#include "render/subject.h"

namespace brdfit::render {

// I, T, P (ITU-R BT.2124) of a linear Rec.709 colour of which 1 is 100 cd/m2, through BT.2100's PQ ICtCp:
// T is Ct / 2, P is Cp. Values above 10000 cd/m2 continue the curve.
Rgb itp_from_linear(const Rgb& linear);

// 720 times the distance in ITP; 1 is just noticeable in the most critical conditions (BT.2124).
double delta_e_itp(const Rgb& itp_a, const Rgb& itp_b);

struct SphereDeltaE {
  double mean = 0.0;                 // over all pixels of the sphere and the four lights
  std::array<double, 4> by_light{};  // for kLightAnglesDeg
  std::size_t pixels = 0;            // that were compared, over the four lights
  std::size_t skipped = 0;           // that a table does not hold
};

// Compares spheres with those of one reference, whose colours it keeps: size x size pixels, size even.
class SphereJudge {
 public:
  explicit SphereJudge(const Subject& reference, int size = 256);

  // Pixels in shadow count (as equal); those that either subject does not hold are left out. NaN-free.
  SphereDeltaE operator()(const Subject& candidate) const;

 private:
  int size_;
  std::array<std::vector<float>, 4> reference_itp_;  // lit pixels of the upper half, which mirrors the lower
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_DELTA_E_H_
