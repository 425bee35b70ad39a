// Whether a device computes what the processor computes.
#ifndef BRDFIT_GPU_PARITY_H_
#define BRDFIT_GPU_PARITY_H_

#include <cstdint>
#include <functional>

#include "gpu/error_tally.h"
#include "gpu/float_material.h"

namespace brdfit {

// The threshold of a material: relative error 1e-5 + 4e-7 / alpha where f cos_i > 1e-4, absolute error 1e-6
// elsewhere, with alpha = roughness^2.
ErrorThreshold parity_threshold(const Material& material);

// Where an error is largest.
struct WorstPair {
  FloatPair pair;
  int channel = 0;         // of f cos_i
  double reference = 0.0;  // in double
  float value = 0.0F;
  double share = 0.0;  // error over what is allowed
};

// Values in single precision against the reference in double.
struct Comparison {
  explicit Comparison(const ErrorThreshold& threshold) : errors(threshold) {}
  ErrorTally errors;
  WorstPair worst;
};

// f cos_i of pairs in single precision, by whatever is on trial.
using FloatEval = std::function<void(std::span<const FloatPair> pairs, std::span<FloatRgb> out)>;

struct ParityOptions {
  std::uint64_t pairs = 2'000'000;
  std::uint64_t seed = 1;
};

struct ParityReport {
  explicit ParityReport(const ErrorThreshold& t) : threshold(t), device(t), processor(t) {}
  ErrorThreshold threshold;
  std::uint64_t pairs = 0;
  Comparison device;     // what was on trial
  Comparison processor;  // the kernels in single precision on the processor
  bool passed() const { return device.errors.over() == 0; }
};

// Compares on the pairs of fill_parity_pairs(). The reference is the kernels in double on the float-rounded
// pairs and parameters. Passes on what `device` throws.
ParityReport check_parity(const Material& material, const FloatEval& device, const ParityOptions& options);

// The same on given pairs.
ParityReport check_parity(const Material& material, const FloatEval& device,
                          std::span<const FloatPair> pairs);

}  // namespace brdfit

#endif  // BRDFIT_GPU_PARITY_H_
