// What a value counts by the noise of the sensor that saw it, and by saturation. Multiplies into the weights
// of a block.
#ifndef BRDFIT_BAKE_WEIGHTS_H_
#define BRDFIT_BAKE_WEIGHTS_H_

#include <limits>
#include <span>
#include <string>

#include "measured/image_stack.h"

namespace brdfit::bake {

// A camera's noise: the variance of a value v is read_deviation^2 + shot v, where v is what the sensor saw,
// that is the radiance times the picture's exposure.
struct SensorNoise {
  double read_deviation = 0.0;  // of darkness, in units of v
  double shot = 0.0;            // variance per value, in units of v: 1 / (electrons per unit of v)
  // From `knee` x saturation on values lose weight, and from saturation on they have none.
  double saturation = std::numeric_limits<double>::infinity();  // in units of v
  double knee = 0.95;

  bool is_valid(std::string* why) const;
};

// The weight of a sensor value in (0, 1] by its noise, 1 where the variance is that of darkness (of a
// hundredth of full scale where there is no read noise), times that of saturation in [0, 1]. Without noise
// parameters 1 below the knee.
double noise_weight(const SensorNoise& noise, double value);

// Multiplies the weights of all values of a block, which holds colours. The brightest channel counts.
// exposure: what radiances of each light's picture are multiplied by to be sensor values; empty: 1. A
// radiance has its sensor value's variance over the exposure squared, so weights are those of the sensor
// values times (exposure / longest exposure)^2. Throws std::invalid_argument where sizes disagree, exposures
// are not positive or the noise is invalid.
void weigh_by_noise(TexelBlock& block, const SensorNoise& noise, std::span<const double> exposure = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_WEIGHTS_H_
