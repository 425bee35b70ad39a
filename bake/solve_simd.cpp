// Least squares of many texels at once, a texel per lane. Compiled once for every instruction set.
//
// Texels share the lobes' products, so that a texel's Gram matrix is a product of these with its squared
// modulations: the work is that of small matrix products, in registers. Sums are single precision; unknowns
// are mixes of lobes that are orthonormal on average, and one step of refinement on the residual takes the
// solution to where single precision of the residual itself ends.
#include "bake/dither.h"
#include "bake/solve_job.h"
#include "brdf/kernel/spherical_gaussian.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using bake::kLightGroup;
using bake::RoundJob;
using bake::ShadeSource;
using bake::SolveJob;
using V = Lanes<float>;
using D = Lanes<double>;

constexpr int kWide = 2;  // vectors of texels that share each broadcast value
constexpr std::size_t kStep = kWide * V::size;
constexpr std::size_t kAhead = 2 * kStep;
constexpr int kChunk = V::size >= 16 ? 12 : 6;  // sums held in registers at once
// Residuals beyond this count as not finite.
constexpr double kLargest = 3e38;
// The least pivot, as a share of the diagonal: above the rounding that is left of one that should be 0.
constexpr double kLeastPivot = 4e-6;
constexpr double kTiny = 1e-30;

struct Wide {
  V part[kWide];
};

HWY_INLINE V broadcast(float x) {
  return V::of(hn::Set(V::Tag(), x));
}

// P: unknowns. kNear: whether each texel has its own values of the lobes.
template <int P, bool kNear>
class TexelSolver {
 public:
  static constexpr int n = P * (P + 1) / 2;

  explicit TexelSolver(const SolveJob& job)
      : job_(job),
        padded_((job.lights + kLightGroup - 1) / kLightGroup * kLightGroup),
        residual_(job.scratch),
        modulation_(residual_ + padded_ * kStep),
        left_(modulation_ + padded_ * kStep),
        own_basis_(left_ + padded_ * kStep) {
    static_assert(kStep <= bake::kMostTexelsAtOnce);
    for (std::size_t at = 0; at < (kNear ? 3 + P : 3) * padded_ * kStep; ++at) residual_[at] = 0.0F;
  }

  void run() {
    for (std::size_t at = 0; at < job_.count; at += kStep) {
      const std::size_t length = job_.count - at < kStep ? job_.count - at : kStep;
      load(job_.first + at, length);
      if constexpr (kNear) find_basis(job_.first + at, length);
      if constexpr (kNear) {
        sum_own_products<0>();
      } else {
        sum_products<0>();
      }
      invert();
      solve();
      if (job_.round != nullptr) round(job_.first + at, length);
      errors();
      store(job_.first + at, length);
    }
  }

 private:
  static constexpr int entry(int i, int j) { return i * (i + 1) / 2 + j; }

  // Residual and modulation, both times the root of the weight.
  HWY_NOINLINE void load(std::size_t first, std::size_t length) {
    if (job_.source != nullptr) return shade(first, length);
    for (std::size_t l = 0; l < job_.lights; ++l) {
      const std::size_t from = l * job_.stride + first;
      if (length == kStep) {
        for (std::size_t w = 0; w < kStep; w += V::size) {
          const V root = job_.weight == nullptr ? V(1.0) : sqrt(V::load(job_.weight + from + w));
          (root * V::load(job_.residual + from + w)).store(&residual_[l * kStep + w]);
          (root * V::load(job_.modulation + from + w)).store(&modulation_[l * kStep + w]);
        }
      } else {
        load_some(l, from, length);
      }
    }
  }

  HWY_NOINLINE void load_some(std::size_t l, std::size_t from, std::size_t length) {
    alignas(64) float weight[kStep];
    for (std::size_t k = 0; k < kStep; ++k) {
      weight[k] = k >= length ? 0.0F : job_.weight == nullptr ? 1.0F : job_.weight[from + k];
    }
    for (std::size_t w = 0; w < kStep; w += V::size) sqrt(V::load(weight + w)).store(weight + w);
    for (std::size_t k = 0; k < kStep; ++k) {
      residual_[l * kStep + k] = k < length ? weight[k] * job_.residual[from + k] : 0.0F;
      modulation_[l * kStep + k] = k < length ? weight[k] * job_.modulation[from + k] : 0.0F;
    }
  }

