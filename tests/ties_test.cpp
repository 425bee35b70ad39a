// Ties that show only when numbers at bounds may move back.
#include "fit/ties.h"

#include <gmock/gmock.h>

#include "fit/parameters.h"

namespace brdfit::fit {
namespace {

// Lambert + GGX with metallic and specular free, both in [0, 1].
Parametrisation two_numbers() {
  return make_parametrisation(Material(), {Tier::kFull, {}, {{"base_color", {0.5}}, {"roughness", {0.5}}}});
}

// Of the columns (first, 0, 0) and (second, apart, 0), and of a residual.
Eigen::MatrixXd gram_of(double first, double second, double apart) {
  Eigen::MatrixXd jacobian(3, 3);
  jacobian << first, second, 0.1, 0.0, apart, 0.1, 0.0, 0.0, 0.1;
  return jacobian.transpose() * jacobian;
}

std::vector<Status> statuses(const std::vector<double>& x, const Eigen::MatrixXd& gram,
                             const std::vector<bool>& held = {}) {
  const Parametrisation parametrisation = two_numbers();
  Identifiability result = identify(parametrisation, x, gram, held);
  add_hidden_ties(parametrisation, x, full_box(parametrisation), gram, held, result);
  EXPECT_TRUE(result.unseen.allFinite());
  return result.status;
}

using testing::Each;
using testing::ElementsAre;

TEST(HiddenTies, AreFoundWhereTheWayBackFromABoundCostsNothing) {
  // One up, the other down.
  const Eigen::MatrixXd same = gram_of(1.0, 1.0, 0.0);
  EXPECT_THAT(statuses({0.0, 0.5}, same), Each(Status::kUnidentifiable));
  EXPECT_THAT(statuses({0.5, 1.0}, same), Each(Status::kUnidentifiable));
  EXPECT_THAT(statuses({0.0, 1.0}, same), Each(Status::kUnidentifiable));
  // Both up, or both down.
  EXPECT_THAT(statuses({0.0, 0.0}, gram_of(1.0, -1.0, 0.0)), Each(Status::kUnidentifiable));
}

TEST(HiddenTies, AreNoneWhereBoundsBlockBothWays) {
  EXPECT_THAT(statuses({0.0, 1.0}, gram_of(1.0, -1.0, 0.0)),
              ElementsAre(Status::kAtLowerBound, Status::kAtUpperBound));
  EXPECT_THAT(statuses({0.0, 0.0}, gram_of(1.0, 1.0, 0.0)), Each(Status::kAtLowerBound));
}

TEST(HiddenTies, AreNoneBetweenWhatTheSamplesTellApart) {
  for (const double apart : {0.01, 1.0}) {
    EXPECT_THAT(statuses({0.0, 0.5}, gram_of(1.0, 1.0, apart)),
                ElementsAre(Status::kAtLowerBound, Status::kOk));
  }
}

TEST(HiddenTies, AreNoneWithWhatIsHeld) {
  EXPECT_THAT(statuses({0.0, 0.5}, gram_of(1.0, 1.0, 0.0), {true, false}),
              ElementsAre(Status::kFixed, Status::kOk));
}

// A number that changes nothing is unidentifiable by itself and ties nothing.
TEST(HiddenTies, AreNoneWithWhatChangesNothing) {
  EXPECT_THAT(statuses({0.0, 0.5}, gram_of(0.0, 1.0, 0.0)),
              ElementsAre(Status::kUnidentifiable, Status::kOk));
}

}  // namespace
}  // namespace brdfit::fit
