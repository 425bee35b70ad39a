// Each hazard is named where it is, and only there.
#include "bake/solve_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lobe_data.h"

namespace brdfit::bake {
namespace {

using bake_data::cap_of_lights;
using bake_data::dome;
using bake_data::lit_texels;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> names(const LobeSet& lobes, const std::vector<Vec3>& directions,
                               const TexelProblem& problem) {
  const LobeSystem system(lobes, directions, mean_squared_modulation(problem), 0.1);
  std::vector<std::string> found;
  for (const SolveWarning& warning : solve_warnings(directions, lobes.size(), &system, problem)) {
    EXPECT_FALSE(warning.message.empty());
    found.push_back(warning.name);
  }
  return found;
}

std::vector<std::string> names(int count, const std::vector<Vec3>& directions) {
  return names(uniform_lobes(count, cap_of(directions)), directions, lit_texels(directions, 50, 0.3, 1));
}

TEST(SolveWarnings, AreNoneForADome) {
  EXPECT_THAT(names(8, dome(50)), IsEmpty());
}

TEST(SolveWarnings, NameFewLights) {
  EXPECT_THAT(names(8, dome(7)), Contains("fewer-lights-than-lobes"));
  EXPECT_THAT(names(8, dome(9)), Not(Contains("fewer-lights-than-lobes")));
}

TEST(SolveWarnings, NameNarrowLights) {
  EXPECT_THAT(names(2, cap_of_lights(12, 0.17)), ElementsAre("narrow-lights"));
  EXPECT_THAT(names(2, cap_of_lights(12, 0.45)), IsEmpty());
}

TEST(SolveWarnings, NameALightListedTwice) {
  std::vector<Vec3> directions = dome(20);
  directions.push_back(directions[4]);
  EXPECT_THAT(names(4, directions), ElementsAre("coincident-lights"));
}

TEST(SolveWarnings, NameLobesThatCoincide) {
  const std::vector<Vec3> directions = dome(50);
  LobeSet lobes = uniform_lobes(4, cap_of(directions));
  lobes.push_back(lobes[0]);
  EXPECT_THAT(names(lobes, directions, lit_texels(directions, 50, 0.3, 1)), ElementsAre("coincident-lobes"));
}

TEST(SolveWarnings, NameTexelsThatFewOrNoLightsReach) {
  const std::vector<Vec3> directions = dome(50);
  const LobeSet lobes = uniform_lobes(4, cap_of(directions));
  TexelProblem problem = lit_texels(directions, 50, 0.3, 1);
  for (std::size_t l = 3; l < 50; ++l) problem.modulation[problem.at(l, 0)] = 0.0F;
  EXPECT_THAT(names(lobes, directions, problem), ElementsAre("few-lights-per-texel"));
  for (std::size_t l = 0; l < 3; ++l) problem.modulation[problem.at(l, 0)] = 0.0F;
  EXPECT_THAT(names(lobes, directions, problem), ElementsAre("unlit-texels"));
}

TEST(SolveWarnings, NameWhatTheyCanWithoutLobes) {
  const std::vector<Vec3> directions = cap_of_lights(5, 0.17);
  std::vector<std::string> found;
  for (const SolveWarning& warning :
       solve_warnings(directions, 8, nullptr, lit_texels(directions, 50, 0.3, 1)))
    found.push_back(warning.name);
  EXPECT_THAT(found, ElementsAre("fewer-lights-than-lobes", "narrow-lights", "few-lights-per-texel"));
}

}  // namespace
}  // namespace brdfit::bake