  // A source's planes from a texel on, of one light where it has several.
  struct Planes {
    const float* values;
    const float* weight;
    std::size_t stride;
  };
  struct Facts {  // of a vector of texels
    V normal[3];
    V albedo[3];
  };

  HWY_INLINE Facts facts_at(const float* normals, const float* albedo, std::size_t stride) const {
    Facts facts;
    for (std::size_t c = 0; c < 3; ++c) {
      facts.normal[c] = V::load(normals + c * stride);
      facts.albedo[c] = V::load(albedo + c * stride);
    }
    return facts;
  }

  // The same from values and normals.
  HWY_NOINLINE void shade(std::size_t first, std::size_t length) {
    const ShadeSource& s = *job_.source;
    if (length < kStep) return shade_some(first, length);
    Facts facts[kWide];
    for (std::size_t w = 0; w < kWide; ++w) {
      const std::size_t texel = first + w * V::size;
      facts[w] = facts_at(s.normals + texel, s.albedo + texel, job_.stride);
    }
    for (std::size_t l = 0; l < job_.lights; ++l) {
      const float* values = s.values + l * s.channels * job_.stride + first;
      // Lights lie too far apart for the processor to foresee where it will be needed next.
      for (std::size_t c = 0; c < s.channels; ++c) prefetch(values + c * job_.stride + kAhead);
      for (std::size_t w = 0; w < kWide; ++w) {
        const std::size_t at = w * V::size;
        shade_light(
            l, at, facts[w],
            {values + at, job_.weight == nullptr ? nullptr : job_.weight + l * job_.stride + first + at,
             job_.stride});
      }
    }
  }

  // Of what one step reads; an address beyond the array is never read from.
  static HWY_INLINE void prefetch(const float* from) {
    for (std::size_t at = 0; at < kStep; at += 16) __builtin_prefetch(from + at);
  }

