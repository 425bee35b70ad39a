// The small descent against Ceres.
#include "fit/descent.h"

#include <gmock/gmock.h>

#include "fit/starts.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::OwnedProblem;

class Descent : public testing::TestWithParam<Model> {
 protected:
  const Effects effects_ = effects_of(GetParam()).without(Effect::kAnisotropic);
  const MeasuredTable table_ =
      testing_support::table_of(testing_support::random_full_material(GetParam(), effects_, 11));
  const OwnedProblem owned_{table_, Material(GetParam()), {Tier::kFull, effects_, {}}, Loss::kLogRatio, 800};
  const Box box_ = full_box(owned_.parametrisation);
};

TEST_P(Descent, EndsInTheBoxNoHigherThanItBegan) {
  for (const auto& x : make_starts(owned_.parametrisation, owned_.samples, 12, 3)) {
    for (const int evaluations : {1, 2, 5, 30}) {
      const Solution end = descend(owned_.problem, x, box_, {evaluations, 1e-6});
      EXPECT_LE(end.evaluations, evaluations);
      EXPECT_LE(end.cost, owned_.problem.cost(x) * (1.0 + 1e-12));
      EXPECT_NEAR(end.cost, owned_.problem.cost(end.x), 1e-9 * end.cost);
      for (std::size_t k = 0; k < x.size(); ++k) {
        EXPECT_GE(end.x[k], box_.lower[k]);
        EXPECT_LE(end.x[k], box_.upper[k]);
      }
    }
  }
}

TEST_P(Descent, ConvergesWhereCeresDoes) {
  for (const auto& x : make_starts(owned_.parametrisation, owned_.samples, 8, 5)) {
    const Solution end = descend(owned_.problem, x, box_, {500, 1e-10});
    const Solution ceres = solve_pinning(owned_.problem, end.x, box_, {});
    // Ceres finds next to nothing left to do.
    EXPECT_LE(end.cost, ceres.cost * 1.001 + 1e-14);
  }
}

TEST_P(Descent, LeavesWhatIsHeldAlone) {
  Box box = box_;
  for (std::size_t k = 0; k < box.moves.size(); k += 2) box.moves[k] = false;
  const auto x = make_starts(owned_.parametrisation, owned_.samples, 1, 3).front();
  const Solution end = descend(owned_.problem, x, box, {30, 1e-6});
  EXPECT_LT(end.cost, owned_.problem.cost(x));
  for (std::size_t k = 0; k < x.size(); k += 2) EXPECT_EQ(end.x[k], x[k]);
}

INSTANTIATE_TEST_SUITE_P(Models, Descent, testing::ValuesIn(all_models().begin(), all_models().end()),
                         [](const auto& model) {
                           std::string name(name_of(model.param));
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace brdfit::fit
