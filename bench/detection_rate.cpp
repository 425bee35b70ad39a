// How often the choice of effects finds a group, by how strong it is: a table on standard output and a
// picture.
//
//   detection_rate PICTURE.svg [trials per group] > TABLE.csv
//
// The same on every run. Shares have 95% intervals by Wilson (1927).
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "bench/detection_picture.h"
#include "bench/detection_trials.h"

namespace {

using namespace brdfit;
using bench::Share;
using bench::Trial;

constexpr int kTrialsPerGroup = 24;

// Of one group there are few trials: wide ranges of strength.
const std::vector<double> kWideEdges = {bench::kLeastStrength, 0.5, 1.0, 3.0, bench::kMostStrength};

std::vector<double> narrow_edges() {
  constexpr int kBins = 6;
  std::vector<double> edges;
  for (int k = 0; k <= kBins; ++k) {
    edges.push_back(bench::kLeastStrength *
                    std::pow(bench::kMostStrength / bench::kLeastStrength, k / double{kBins}));
  }
  return edges;
}

std::vector<Trial> run_trials(int per_group) {
  std::vector<Trial> trials;
  for (const Model model : {Model::kCallisto, Model::kBurley}) {
    for (std::size_t group = 0; group < fit::groups_of(model).size(); ++group) {
      trials.insert(trials.end(), static_cast<std::size_t>(per_group), {model, group, 0.0, {}, {}});
    }
  }
  std::atomic<std::size_t> done = 0;
  tbb::parallel_for(std::size_t{0}, trials.size(), [&](std::size_t k) {
    trials[k] = bench::run_trial(trials[k].model, trials[k].group, 5000 + k);
    fmt::print(stderr, "\r{} of {}", ++done, trials.size());
  });
  fmt::print(stderr, "\n");
  return trials;
}

bool is_refinement(const Trial& trial) {
  return fit::groups_of(trial.model)[trial.group].refines;
}

// By ranges of strength, of the trials for which `counts` holds.
template <class Counts>
std::vector<Share> detected(const std::vector<Trial>& trials, const std::vector<double>& edges,
                            const Counts& counts) {
  std::vector<Share> bins;
  for (std::size_t bin = 0; bin + 1 < edges.size(); ++bin) {
    Share share = {edges[bin], edges[bin + 1]};
    for (const Trial& trial : trials) {
      if (!counts(trial) || !(trial.strength >= share.from && trial.strength < share.to)) continue;
      ++share.n;
      if (trial.chosen.has(trial.group)) ++share.found;
    }
    bins.push_back(share);
  }
  return bins;
}

// Of the trials whose material lacks the group and could have it: a refinement needs its effect.
Share falsely_found(const std::vector<Trial>& trials, Model model, std::size_t group) {
  const fit::Group& info = fit::groups_of(model)[group];
  Share share;
  for (const Trial& trial : trials) {
    if (!trial.is_in_range() || trial.model != model || trial.truth.has(group)) continue;
    if (info.refines && !fit::effects_of_groups(model, trial.truth).has(info.effect)) continue;
    ++share.n;
    if (trial.chosen.has(group)) ++share.found;
  }
  return share;
}

void print_row(std::string_view kind, std::string_view model, std::string_view group, const Share& share) {
  const bool has_range = share.to > 0.0;
  fmt::print("{},{},{},{},{},{},{},{:.3f},{:.3f},{:.3f}\n", kind, model, group,
             has_range ? fmt::format("{:.3f}", share.from) : "",
             has_range ? fmt::format("{:.3f}", share.to) : "", share.n, share.found, share.share(),
             share.lower(), share.upper());
}

void print_table(const std::vector<Trial>& trials, const std::vector<bench::Curve>& curves) {
  fmt::print("kind,model,group,strength_from,strength_to,n,found,share,lower95,upper95\n");
  for (const bench::Curve& curve : curves) {
    for (const Share& share : curve.bins) print_row("detection", "all", curve.name, share);
  }
  for (const Model model : {Model::kCallisto, Model::kBurley}) {
    for (std::size_t group = 0; group < fit::groups_of(model).size(); ++group) {
      const std::string_view name = fit::groups_of(model)[group].name;
      for (const Share& share : detected(trials, kWideEdges, [&](const Trial& trial) {
             return trial.model == model && trial.group == group;
           })) {
        print_row("detection", brdfit::name_of(model), name, share);
      }
    }
  }
  for (const Model model : {Model::kCallisto, Model::kBurley}) {
    Share effects;
    Share refinements;
    for (std::size_t group = 0; group < fit::groups_of(model).size(); ++group) {
      const fit::Group& info = fit::groups_of(model)[group];
      const Share share = falsely_found(trials, model, group);
      print_row("false positive", brdfit::name_of(model), info.name, share);
      Share& sum = info.refines ? refinements : effects;
      sum.n += share.n;
      sum.found += share.found;
    }
    print_row("false positive", brdfit::name_of(model), "all effects", effects);
    print_row("false positive", brdfit::name_of(model), "all refinements", refinements);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: detection_rate PICTURE.svg [trials per group] > TABLE.csv\n");
    return 2;
  }
  const int per_group = argc > 2 ? std::atoi(argv[2]) : kTrialsPerGroup;
  const std::vector<Trial> trials = run_trials(per_group);
  const auto effects_of_model = [](Model model) {
    return [model](const Trial& trial) { return trial.model == model && !is_refinement(trial); };
  };
  const std::vector<bench::Curve> curves = {
      {"effects of Callisto", detected(trials, narrow_edges(), effects_of_model(Model::kCallisto))},
      {"effects of Burley", detected(trials, narrow_edges(), effects_of_model(Model::kBurley))},
      {"refinements", detected(trials, narrow_edges(), is_refinement)}};
  print_table(trials, curves);
  std::ofstream picture(argv[1]);
  picture << bench::detection_picture(curves);
  picture.close();
  if (!picture) {
    fmt::print(stderr, "detection_rate: {} cannot be written\n", argv[1]);
    return 1;
  }
  return 0;
}
