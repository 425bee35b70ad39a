// Where a fit begins: points spread over the parameters' ranges, coloured by the data.
#ifndef BRDFIT_FIT_STARTS_H_
#define BRDFIT_FIT_STARTS_H_

#include <cstdint>
#include <vector>

#include "fit/parameters.h"
#include "measured/sampling.h"

namespace brdfit::fit {

// count points in the interior of the ranges, the same for the same seed. The base colour comes from the data
// (the level of the diffuse region); roughness is spread evenly in its logarithm; the other parameters follow
// a low-discrepancy sequence, away from kinks, bounds and from neutral values at which a falloff has no
// gradient. Channels of one product share one sign, which alternates from start to start.
std::vector<std::vector<double>> make_starts(const Parametrisation& parametrisation, const SampleSet& samples,
                                             int count, std::uint64_t seed);

// The order in which an artist sets the parameters (Jimenez et al. 2023, workflow): base colour, roughness
// and metallic; dual specular; retroreflection; smooth terminator; diffuse and specular Fresnel. Each stage
// lists the indices of the free numbers that it adds; stages without any are left out.
std::vector<std::vector<std::size_t>> staging(const Parametrisation& parametrisation);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_STARTS_H_
