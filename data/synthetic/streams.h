// What a recipe's seed is used for: one stream of random numbers for each.
#ifndef BRDFIT_DATA_SYNTHETIC_STREAMS_H_
#define BRDFIT_DATA_SYNTHETIC_STREAMS_H_

#include <cstdint>

namespace brdfit::synthetic {

inline constexpr std::uint64_t kMultiplicativeStream = 0;
inline constexpr std::uint64_t kAdditiveStream = 1;
inline constexpr std::uint64_t kDropStream = 2;
inline constexpr std::uint64_t kBoxStream = 3;
// Of light stacks.
inline constexpr std::uint64_t kLightStream = 4;
inline constexpr std::uint64_t kReliefStream = 5;
inline constexpr std::uint64_t kPatchStream = 6;
inline constexpr std::uint64_t kAlbedoStream = 7;
inline constexpr std::uint64_t kAmplitudeStream = 8;
inline constexpr std::uint64_t kHotStream = 9;
inline constexpr std::uint64_t kHotLightStream = 10;

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_STREAMS_H_
