// Walks the hard cases of the kernels with one scalar type, or one device.
#ifndef BRDFIT_TESTS_STABILITY_WALK_H_
#define BRDFIT_TESTS_STABILITY_WALK_H_

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "tests/stability_cases.h"

namespace brdfit::stability {

struct Walker {
  std::string name;
  // In single precision directions and parameters are rounded to float first, and the kernels in double on
  // these are the reference; otherwise the published formulas in extended precision are.
  bool is_single = false;
  // f cos_i of each pair.
  std::function<void(const Material&, std::span<const testing_support::Pair>, std::span<Rgb>)> evaluate;
  // How far a value may be from its reference, given the size of what is added up to give it.
  std::function<double(const Material&, double reference, double magnitude)> allowed;
};

// In double, one pair at a time, and as vector code.
Walker double_walker();
Walker float_walker();
// The value of Jets.
Walker jet_walker();

// Every value of every case: finite, not negative, close to its reference, dark where it must be; and
// reciprocal where the model is. Prints how many cases and values were walked.
void walk_kernel_cases(const Walker& walker);

// Every branch from both sides.
void walk_branches(const Walker& walker);

// The line of a summary.
void print_walked(std::string_view who, std::size_t cases, std::string_view of, std::size_t values);

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_WALK_H_
