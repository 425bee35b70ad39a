// Effect sets in turns, and the least time of each.
#include "gpu/timing.h"

#include <algorithm>
#include <ctime>
#include <limits>

#include "brdf/models.h"
#include "gpu/parity_pairs.h"

namespace brdfit {
namespace {

double thread_cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

struct EffectSet {
  std::string name;
  Effects effects;
};

std::vector<EffectSet> effect_sets(Model model) {
  std::vector<EffectSet> sets = {{"none", Effects()}};
  const Effects all = effects_of(model);
  if (all == Effects()) return sets;
  for (const Effect effect : all_effects()) {
    if (all.has(effect)) sets.push_back({std::string(effect_name(effect)), Effects().with(effect)});
  }
  sets.push_back({"all", all});
  return sets;
}

std::vector<FloatPair> pairs_above_horizon(std::size_t count) {
  std::vector<FloatPair> all(count * all_pair_kinds().size());
  fill_parity_pairs(1, 0, all);
  std::vector<FloatPair> pairs;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (kind_of_parity_pair(k) == PairKind::kAnywhere) pairs.push_back(all[k]);
  }
  return pairs;
}

// The same pairs in the three forms that are timed, and room for results.
struct Load {
  std::vector<FloatPair> pairs;
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  std::vector<FloatRgb> out;
  std::vector<Rgb> out_double;

  explicit Load(std::size_t count) : pairs(pairs_above_horizon(count)), out(count), out_double(count) {
    for (const FloatPair& pair : pairs) {
      wi.push_back({pair.wi[0], pair.wi[1], pair.wi[2]});
      wo.push_back({pair.wo[0], pair.wo[1], pair.wo[2]});
    }
  }
};

EffectTiming time_once(MaterialPass& pass, const Material& material, Load& load) {
  const auto per_pair = [&](double ns) { return ns / static_cast<double>(load.pairs.size()); };
  EffectTiming timing;
  const std::optional<double> device_ns = pass.eval_cos(material, load.pairs, load.out);
  if (device_ns) timing.device_ns = per_pair(*device_ns);
  const double start = thread_cpu_ns();
  eval_cos_float(material, load.pairs, load.out);
  const double between = thread_cpu_ns();
  eval_cos(material, load.wi, load.wo, load.out_double);
  timing.scalar_ns = per_pair(between - start);
  timing.vector_ns = per_pair(thread_cpu_ns() - between);
  return timing;
}

void keep_least(const EffectTiming& timing, EffectTiming& least) {
  if (timing.device_ns)
    least.device_ns = std::min(least.device_ns.value_or(*timing.device_ns), *timing.device_ns);
  least.scalar_ns = std::min(least.scalar_ns, timing.scalar_ns);
  least.vector_ns = std::min(least.vector_ns, timing.vector_ns);
}

}  // namespace

std::vector<EffectTiming> time_effects(MaterialPass& pass, const Material& material,
                                       const TimingOptions& options) {
  const std::vector<EffectSet> sets = effect_sets(material.model());
  Load load(options.pairs);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<EffectTiming> timings;
  for (const EffectSet& set : sets) timings.push_back({set.name, std::nullopt, kNone, kNone});
  for (int repeat = -1; repeat < options.repeats; ++repeat) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
      Material with_set = material;
      with_set.set_effects(sets[k].effects);
      const EffectTiming timing = time_once(pass, with_set, load);
      if (repeat >= 0) keep_least(timing, timings[k]);
    }
  }
  return timings;
}

}  // namespace brdfit