  HWY_NOINLINE void shade_some(std::size_t first, std::size_t length) {
    const ShadeSource& s = *job_.source;
    float normals[3 * kStep];
    float albedo[3 * kStep];
    float values[3 * kStep];
    float weight[kStep];
    const auto copy = [&](const float* from, std::size_t rows, float* to) {
      for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t k = 0; k < kStep; ++k) {
          to[row * kStep + k] = k < length ? from[row * job_.stride + first + k] : 0.0F;
        }
      }
    };
    copy(s.normals, 3, normals);
    copy(s.albedo, 3, albedo);
    for (std::size_t l = 0; l < job_.lights; ++l) {
      copy(s.values + l * s.channels * job_.stride, s.channels, values);
      if (job_.weight != nullptr) copy(job_.weight + l * job_.stride, 1, weight);
      for (std::size_t w = 0; w < kStep; w += V::size) {
        shade_light(l, w, facts_at(normals + w, albedo + w, kStep),
                    {values + w, job_.weight == nullptr ? nullptr : weight + w, kStep});
      }
    }
  }

  HWY_INLINE void shade_light(std::size_t l, std::size_t w, const Facts& f, const Planes& from) {
    const ShadeSource& s = *job_.source;
    const V facing = mixed(f.normal, s.direction + 3 * l);
    const float* colour = s.colour + 3 * l;
    const V shade = select(facing > V(0.0), facing, V(0.0));
    const V reflected = mixed(f.albedo, colour);
    const V modulation =
        shade * (s.albedo_in_modulation ? reflected : broadcast(colour[0] + colour[1] + colour[2]));
    const V value = s.channels == 1 ? V::load(from.values) : luminance(from.values, from.stride);
    const V residual = s.is_residual ? value : value - shade * reflected;
    const auto finite = abs(residual) + modulation < V(kLargest);
    V used_residual = select(finite, residual, V(0.0));
    V used_modulation = select(finite, modulation, V(0.0));
    if (from.weight != nullptr) {  // a root for nothing would cost as much as the rest
      const V root = sqrt(V::load(from.weight));
      used_residual = root * used_residual;
      used_modulation = root * used_modulation;
    }
    used_residual.store(&residual_[l * kStep + w]);
    used_modulation.store(&modulation_[l * kStep + w]);
  }

  HWY_INLINE V mixed(const V (&x)[3], const float* shares) const {
    return multiply_add(x[0], broadcast(shares[0]),
                        multiply_add(x[1], broadcast(shares[1]), x[2] * broadcast(shares[2])));
  }

  HWY_INLINE V luminance(const float* from, std::size_t stride) const {
    const V x[3] = {V::load(from), V::load(from + stride), V::load(from + 2 * stride)};
    return mixed(x, job_.source->mix);
  }

  // Unknown k's value under light l for a vector of texels.
  HWY_INLINE V basis(std::size_t l, int k, int w) const {
    if constexpr (kNear) {
      return V::load(own_basis_ + (l * P + static_cast<std::size_t>(k)) * kStep +
                     static_cast<std::size_t>(w) * V::size);
    } else {
      return broadcast(job_.basis[l * P + static_cast<std::size_t>(k)]);
    }
  }

  // Values of lobes are taken in double precision, as in single precision cosines near 1 say little of narrow
  // ones.
  HWY_NOINLINE void find_basis(std::size_t first, std::size_t length) {
    alignas(64) float direction[3 * kStep];
    alignas(64) float values[kStep];
    for (std::size_t l = 0; l < job_.lights; ++l) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float* from = job_.near->directions + (3 * l + c) * job_.stride + first;
        for (std::size_t t = 0; t < kStep; ++t) direction[c * kStep + t] = t < length ? from[t] : 0.0F;
      }
      V mixed_values[P][kWide];
      for (int i = 0; i < P; ++i) {
        for (int w = 0; w < kWide; ++w) mixed_values[i][w] = V(0.0);
      }
      for (int k = 0; k < job_.lobes; ++k) {
        lobe_values(job_.near->lobes + 5 * k, direction, values);
        for (int i = 0; i < P; ++i) {
          const V share = broadcast(job_.mixes[k * P + i]);
          for (int w = 0; w < kWide; ++w) {
            mixed_values[i][w] = multiply_add(share, V::load(values + static_cast<std::size_t>(w) * V::size),
                                              mixed_values[i][w]);
          }
        }
      }
      for (int i = 0; i < P; ++i) {
        float* to = own_basis_ + (l * P + static_cast<std::size_t>(i)) * kStep;
        for (int w = 0; w < kWide; ++w) {
          mixed_values[i][w].store(to + static_cast<std::size_t>(w) * V::size);
        }
      }
    }
  }

  HWY_NOINLINE static void lobe_values(const double* lobe, const float* direction, float* values) {
    const typename D::Tag wide;
    const hn::Rebind<float, typename D::Tag> narrow;
    for (std::size_t at = 0; at < kStep; at += D::size) {
      const auto part = [&](std::size_t c) {
        return D::of(hn::PromoteTo(wide, hn::LoadU(narrow, direction + c * kStep + at)));
      };
      const D one_minus_cos =
          kernel::one_minus_cos_between(D(lobe[0]), D(lobe[1]), D(lobe[2]), part(0), part(1), part(2));
      const D value = kernel::windowed_lobe(one_minus_cos, D(lobe[3]), D(lobe[4]));
      hn::StoreU(hn::DemoteTo(narrow, value.v), narrow, values + at);
    }
  }

  // Rows of the Gram matrix, from products of each texel's own values.
  template <int kRow>
  HWY_INLINE void sum_own_products() {
    if constexpr (kRow < P) {
      V sums[kRow + 1][kWide];
      for (int j = 0; j <= kRow; ++j) {
        for (int w = 0; w < kWide; ++w) sums[j][w] = V(0.0);
      }
      for (std::size_t l = 0; l < job_.lights; ++l) {
        for (int w = 0; w < kWide; ++w) {
          const V m = V::load(&modulation_[l * kStep + static_cast<std::size_t>(w) * V::size]);
          const V weighted = m * m * basis(l, kRow, w);
          for (int j = 0; j <= kRow; ++j) {
            sums[j][w] = multiply_add(weighted, basis(l, j, w), sums[j][w]);
          }
        }
      }
      for (int j = 0; j <= kRow; ++j) {
        for (int w = 0; w < kWide; ++w) gram_[entry(kRow, j)].part[w] = sums[j][w];
      }
      sum_own_products<kRow + 1>();
    }
  }

  // Sums over lights of kCount columns of coefficients times what `value` gives.
  template <int kCount, class Coefficient, class Value>
  HWY_INLINE void sum_columns(const Coefficient& coefficient, const Value& value, Wide* to) {
    V sums[kCount][kWide];
    for (int c = 0; c < kCount; ++c) {
      for (int w = 0; w < kWide; ++w) sums[c][w] = V(0.0);
    }
    for (std::size_t l = 0; l < job_.lights; ++l) {
      V x[kWide];
      for (int w = 0; w < kWide; ++w) x[w] = value(l * kStep + static_cast<std::size_t>(w) * V::size);
#pragma GCC unroll 16
      for (int c = 0; c < kCount; ++c) {
        for (int w = 0; w < kWide; ++w) sums[c][w] = multiply_add(coefficient(l, c, w), x[w], sums[c][w]);
      }
    }
    for (int c = 0; c < kCount; ++c) {
      for (int w = 0; w < kWide; ++w) to[c].part[w] = sums[c][w];
    }
  }

  template <int kFirst>
  HWY_INLINE void sum_products() {
    if constexpr (kFirst < n) {
      constexpr int count = n - kFirst < kChunk ? n - kFirst : kChunk;
      sum_columns<count>(
          [this](std::size_t l, int k, int) {
            return broadcast(job_.products[l * n + static_cast<std::size_t>(kFirst + k)]);
          },
          [this](std::size_t at) {
            const V m = V::load(&modulation_[at]);
            return m * m;
          },
          gram_ + kFirst);
      sum_products<kFirst + count>();
    }
  }

  template <int kFirst>
  HWY_INLINE void sum_right_sides(const float* values) {
    if constexpr (kFirst < P) {
      constexpr int count = P - kFirst < kChunk ? P - kFirst : kChunk;
      const auto value = [this, values](std::size_t at) {
        return V::load(&modulation_[at]) * V::load(values + at);
      };
      sum_columns<count>([this](std::size_t l, int k, int w) { return basis(l, kFirst + k, w); }, value,
                         right_ + kFirst);
      sum_right_sides<kFirst + count>(values);
    }
  }

  // gram_ becomes the inverse of itself with the penalty. Vectors take turns: each alone would wait for its
  // own last result most of the time.
  HWY_NOINLINE void invert() {
    Wide lower[n];
    Wide inverse_diagonal[P];
    for (int j = 0; j < P; ++j) {
      Wide column[P];
      for (int i = j; i < P; ++i) {
        column[i] = plus(gram_[entry(i, j)], broadcast(job_.penalty[entry(i, j)]));
      }
      const Wide whole = column[j];
      for (int k = 0; k < j; ++k) {
        const Wide factor = lower[entry(j, k)];
        for (int i = j; i < P; ++i) subtract_product(lower[entry(i, k)], factor, column[i]);
      }
      for (int w = 0; w < kWide; ++w) {
        const V pivot = column[j].part[w];
        const V least = multiply_add(whole.part[w], V(kLeastPivot), V(kTiny));
        inverse_diagonal[j].part[w] = V(1.0) / sqrt(select(pivot > least, pivot, least));
      }
      for (int i = j + 1; i < P; ++i) lower[entry(i, j)] = product(column[i], inverse_diagonal[j]);
    }
    invert_triangle(lower, inverse_diagonal);
    if (job_.round != nullptr) find_followers(lower);
    for (int i = 0; i < P; ++i) {
      for (int j = 0; j <= i; ++j) {
        Wide value = product(lower[entry(i, i)], lower[entry(i, j)]);
        for (int k = i + 1; k < P; ++k) add_product(lower[entry(k, i)], lower[entry(k, j)], value);
        gram_[entry(i, j)] = value;
      }
    }
  }

  // In place of the triangle, whose diagonal is that of which the inverse is given.
  static HWY_INLINE void invert_triangle(Wide* lower, const Wide* inverse_diagonal) {
    for (int j = 0; j < P; ++j) {
      lower[entry(j, j)] = inverse_diagonal[j];
      for (int i = j + 1; i < P; ++i) {
        Wide value = product(lower[entry(i, j)], lower[entry(j, j)]);
        for (int k = j + 1; k < i; ++k) add_product(lower[entry(i, k)], lower[entry(k, j)], value);
        for (int w = 0; w < kWide; ++w) value.part[w] = V(0.0) - value.part[w];
        lower[entry(i, j)] = product(value, inverse_diagonal[i]);
      }
    }
  }

  static HWY_INLINE Wide plus(const Wide& a, V b) {
    Wide sum;
    for (int w = 0; w < kWide; ++w) sum.part[w] = a.part[w] + b;
    return sum;
  }

  static HWY_INLINE Wide product(const Wide& a, const Wide& b) {
    Wide value;
    for (int w = 0; w < kWide; ++w) value.part[w] = a.part[w] * b.part[w];
    return value;
  }

  static HWY_INLINE void add_product(const Wide& a, const Wide& b, Wide& sum) {
    for (int w = 0; w < kWide; ++w) sum.part[w] = multiply_add(a.part[w], b.part[w], sum.part[w]);
  }

  static HWY_INLINE void subtract_product(const Wide& a, const Wide& b, Wide& sum) {
    for (int w = 0; w < kWide; ++w) sum.part[w] = sum.part[w] - a.part[w] * b.part[w];
  }

  // By how much the best values of lobes before k follow lobe k, all after it being known. Mixes are an upper
  // triangle, and so is their product with the transpose of the Gram matrix's inverse triangle, which is a
  // root of the amplitudes' covariance: its columns are what amplitudes have in common with that of k alone.
  HWY_INLINE void find_followers(const Wide* inverse_lower) {
    for (int k = 0; k < job_.lobes; ++k) {
      Wide share;
      for (int w = 0; w < kWide; ++w) {
        const V own = broadcast(job_.mixes[k * P + k]) * inverse_lower[entry(k, k)].part[w];
        const auto known = own * own > V(kTiny);
        share.part[w] = select(known, V(1.0) / select(known, own, V(1.0)), V(0.0));
      }
      for (int j = 0; j < k; ++j) {
        V sums[kWide] = {V(0.0), V(0.0)};
        for (int i = j; i <= k; ++i) {
          const V mix = broadcast(job_.mixes[j * P + i]);
          for (int w = 0; w < kWide; ++w) {
            sums[w] = multiply_add(mix, inverse_lower[entry(k, i)].part[w], sums[w]);
          }
        }
        for (int w = 0; w < kWide; ++w) follow_[entry(k, j)].part[w] = sums[w] * share.part[w];
      }
    }
  }

  // unknowns_ += inverse times the right sides.
  HWY_INLINE void add_solution() {
    for (int w = 0; w < kWide; ++w) {
      for (int i = 0; i < P; ++i) {
        V value = unknowns_[i].part[w];
        for (int j = 0; j < P; ++j) {
          const V a = gram_[i >= j ? entry(i, j) : entry(j, i)].part[w];
          value = multiply_add(a, right_[j].part[w], value);
        }
        unknowns_[i].part[w] = value;
      }
    }
  }

  HWY_INLINE void subtract_penalty() {
    for (int i = 0; i < P; ++i) {
      for (int j = 0; j < P; ++j) {
        const V a = broadcast(job_.penalty[i >= j ? entry(i, j) : entry(j, i)]);
        for (int w = 0; w < kWide; ++w) {
          right_[i].part[w] = right_[i].part[w] - a * unknowns_[j].part[w];
        }
      }
    }
  }

  // What the unknowns leave of the residual. Several lights take turns, so that none waits for its own sum.
  HWY_INLINE void leave() {
    constexpr std::size_t turns = 4;
    static_assert(kLightGroup % turns == 0);
    Wide unknowns[P];
    for (int k = 0; k < P; ++k) unknowns[k] = unknowns_[k];
    for (std::size_t first = 0; first < padded_; first += turns) {
      V sums[turns][kWide];
      for (std::size_t g = 0; g < turns; ++g) {
        for (int w = 0; w < kWide; ++w) sums[g][w] = basis(first + g, 0, w) * unknowns[0].part[w];
      }
#pragma GCC unroll 16
      for (int k = 1; k < P; ++k) {
        for (std::size_t g = 0; g < turns; ++g) {
          for (int w = 0; w < kWide; ++w) {
            sums[g][w] = multiply_add(basis(first + g, k, w), unknowns[k].part[w], sums[g][w]);
          }
        }
      }
      for (std::size_t g = 0; g < turns; ++g) {
        for (int w = 0; w < kWide; ++w) {
          const std::size_t at = (first + g) * kStep + static_cast<std::size_t>(w) * V::size;
          const V m = V::load(&modulation_[at]);
          (V::load(&residual_[at]) - m * sums[g][w]).store(&left_[at]);
        }
      }
    }
  }

  HWY_NOINLINE void solve() {
    for (int k = 0; k < P; ++k) {
      for (int w = 0; w < kWide; ++w) unknowns_[k].part[w] = V(0.0);
    }
    sum_right_sides<0>(residual_);
    add_solution();
    leave();
    sum_right_sides<0>(left_);
    subtract_penalty();
    add_solution();
    leave();
    mix();
  }

  // Amplitudes as codes. What rounding one of them adds moves the best values of those that are not rounded
  // yet by their covariance with it. From the last lobe on.
  HWY_NOINLINE void round(std::size_t first, std::size_t length) {
    const RoundJob& job = *job_.round;
    if (job.texels != nullptr) find_places(first, length);
    for (int w = 0; w < kWide; ++w) {
      V goal[P];
      for (int k = 0; k < job_.lobes; ++k) goal[k] = amplitudes_[k].part[w];
      if (job.texels != nullptr) add_dither(w, goal);
      for (int k = job_.lobes - 1; k >= 0; --k) {
        const V zero = broadcast(job.zeros[k]);
        const V whole = nearest(goal[k] * broadcast(1.0F / job.steps[k])) + zero;
        const V above = select(whole > V(0.0), whole, V(0.0));
        const V stored = select(above < broadcast(job.top), above, broadcast(job.top));
        codes_[k].part[w] = stored;
        move_rest(k, w, (stored - zero) * broadcast(job.steps[k]), goal);
      }
    }
  }

  // What noise over the steps leaves when the codes next to it are taken off is spread evenly over the
  // amplitudes of like codes.
  HWY_INLINE void add_dither(int w, V* goal) const {
    V spread[P];
    V rest[P];
    for (int k = 0; k < job_.lobes; ++k) {
      spread[k] = noise(k, w) * broadcast(job_.round->steps[k]);
      rest[k] = spread[k];
    }
    for (int k = job_.lobes - 1; k >= 0; --k) {
      const V step = broadcast(job_.round->steps[k]);
      const V taken = nearest(rest[k] * broadcast(1.0F / job_.round->steps[k])) * step;
      move_rest(k, w, taken, rest);
      goal[k] = multiply_add(broadcast(job_.round->dither), spread[k] - taken, goal[k]);
    }
  }

  // Lobe k has become `to`: the best values of those before it follow.
  HWY_INLINE void move_rest(int k, int w, V to, V* goal) const {
    const V moved = to - goal[k];
    for (int j = 0; j < k; ++j) goal[j] = multiply_add(follow_[entry(k, j)].part[w], moved, goal[j]);
  }

  HWY_INLINE void mix() {
    Wide unknowns[P];
    for (int i = 0; i < P; ++i) unknowns[i] = unknowns_[i];
    for (int k = 0; k < job_.lobes; ++k) {
      const float* mix = job_.mixes + k * P;
      for (int w = 0; w < kWide; ++w) {
        V sum(0.0);
#pragma GCC unroll 16
        for (int i = 0; i < P; ++i) sum = multiply_add(broadcast(mix[i]), unknowns[i].part[w], sum);
        amplitudes_[k].part[w] = sum;
      }
    }
  }

  // Columns and rows of texels in the asset. Most follow each other, and dividing is slow.
  HWY_INLINE void find_places(std::size_t first, std::size_t length) {
    const std::uint32_t width = job_.round->asset_width;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    for (std::size_t k = 0; k < kStep; ++k) {
      const std::uint32_t texel = job_.round->texels[first + (k < length ? k : length - 1)];
      const bool follows = k > 0 && k < length && texel == job_.round->texels[first + k - 1] + 1;
      if (!follows) {
        y = texel / width;
        x = texel - y * width;
      } else if (++x == width) {
        x = 0;
        ++y;
      }
      column_[k] = x;
      row_[k] = y;
    }
  }

  // As bake::dither_threshold, in double precision: its fractions are those of large numbers.
  HWY_INLINE V noise(int lobe, int w) const {
    const hn::Rebind<float, typename D::Tag> narrow;
    alignas(64) float noise[V::size];
    for (std::size_t at = 0; at < V::size; at += D::size) {
      const std::size_t texel = static_cast<std::size_t>(w) * V::size + at;
      const D value =
          bake::interleaved_gradient_noise(D::load(column_ + texel) + D(bake::kDitherShift * lobe),
                                           D::load(row_ + texel), [](D x) { return D::of(hn::Floor(x.v)); });
      hn::StoreU(hn::DemoteTo(narrow, (value - D(0.5)).v), narrow, noise + at);
    }
    return V::load(noise);
  }

  HWY_INLINE V nearest(V x) const {
    return V::of(hn::Floor((x + V(0.5)).v));
  }

  HWY_NOINLINE void errors() {
    for (int w = 0; w < kWide; ++w) {
      V sum(0.0);
      for (std::size_t l = 0; l < job_.lights; ++l) {
        const V e = V::load(&residual_[l * kStep + static_cast<std::size_t>(w) * V::size]);
        sum = multiply_add(e, e, sum);
      }
      without_.part[w] = sum;
      with_.part[w] = V(0.0);
    }
    if (job_.leave_one_out) {
      leave_one_out();
      return;
    }
    for (int w = 0; w < kWide; ++w) {
      for (std::size_t l = 0; l < job_.lights; ++l) {
        const V r = V::load(&left_[l * kStep + static_cast<std::size_t>(w) * V::size]);
        with_.part[w] = multiply_add(r, r, with_.part[w]);
      }
    }
  }

  HWY_NOINLINE void leave_one_out() {
    for (int i = 1; i < P; ++i) {  // entries off the diagonal count twice in products with symmetric ones
      for (int j = 0; j < i; ++j) {
        for (int w = 0; w < kWide; ++w) {
          gram_[entry(i, j)].part[w] = gram_[entry(i, j)].part[w] + gram_[entry(i, j)].part[w];
        }
      }
    }
    if constexpr (kNear) return leave_one_out_near();
    constexpr int group = V::size >= 16 ? 8 : 4;
    for (std::size_t first = 0; first < padded_; first += group) {
      V hats[group][kWide];
      for (int g = 0; g < group; ++g) {
        for (int w = 0; w < kWide; ++w) hats[g][w] = V(0.0);
      }
      const float* row = job_.products + first * n;
      for (int k = 0; k < n; ++k) {
#pragma GCC unroll 8
        for (int g = 0; g < group; ++g) {
          const V b = broadcast(row[g * n + k]);
          for (int w = 0; w < kWide; ++w) hats[g][w] = multiply_add(b, gram_[k].part[w], hats[g][w]);
        }
      }
      for (int g = 0; g < group; ++g) {
        for (int w = 0; w < kWide; ++w) {
          add_left_out((first + static_cast<std::size_t>(g)) * kStep + static_cast<std::size_t>(w) * V::size,
                       hats[g][w], with_.part[w]);
        }
      }
    }
  }

  // As leave_one_out: gram_ holds the inverse, entries off the diagonal twice.
  HWY_INLINE void leave_one_out_near() {
    for (std::size_t l = 0; l < job_.lights; ++l) {
      for (int w = 0; w < kWide; ++w) {
        V hat(0.0);
        for (int i = 0; i < P; ++i) {
          V row(0.0);
          for (int j = 0; j <= i; ++j) row = multiply_add(gram_[entry(i, j)].part[w], basis(l, j, w), row);
          hat = multiply_add(row, basis(l, i, w), hat);
        }
        add_left_out(l * kStep + static_cast<std::size_t>(w) * V::size, hat, with_.part[w]);
      }
    }
  }

  // hat: a light's diagonal of the hat matrix, without its modulation.
  HWY_INLINE void add_left_out(std::size_t at, V hat, V& sum) {
    const V m = V::load(&modulation_[at]);
    const V freedom = V(1.0) - m * m * hat;
    const auto free = freedom > V(bake::kLeastFreedom);
    const V error =
        select(free, V::load(&left_[at]) / select(free, freedom, V(1.0)), V::load(&residual_[at]));
    sum = multiply_add(error, error, sum);
  }

  HWY_NOINLINE void store(std::size_t first, std::size_t length) {
    V keep[kWide];
    alignas(64) float values[kStep];
    const auto put = [&](float* plane) {
      for (std::size_t k = 0; k < length; ++k) plane[first + k] = values[k];
    };
    for (int w = 0; w < kWide; ++w) {
      const auto better = with_.part[w] < without_.part[w];
      const V divisor = select(better, without_.part[w], V(1.0));
      const V confidence = select(better, V(1.0) - with_.part[w] / divisor, V(0.0));
      confidence.store(values + static_cast<std::size_t>(w) * V::size);
      keep[w] = job_.select ? select(better, V(1.0), V(0.0)) : V(1.0);
    }
    put(job_.confidence);
    for (int k = 0; k < job_.lobes; ++k) {
      for (int w = 0; w < kWide; ++w) {
        (amplitudes_[k].part[w] * keep[w]).store(values + static_cast<std::size_t>(w) * V::size);
      }
      put(job_.amplitudes + static_cast<std::size_t>(k) * job_.stride);
      if (job_.round == nullptr) continue;
      const V zero = broadcast(job_.round->zeros[k]);
      for (int w = 0; w < kWide; ++w) {
        multiply_add(codes_[k].part[w] - zero, keep[w], zero)
            .store(values + static_cast<std::size_t>(w) * V::size);
      }
      std::uint8_t* stored = job_.round->stored + static_cast<std::size_t>(k) * job_.stride + first;
      for (std::size_t t = 0; t < length; ++t) stored[t] = static_cast<std::uint8_t>(values[t]);
    }
    for (int w = 0; w < kWide; ++w) with_.part[w].store(values + static_cast<std::size_t>(w) * V::size);
    put(job_.error_with);
    for (int w = 0; w < kWide; ++w) without_.part[w].store(values + static_cast<std::size_t>(w) * V::size);
    put(job_.error_without);
  }

  const SolveJob& job_;
  std::size_t padded_;
  float* residual_;    // [light][kStep]
  float* modulation_;  // [light][kStep]
  float* left_;        // [light][kStep]
  float* own_basis_;   // [light][P][kStep], where lights are near
  Wide gram_[n];
  Wide right_[P];
  Wide unknowns_[P];
  Wide amplitudes_[P];
  Wide follow_[n];  // where there are codes
  Wide codes_[P];
  alignas(64) double column_[kStep];  // of texels, where there is dither
  alignas(64) double row_[kStep];
  Wide with_;
  Wide without_;
};

}  // namespace

namespace {

template <int P>
void solve_by(const SolveJob& job) {
  if (job.near != nullptr) return TexelSolver<P, true>(job).run();
  TexelSolver<P, false>(job).run();
}

}  // namespace

void solve_texels(const SolveJob& job) {
  switch (job.width) {
    case 4:
      return solve_by<4>(job);
    case 8:
      return solve_by<8>(job);
    case 12:
      return solve_by<12>(job);
    default:
      return solve_by<16>(job);
  }
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
