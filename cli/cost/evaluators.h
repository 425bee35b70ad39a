// The ways in which a material is evaluated at run time: number type and device.
#ifndef BRDFIT_CLI_COST_EVALUATORS_H_
#define BRDFIT_CLI_COST_EVALUATORS_H_

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "brdf/vec3.h"
#include "measured/table.h"

namespace brdfit::cli {

// Unit directions, local frame, z = normal, pointing away from the surface; both of equal length.
struct DirectionPairs {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;

  std::size_t size() const { return wi.size(); }
};

// Pairs anywhere above the horizon, even over the hemisphere; the same on every machine.
DirectionPairs pairs_to_time(std::size_t count);

struct Evaluator {
  std::string scalar;  // "double", "float"
  std::string device;  // "processor", "processor, AVX-512", "Vulkan: NAME"
  // f cos_i of each pair, in sr^-1. Returns nanoseconds that all of them took: CPU time of one thread, or of
  // all of a Vulkan device by its own clock; NaN where that has none. What prepares the input is not counted.
  std::function<double(const Material&, const DirectionPairs&, std::span<Rgb> out)> eval_cos;
};

struct Evaluators {
  std::vector<Evaluator> all;      // the first is vector code in double, by which points are compared
  std::vector<std::string> notes;  // what there is not, and why
};

// Those of this build and machine. device: as DeviceRequest::device; where it is empty and there is none, a
// note says so. Throws GpuError (a std::runtime_error) for a named device that there is not.
Evaluators run_time_evaluators(const std::string& device);

// Adds those that need the gpu room: float on the processor and a Vulkan device; or a note. Two files define
// it.
void add_gpu_evaluators(const std::string& device, Evaluators& evaluators);

// Nanoseconds per pair.
double time_evaluation(const Evaluator& evaluator, const Material& material, const DirectionPairs& pairs);

// The material as a table on the grid of another, at the cells that are valid there, through an evaluator:
// each cell the mean of f(wi, wo) and f(wo, wi).
MeasuredTable table_by(const Evaluator& evaluator, const Material& material, const MeasuredTable& reference);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_EVALUATORS_H_
