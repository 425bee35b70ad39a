// What solving costs per texel, in CPU time and as ratios: all contenders take turns in one run, and a figure
// is the median over the turns.
//
//   bake_bench [turns [lights]]
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "bake/lobes.h"
#include "bake/solve.h"

namespace {

using namespace brdfit;
using namespace brdfit::bake;

// Sixteen rows of a 2048 x 2048 picture.
constexpr std::size_t kTexels = 16 * 2048;
constexpr std::size_t kFewTexels = 1024;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::vector<Vec3> dome(int lights) {
  std::vector<Vec3> directions;
  const Cap cap = {{0.0, 0.0, 1.0}, 1.3};
  for (int l = 0; l < lights; ++l) {
    // Lobes' axes are spread as lights are; sets end at kMaxLobes, so rings are turned against each other.
    const LobeSet ring = uniform_lobes(kMaxLobes, cap);
    const Vec3 a = ring[static_cast<std::size_t>(l % kMaxLobes)].axis;
    const double turn = 0.37 * (l / kMaxLobes);
    directions.push_back(
        {a.x * std::cos(turn) - a.y * std::sin(turn), a.x * std::sin(turn) + a.y * std::cos(turn), a.z});
  }
  return directions;
}

TexelProblem random_problem(std::size_t lights) {
  TexelProblem problem;
  problem.lights = lights;
  problem.texels = kTexels;
  problem.residual.resize(lights * kTexels);
  problem.modulation.resize(lights * kTexels);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  for (float& r : problem.residual) r = 0.2F * uniform(random) - 0.1F;
  for (float& m : problem.modulation) m = uniform(random);
  return problem;
}

struct Contender {
  std::string name;
  std::function<void()> run;
  std::vector<double> ns_per_texel;
  std::size_t texels = kTexels;
};

std::vector<std::size_t> few_texels() {
  std::vector<std::size_t> texels;
  for (std::size_t i = 0; i < kFewTexels; ++i) texels.push_back(i);
  return texels;
}

}  // namespace

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::atoi(argv[1]) : 11;
  const int lights = argc > 2 ? std::atoi(argv[2]) : 50;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<Vec3> directions = dome(lights);
  const TexelProblem problem = random_problem(directions.size());
  const std::vector<double> squared = mean_squared_modulation(problem);
  float sink = 0.0F;

  std::vector<Contender> contenders;
  contenders.push_back({"reading the planes alone",
                        [&] {
                          for (const float m : problem.modulation) sink += m;
                          for (const float r : problem.residual) sink += r;
                        },
                        {},
                        kTexels});
  std::vector<LobeSystem> systems;
  for (const int count : {4, 8, 16}) {
    systems.emplace_back(uniform_lobes(count, cap_of(directions)), directions, squared, 0.01);
  }
  const auto add = [&](const LobeSystem& system, simd::Isa isa, bool leave_one_out) {
    SolveOptions options;
    options.isa = isa;
    options.leave_one_out = leave_one_out;
    std::string name = std::to_string(system.lobes().size()) + " lobes, ";
    name += simd::name_of(isa);
    name += leave_one_out ? ", leave one out" : ", training error";
    contenders.push_back(
        {name, [&, options] { sink += solve(system, problem, options).confidence[0]; }, {}, kTexels});
  };
  for (const LobeSystem& system : systems) {
    add(system, simd::best_isa(), true);
    add(system, simd::best_isa(), false);
  }
  for (const simd::Isa isa : simd::available_isas()) {
    if (isa != simd::best_isa()) add(systems[1], isa, true);
  }

  // Near lights: each texel has directions of its own. Few texels, as many of these are slow.
  TexelProblem near = with_texels(problem, few_texels());
  near.directions.resize(3 * near.residual.size());
  for (std::size_t l = 0; l < near.lights; ++l) {
    for (std::size_t i = 0; i < near.texels; ++i) {
      float* plane = near.directions.data() + l * 3 * near.texels + i;
      plane[0] = static_cast<float>(directions[l].x);
      plane[near.texels] = static_cast<float>(directions[l].y);
      plane[2 * near.texels] = static_cast<float>(directions[l].z);
    }
  }
  contenders.push_back({"8 lobes, near lights, leave one out",
                        [&] { sink += solve(systems[1], near).confidence[0]; },
                        {},
                        kFewTexels});

  for (int turn = 0; turn <= turns; ++turn) {
    for (Contender& contender : contenders) {
      const double start = cpu_seconds();
      contender.run();
      if (turn > 0)
        contender.ns_per_texel.push_back(1e9 * (cpu_seconds() - start) /
                                         static_cast<double>(contender.texels));
    }
  }
  std::printf("%d lights, CPU time of one thread, median of %d turns\n", lights, turns);
  const double floor = median(contenders.front().ns_per_texel);
  for (const Contender& contender : contenders) {
    const double ns = median(contender.ns_per_texel);
    std::printf("%-40s %8.1f ns per texel  %6.2f x reading  %6.2f s for 2048 x 2048\n",
                contender.name.c_str(), ns, ns / floor, ns * 2048.0 * 2048.0 * 1e-9);
  }
  return sink == 12345.0F ? 1 : 0;  // so that nothing is optimised away
}
