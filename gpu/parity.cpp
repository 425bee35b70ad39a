// Walks pairs in parts and tallies errors.
#include "gpu/parity.h"

#include <algorithm>
#include <vector>

#include "gpu/parity_pairs.h"

namespace brdfit {
namespace {

constexpr std::uint64_t kPart = std::uint64_t{1} << 18;

void tally(std::span<const FloatPair> pairs, std::span<const Rgb> reference, std::span<const FloatRgb> values,
           Comparison& to) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const TalliedError error = to.errors.add(reference[k][c], values[k][c]);
      if (error.worst) {
        to.worst = {pairs[k], static_cast<int>(c), reference[k][c], values[k][c], error.share};
      }
    }
  }
}

void compare(const Material& material, const FloatEval& device, std::span<const FloatPair> pairs,
             ParityReport& report) {
  std::vector<Rgb> reference(pairs.size());
  std::vector<FloatRgb> values(pairs.size());
  eval_cos_reference(material, pairs, reference);
  device(pairs, values);
  tally(pairs, reference, values, report.device);
  eval_cos_float(material, pairs, values);
  tally(pairs, reference, values, report.processor);
  report.pairs += pairs.size();
}

}  // namespace

ErrorThreshold parity_threshold(const Material& material) {
  const double roughness = material.number("roughness");
  ErrorThreshold threshold;
  threshold.relative = 1e-5 + 4e-7 / (roughness * roughness);
  return threshold;
}

ParityReport check_parity(const Material& material, const FloatEval& device, const ParityOptions& options) {
  ParityReport report(parity_threshold(material));
  std::vector<FloatPair> pairs(std::min(kPart, options.pairs));
  for (std::uint64_t first = 0; first < options.pairs; first += pairs.size()) {
    const std::uint64_t count = std::min<std::uint64_t>(pairs.size(), options.pairs - first);
    const std::span<FloatPair> part = std::span(pairs).first(count);
    fill_parity_pairs(options.seed, first, part);
    compare(material, device, part, report);
  }
  return report;
}

ParityReport check_parity(const Material& material, const FloatEval& device,
                          std::span<const FloatPair> pairs) {
  ParityReport report(parity_threshold(material));
  compare(material, device, pairs, report);
  return report;
}

}  // namespace brdfit
