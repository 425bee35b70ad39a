// Sums over samples that a least-squares step needs: the Gram matrices of residuals and derivatives, per
// colour channel, over the coefficients that one channel depends on.
#ifndef BRDFIT_FIT_GRAM_H_
#define BRDFIT_FIT_GRAM_H_

#include <cstddef>

#include "brdf/simd/jobs.h"

namespace brdfit::fit {

// The columns of a job in single precision: those of its geometry in their order, sqrt_weight,
// clipped_share, the targets and the clipped targets.
inline constexpr std::size_t kSingleColumns = 19;

// The side of a Gram matrix: the coefficients of a channel (at most 14), then the residual, and what is left
// is 0.
inline constexpr int kGramSide = 16;

// How many coefficients a channel has, in the order of a Gram matrix' rows: the shape, then the colour.
// Burley's alpha_x and alpha_y count as one, as data are isotropic.
inline constexpr int kLambertGgxCoefficients = 3;
inline constexpr int kBurleyCoefficients = 8;
inline constexpr int kCallistoCoefficients = 14;

// With r = transform(f cos_i) - target[c][k] and u = min(f, 1) - clipped_target[c][k], sample k of channel c
// costs
//   weight[k] (robust(r) + clipped_share[k] robust(u)),
// where robust(r) is r^2 / 2 if its width (robust_width for r, clipped_width for u) is 0, else the
// pseudo-Huber d^2 (sqrt(1 + (r/d)^2) - 1) with d the width: squares below d, absolute values above.
struct GramJob {
  simd::Coefficients coefficients;
  simd::GeometryColumns geometry;
  const double* sqrt_weight = nullptr;
  const double* target[3] = {};
  std::size_t count = 0;  // a multiple of simd::kBlock
  int loss = 0;           // as fit::Loss
  // f of a sample is the mean of f(wi, wo) and f(wo, wi), as a stored cell is; needed where a material is not
  // reciprocal and cos_i differs from cos_o.
  bool mean_of_orders = false;
  double robust_width = 0.0;
  double clipped_width = 0.0;
  const double* clipped_share = nullptr;
  const double* clipped_target[3] = {};
  // Where not null, sums are made in single precision, from kSingleColumns columns that begin single_stride
  // apart. For the log-ratio with both widths and without `curvature`, of materials that need a lobe once per
  // sample; other jobs do not look at it.
  const float* single = nullptr;
  std::size_t single_stride = 0;
  // Robust residuals are weighted by the cost's second derivative, (1 + (r/d)^2)^(-3/2), in products of
  // derivatives: how fast the gradient changes, which their own weight overstates.
  bool curvature = false;
};

// Per channel, rows and columns 0..n-1: products of derivatives; row and column n: with the residual, where n
// is the number of coefficients of the model. The upper triangle is filled, by rows. Robust residuals are
// weighted by 1/sqrt(1 + (r/d)^2), so that the products with the residual are the gradient of the cost (with
// `curvature` as well).
struct Gram {
  double channel[3][kGramSide * kGramSide];
  double cost;
};

using GramFunction = void (*)(const GramJob&, Gram&);
// The cost alone.
using CostFunction = double (*)(const GramJob&);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_GRAM_H_
