// Sums of products of rows, for Gram matrices. For sources added by brdfit_add_simd alone, as
// brdf/simd/lanes.h.
#ifndef BRDFIT_FIT_GRAM_PRODUCTS_H_
#define BRDFIT_FIT_GRAM_PRODUCTS_H_

#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

// Rows of one channel over a block of samples: derivatives, then the residual. Their stride is not a power of
// two, so that they do not compete for the same lines of the cache.
template <class S>
inline constexpr std::size_t kRowLength = 2 * kBlock*(sizeof(double) / sizeof(S));
template <class S, int Rows>
using BlockRows = S[Rows][kRowLength<S> + 64 / sizeof(S)];

// Products of rows i <= j, summed over samples lane by lane.
template <class S, int Rows>
struct Products {
  Lanes<S> sums[Rows][Rows];

  HWY_INLINE void clear() {
    for (int i = 0; i < Rows; ++i) {
      for (int j = i; j < Rows; ++j) sums[i][j] = Lanes<S>(0.0);
    }
  }
};

// Rows are multiplied tile by tile: a tile's sums and its rows fill the registers. (Highway's vectors are of
// 64 bytes only where there are 32 registers.) All row counts, 4, 9 and 15, are cut with little waste.
template <class S>
inline constexpr int kTile = Lanes<S>::size * sizeof(S) == 64 ? 5 : 3;

// The tile of rows I... by J...; of a tile on the diagonal the upper triangle.
template <class S, int Rows, int I, int J>
HWY_INLINE void add_tile(const BlockRows<S, Rows>& rows, std::size_t length, Products<S, Rows>& products) {
  using L = Lanes<S>;
  constexpr int height = I + kTile<S> < Rows ? kTile<S> : Rows - I;
  constexpr int width = J + kTile<S> < Rows ? kTile<S> : Rows - J;
  L sums[height][width];
#pragma GCC unroll 5
  for (int a = 0; a < height; ++a) {
#pragma GCC unroll 5
    for (int b = I == J ? a : 0; b < width; ++b) sums[a][b] = products.sums[I + a][J + b];
  }
  for (std::size_t at = 0; at < length; at += L::size) {
    L left[height];
#pragma GCC unroll 5
    for (int a = 0; a < height; ++a) left[a] = L::load(rows[I + a] + at);
#pragma GCC unroll 5
    for (int b = 0; b < width; ++b) {
      const L right = I == J ? left[b] : L::load(rows[J + b] + at);
#pragma GCC unroll 5
      for (int a = 0; a < (I == J ? b + 1 : height); ++a) {
        sums[a][b] = multiply_add(left[a], right, sums[a][b]);
      }
    }
  }
#pragma GCC unroll 5
  for (int a = 0; a < height; ++a) {
#pragma GCC unroll 5
    for (int b = I == J ? a : 0; b < width; ++b) products.sums[I + a][J + b] = sums[a][b];
  }
}

// All tiles from (I, J) on.
template <class S, int Rows, int I = 0, int J = 0>
HWY_INLINE void add_products(const BlockRows<S, Rows>& rows, std::size_t length,
                             Products<S, Rows>& products) {
  add_tile<S, Rows, I, J>(rows, length, products);
  if constexpr (J + kTile<S> < Rows) {
    add_products<S, Rows, I, J + kTile<S>>(rows, length, products);
  } else if constexpr (I + kTile<S> < Rows) {
    add_products<S, Rows, I + kTile<S>, I + kTile<S>>(rows, length, products);
  }
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_FIT_GRAM_PRODUCTS_H_
