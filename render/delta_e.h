// Colour difference of rendered spheres: what a person sees of a fit's error.
#ifndef BRDFIT_RENDER_DELTA_E_H_
#define BRDFIT_RENDER_DELTA_E_H_

#include <array>
#include <cstddef>
#include <span>
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

struct DeltaESum;  // of vector code

struct SphereDeltaE {
  double mean = 0.0;                 // over all pixels of the sphere and the four lights
  std::array<double, 4> by_light{};  // for kLightAnglesDeg
  std::size_t pixels = 0;            // that were compared, over the four lights
  std::size_t skipped = 0;           // that a table does not hold
};

// Compares spheres with those of one reference, whose colours it keeps: size x size pixels, size even.
class SphereJudge {
 public:
  // Throws std::invalid_argument unless size is even and in 2..16384.
  explicit SphereJudge(const Subject& reference, int size = 256);

  // Pixels in shadow count (as equal); those that either subject does not hold are left out. NaN-free.
  // Parallel; the result does not depend on the number of threads.
  SphereDeltaE operator()(const Subject& candidate) const;

 private:
  // Neighbouring lit pixels of one light.
  struct Chunk {
    std::size_t light;
    std::size_t first;
    std::size_t count;
    std::size_t padded;
  };
  struct Colours {
    std::array<std::vector<float>, 3> itp;
  };

  void collect_pixels(std::size_t light);
  SphereDeltaE totals_of(std::span<const DeltaESum> sums) const;
  void evaluate(const Subject& subject, const Chunk& chunk, const std::array<float*, 3>& upper,
                const std::array<float*, 3>& lower) const;

  int size_;
  std::size_t half_pixels_ = 0;  // of the sphere's upper half, lit or not
  // Lit pixels of the upper half, light after light: wi and wo column by column. The lower half mirrors it.
  std::array<std::vector<double>, 6> directions_;
  std::vector<Chunk> chunks_;
  Colours upper_;
  // Of a table, whose values at phi_d and -phi_d may differ; empty for a material, whose halves are alike.
  Colours lower_;
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_DELTA_E_H_
