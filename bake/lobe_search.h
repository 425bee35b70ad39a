// The search for a set of lobes: axes, sharpnesses and cut-offs that leave the least error.
//
// Training error is a bad guide (more and sharper lobes always train better), so it is the leave-one-out
// error that is minimised, in the closed form of bake/lobe_objective.h, by Ceres' L-BFGS with exact
// derivatives. Amplitudes never appear: for any lobes their best values are known.
#ifndef BRDFIT_BAKE_LOBE_SEARCH_H_
#define BRDFIT_BAKE_LOBE_SEARCH_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/lobes.h"
#include "bake/residual_classes.h"

namespace brdfit::bake {

struct LobeSearchOptions {
  int iterations = 120;
  int cluster_starts = 2;
  std::uint64_t seed = 1;
  // Lobes to start from in place of all other starts; empty: none.
  LobeSet start;
  double start_ridge = 1.0;
};

struct LobeSearchResult {
  LobeSet lobes;
  double ridge = 0.0;
  double objective = 0.0;        // as LobeObjective: about the share of the squared error that stays
  double start_objective = 0.0;  // of the best uniform set
  LobeSet uniform;               // that set
  std::string start;             // which start led here: "uniform", "clusters" or "given"
  bool converged = false;        // by Ceres' own test
  int evaluations = 0;
};

// Uniform sets over the lights' cap differ by how far lobes overlap: the one whose objective, at its best
// ridge of a coarse grid, is least.
LobeSearchResult best_uniform(std::span<const ResidualClass> classes, std::span<const Vec3> directions,
                              int count);

// Starts from the best uniform set and from clusters of where the residual's energy lies; the best end wins.
// Parallel over starts; the same for any number of threads. Without classes (no residual): the uniform set.
LobeSearchResult search_lobes(std::span<const ResidualClass> classes, std::span<const Vec3> directions,
                              int count, const LobeSearchOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LOBE_SEARCH_H_
