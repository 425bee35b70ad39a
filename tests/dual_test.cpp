// Dual numbers over lanes: every operation's value and slopes, on every instruction set, against those that
// are written out here.
#include "tests/dual_job.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "brdf/simd/dispatch.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void run_dual(DualJob&))

namespace {

// Value, slope by x, slope by y.
using Expected = std::array<double, 3>;
using Operation = std::function<Expected(double, double)>;

// In the order of dual_simd.cpp.
const std::array<Operation, kDualOperations> kOperations = {
    [](double x, double y) {
      return Expected{x + y, 1, 1};
    },
    [](double x, double y) {
      return Expected{x - y, 1, -1};
    },
    [](double x, double y) {
      return Expected{x * y, y, x};
    },
    [](double x, double y) {
      return Expected{x / y, 1 / y, -x / (y * y)};
    },
    [](double x, double y) {
      return Expected{x + y, 1, 0};
    },
    [](double x, double y) {
      return Expected{x + y, 0, 1};
    },
    [](double x, double y) {
      return Expected{x - y, 1, 0};
    },
    [](double x, double y) {
      return Expected{x * y, y, 0};
    },
    [](double x, double y) {
      return Expected{x * y, 0, x};
    },
    [](double x, double y) {
      return Expected{x / y, 0, -x / (y * y)};
    },
    [](double x, double y) {
      return x > y ? Expected{x, 1, 0} : Expected{y, 0, 1};
    },
    [](double x, double y) {
      return x < y ? Expected{x, 1, 0} : Expected{y, 0, 1};
    },
    [](double x, double y) {
      const double root = std::sqrt(x * y);
      return Expected{root, 0.5 * y / root, 0.5 * x / root};
    },
    [](double x, double y) {
      const double e = std::exp(x - y);
      return Expected{e, e, -e};
    },
    [](double x, double y) {
      return Expected{std::log(x * x * y), 2 / x, 1 / y};
    },
    [](double x, double y) {
      return Expected{3 * x / (y + x), 3 * y / ((y + x) * (y + x)), 0};
    },
};

TEST(Dual, OperationsHaveTheirValuesAndSlopes) {
  const auto job = std::make_unique<DualJob>();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> magnitude(-3.0, 3.0);
  for (std::size_t k = 0; k < kDualCount; ++k) {
    job->x[k] = std::exp(magnitude(random));
    job->y[k] = std::exp(magnitude(random));
  }
  for (const Isa isa : available_isas()) {
    BRDFIT_PICK(isa, run_dual)(*job);
    for (std::size_t operation = 0; operation < kDualOperations; ++operation) {
      for (std::size_t k = 0; k < kDualCount; ++k) {
        const Expected expected = kOperations[operation](job->x[k], job->y[k]);
        const auto near = [&](double actual, double value) {
          EXPECT_NEAR(actual, value, 1e-13 * (std::abs(value) + 1e-3))
              << "operation " << operation << " on " << name_of(isa) << " at " << job->x[k] << ", "
              << job->y[k];
        };
        near(job->value[operation][k], expected[0]);
        near(job->slope[0][operation][k], expected[1]);
        near(job->slope[1][operation][k], expected[2]);
      }
    }
  }
}

}  // namespace
}  // namespace brdfit::simd
