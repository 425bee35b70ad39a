// Models as functions of their product form (brdf/product_eval.h), at pairs of directions.
#ifndef BRDFIT_TESTS_PRODUCT_EVAL_H_
#define BRDFIT_TESTS_PRODUCT_EVAL_H_

#include "brdf/product_eval.h"
#include "tests/direction_pairs.h"

namespace brdfit::testing_support {

template <class G = double>
kernel::Geometry<G> kernel_geometry(const Pair& pair) {
  const auto as = [](double x) { return static_cast<G>(x); };
  return kernel::geometry_from_directions(as(pair.wi.x), as(pair.wi.y), as(pair.wi.z), as(pair.wo.x),
                                          as(pair.wo.y), as(pair.wo.z));
}

using brdfit::eval_coefficients;
using brdfit::eval_product;

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_PRODUCT_EVAL_H_
