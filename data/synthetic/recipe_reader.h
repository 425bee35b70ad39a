// What recipes of tables and of stacks read alike.
#ifndef BRDFIT_DATA_SYNTHETIC_RECIPE_READER_H_
#define BRDFIT_DATA_SYNTHETIC_RECIPE_READER_H_

#include <cstdint>

#include "data/synthetic/recipe.h"
#include "io/json.h"

namespace brdfit::synthetic {

inline constexpr double kMaxMultiplicativeNoise = 1.0;
inline constexpr double kMaxAdditiveNoise = 1000.0;

// {"multiplicative", "additive"}, each at its default where absent.
Noise read_noise(io::ObjectReader reader);

// Member "seed": all 64 bits, which ObjectReader::integer does not span.
std::uint64_t read_seed(io::ObjectReader& reader, std::uint64_t fallback);

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_RECIPE_READER_H_
