// What the effects of a material cost on a device and on the processor.
#ifndef BRDFIT_GPU_TIMING_H_
#define BRDFIT_GPU_TIMING_H_

#include <optional>
#include <string>
#include <vector>

#include "gpu/material_pass.h"

namespace brdfit {

// Nanoseconds per pair of directions, three channels, for one set of effects.
struct EffectTiming {
  std::string name;                 // "none", the name of the one effect that is on, or "all"
  std::optional<double> device_ns;  // by the device's clock, all of the device at work; null if it has none
  double scalar_ns = 0.0;           // one thread, one pair after another, in single precision
  double vector_ns = 0.0;           // one thread, vector code, in double
};

struct TimingOptions {
  std::size_t pairs = std::size_t{1} << 16;
  int repeats = 25;
};

// Times the material without effects, with each of its model's effects alone, and with all of them: the same
// parameters, the same pairs (anywhere above the horizon), in turns, each timed `repeats` times after one run
// that does not count. The least of them is taken, as other work on a machine only adds; the processor's are
// CPU time. Throws as MaterialPass::eval_cos.
std::vector<EffectTiming> time_effects(MaterialPass& pass, const Material& material,
                                       const TimingOptions& options = {});

}  // namespace brdfit

#endif  // BRDFIT_GPU_TIMING_H_
