// Folds over lights: plan, bake, predict, tally.
#include "bake/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bake/baselines.h"
#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

// Above this many lights, leaving each out by itself costs too much.
constexpr std::size_t kMostSingleFolds = 24;
constexpr std::size_t kLightsPerFold = 10;

// Lights to predict, with what is known of them.
struct Targets {
  LightChoice lights;
  StackInfo info;
  TexelBlock block;
};

Targets targets_of(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
                   LightChoice lights) {
  Targets targets;
  targets.info = with_lights(with_gains(info, plan.gains), lights);
  targets.block = with_lights(sample, lights);
  targets.lights = std::move(lights);
  return targets;
}

// Squares of errors, per light.
class Tally {
 public:
  explicit Tally(std::size_t lights) : sum_(lights), count_(lights) {}

  MethodSums sums(std::string name) const { return {std::move(name), sum_, count_, lit_sum_, lit_count_}; }

  void add(const MethodSums& sums) {
    for (std::size_t light = 0; light < sum_.size(); ++light) {
      sum_[light] += sums.squares.at(light);
      count_[light] += sums.counts.at(light);
    }
    lit_sum_ += sums.lit_squares;
    lit_count_ += sums.lit_count;
  }

  void add(const Targets& targets, const TexelProblem& problem, std::span<const float> shade,
           std::span<const float> errors) {
    for (std::size_t t = 0; t < targets.lights.size(); ++t) {
      for (std::size_t k = 0; k < problem.texels; ++k) {
        const std::size_t at = problem.at(t, k);
        if (problem.weight_of(t, k) == 0.0F) continue;
        const double squared = std::pow(static_cast<double>(errors[at]), 2);
        sum_[targets.lights[t]] += squared;
        count_[targets.lights[t]] += 1.0;
        if (shade[at] > 0.0F) {
          lit_sum_ += squared;
          lit_count_ += 1.0;
        }
      }
    }
  }

  StackErrors errors() const {
    StackErrors out;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t light = 0; light < sum_.size(); ++light) {
      sum += sum_[light];
      count += count_[light];
      const double rmse = root_mean(sum_[light], count_[light]);
      out.per_light_255.push_back(rmse);
      if (rmse > out.worst_light_rmse_255) {
        out.worst_light_rmse_255 = rmse;
        out.worst_light = light;
      }
    }
    out.rmse_255 = root_mean(sum, count);
    out.lit_rmse_255 = root_mean(lit_sum_, lit_count_);
    // Without any error a peak's ratio to it has no number: as that of the smallest error a float can show.
    out.psnr_db = 20.0 * std::log10(255.0 / std::max(out.rmse_255, 255.0 * 0x1p-24));
    return out;
  }

 private:
  static double root_mean(double sum, double count) {
    return count > 0.0 ? 255.0 * std::sqrt(sum / count) : 0.0;
  }

  std::vector<double> sum_;
  std::vector<double> count_;
  double lit_sum_ = 0.0;
  double lit_count_ = 0.0;
};

// The methods of one evaluation, in the order in which they were first met.
class Tallies {
 public:
  explicit Tallies(std::size_t lights) : lights_(lights) {}
  Tally& operator[](const MethodEvidence& method) {
    const auto found = place_.find(method.name);
    if (found != place_.end()) return tallies_[found->second];
    place_[method.name] = tallies_.size();
    methods_.push_back(method);
    tallies_.emplace_back(lights_);
    return tallies_.back();
  }
  const std::vector<MethodEvidence>& methods() const { return methods_; }
  std::vector<MethodSums> sums() const {
    std::vector<MethodSums> out;
    for (std::size_t k = 0; k < methods_.size(); ++k) out.push_back(tallies_[k].sums(methods_[k].name));
    return out;
  }
  const Tally* find(const std::string& name) const {
    const auto found = place_.find(name);
    return found == place_.end() ? nullptr : &tallies_[found->second];
  }

 private:
  std::size_t lights_;
  std::map<std::string, std::size_t> place_;
  std::vector<MethodEvidence> methods_;
  std::vector<Tally> tallies_;
};

MethodEvidence method(std::string name) {
  MethodEvidence out;
  out.name = std::move(name);
  return out;
}

MethodEvidence realis_method(const RealisKind& kind) {
  MethodEvidence out = method(kind.name);
  out.lobes = kind.lobes;
  out.dominant = kind.options.dominant;
  out.bits = kind.options.bits;
  out.bytes_per_texel = kind.bytes_per_texel();
  return out;
}

std::vector<float> luminances(const TexelBlock& block) {
  std::vector<float> out(block.lights * block.count());
  for (std::size_t light = 0; light < block.lights; ++light) {
    for (std::size_t k = 0; k < block.count(); ++k) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        sum += kLuminance[c] * static_cast<double>(block.plane(light, c)[k]);
      out[light * block.count() + k] = static_cast<float>(sum);
    }
  }
  return out;
}

std::vector<float> difference(std::span<const float> a, std::span<const float> b) {
  std::vector<float> out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = a[k] - b[k];
  return out;
}

// What a plan predicts of some lights.
class Predictor {
 public:
  Predictor(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
            const BakeSettings& settings, const EvidenceOptions& options, Tallies& tallies)
      : info_(info), sample_(sample), plan_(plan), settings_(settings), options_(options), tallies_(tallies) {
    settings_.colour = RealisColour::kLuminance;
    baked_ = bake_block(info, sample, plan, settings_);
  }

  void predict(const LightChoice& lights) {
    const Targets targets = targets_of(info_, sample_, plan_, lights);
    const auto check = [&] {
      if (options_.check) options_.check();
    };
    check();
    compare_bases(targets);
    check();
    compare_baselines(targets);
    check();
    compare_realis(targets);
  }

 private:
  struct Base {
    TexelProblem problem;
    std::vector<float> shade;
  };

  Base base_of(const Targets& targets, const Surface& surface, const BaseModel& base) const {
    BlockRender render = render_of(targets.info, targets.block, surface, all_lights(targets.info), base,
                                   settings_.albedo_in_modulation);
    Base out{luminance_problem(targets.info, targets.block, render), {}};
    out.shade = std::move(render.shade);
    return out;
  }

  void add(const MethodEvidence& name, const Targets& targets, const Base& base,
           std::span<const float> errors) {
    tallies_[name].add(targets, base.problem, base.shade, errors);
  }

  void compare_bases(const Targets& targets) {
    const Surface lambert = photometric_stereo(train_info(), train_block(), all_lights(train_info()));
    const Base plain = base_of(targets, lambert, BaseModel{});
    add(method("lambert"), targets, plain, plain.problem.residual);
    if (!plan_.material || !plan_.material->model.material) return;
    const BaseModel& model = plan_.material->model;
    const Base fitted = base_of(
        targets, with_base_colour(train_info(), train_block(), lambert, all_lights(train_info()), model),
        model);
    add(method("model"), targets, fitted, fitted.problem.residual);
  }

  void compare_baselines(const Targets& targets) {
    const Base base = base_of(targets, baked_.surface, plan_.base);
    const std::vector<float> seen = luminances(train_block());
    const std::vector<float> truth = luminances(targets.block);
    const std::size_t texels = sample_.count();
    const std::vector<Vec3> from = directions_of(train_info());
    const std::vector<Vec3> to = directions_of(targets.info);
    const auto error_of = [&](const Eigen::MatrixXd& basis, const Eigen::MatrixXd& target,
                              std::span<const float> values, std::span<const float> expected) {
      return difference(expected, fit_and_predict(basis, values, texels, target));
    };
    add(method("ptm"), targets, base, error_of(ptm_basis(from), ptm_basis(to), seen, truth));
    add(method("sh9"), targets, base, error_of(harmonics_basis(from), harmonics_basis(to), seen, truth));
    add(method("sh9-residual"), targets, base,
        error_of(harmonics_basis(from), harmonics_basis(to), baked_.problems[0].residual,
                 base.problem.residual));
  }

  // What is left of the base's error when lobes with these amplitudes correct it.
  std::vector<float> corrected(const Base& base, const Targets& targets, const LobeSystem& system,
                               std::span<const float> amplitudes) const {
    const std::vector<float> sums = lobe_sums(system.lobes(), directions_of(targets.info),
                                              base.problem.directions, amplitudes, base.problem.texels);
    std::vector<float> errors = base.problem.residual;
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] -= base.problem.modulation[k] * sums[k];
    return errors;
  }

  void compare_realis(const Targets& targets) {
    const Base base = base_of(targets, baked_.surface, plan_.base);
    compare_lobes("realis", base, targets, plan_.system, settings_.lobes, options_.compressed);
    for (const auto& [lobes, system] : plan_.also) {
      compare_lobes(fmt::format("realis-k{}", lobes), base, targets, system, lobes, false);
    }
  }

  // asked: the number of lobes where there is no system, as no lobes help.
  void compare_lobes(const std::string& name, const Base& base, const Targets& targets,
                     const std::optional<LobeSystem>& system, int asked, bool compressed) {
    const int lobes = system ? static_cast<int>(system->lobes().size()) : asked;
    const std::vector<RealisKind> kinds = realis_kinds(name, lobes, compressed, options_.dither);
    if (!system) {
      for (const RealisKind& kind : kinds) add(realis_method(kind), targets, base, base.problem.residual);
      return;
    }
    const SolveResult solved = solve(*system, baked_.problems[0]);
    std::map<int, std::vector<std::uint32_t>> masks;  // by how many lobes are kept
    for (const RealisKind& kind : kinds) {
      std::vector<std::uint32_t>& mask = masks[kind.options.dominant];
      if (kind.options.dominant < lobes && mask.empty()) {
        mask = dominant_masks(*system, std::span(baked_.problems).first(1), std::span(&solved, 1),
                              kind.options.dominant);
      }
      const std::vector<float> amplitudes =
          kind.is_whole() ? solved.amplitudes
                          : compressed_amplitudes(*system, solved.amplitudes, kind.options, mask);
      add(realis_method(kind), targets, base, corrected(base, targets, *system, amplitudes));
    }
  }

  std::vector<float> compressed_amplitudes(const LobeSystem& system, std::span<const float> amplitudes,
                                           const CompressOptions& options,
                                           std::span<const std::uint32_t> masks) const {
    const TexelProblem& problem = baked_.problems[0];
    const std::vector<RealisRange> ranges = code_ranges(system, problem, amplitudes, options, masks);
    return compress_block(system, problem, amplitudes, sample_.texels, info_.width, ranges, options, masks)
        .amplitudes;
  }

  const StackInfo& train_info() {
    if (!train_info_) train_info_ = with_lights(with_gains(info_, plan_.gains), plan_.lights);
    return *train_info_;
  }
  const TexelBlock& train_block() {
    if (!train_block_) train_block_ = with_lights(sample_, plan_.lights);
    return *train_block_;
  }

  const StackInfo& info_;
  const TexelBlock& sample_;
  const BakePlan& plan_;
  BakeSettings settings_;
  const EvidenceOptions& options_;
  Tallies& tallies_;
  BakedBlock baked_;
  std::optional<StackInfo> train_info_;
  std::optional<TexelBlock> train_block_;
};

}  // namespace

double RealisKind::bytes_per_texel() const {
  RealisAsset asset;
  asset.lobes.resize(static_cast<std::size_t>(lobes));
  asset.packing.bits = options.bits == 0 ? 32 : options.bits;
  asset.packing.dominant = options.dominant;
  return asset.bytes_per_texel();
}

std::vector<RealisKind> realis_kinds(const std::string& name, int lobes, bool compressed, bool dither) {
  const int half = std::max(1, lobes / 2);
  std::vector<RealisKind> kinds{{name, lobes, {0, lobes, false}}};
  if (compressed) {
    kinds.push_back({name + "-8bit", lobes, {8, lobes, dither}});
    kinds.push_back({name + "-4bit", lobes, {4, lobes, dither}});
    kinds.push_back({fmt::format("{}-m{}", name, half), lobes, {0, half, false}});
    kinds.push_back({fmt::format("{}-m{}-8bit", name, half), lobes, {8, half, dither}});
  }
  return kinds;
}

int fold_count(std::size_t lights, int asked) {
  if (asked > 0) return std::min(asked, static_cast<int>(lights));
  const std::size_t folds = lights <= kMostSingleFolds
                                ? lights
                                : std::max<std::size_t>(5, (lights + kLightsPerFold - 1) / kLightsPerFold);
  return static_cast<int>(folds);
}

LightChoice held_out_lights(std::size_t lights, int fold, int count) {
  LightChoice held;
  for (auto light = static_cast<std::uint32_t>(fold); light < lights;
       light += static_cast<std::uint32_t>(count)) {
    held.push_back(light);
  }
  return held;
}

const MethodEvidence* Evidence::find(const std::string& name) const {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const MethodEvidence& m) { return m.name == name; });
  return found == methods.end() ? nullptr : &*found;
}

FoldPlans fold_plans(BakePlan plan) {
  FoldPlans plans;
  for (const auto& [lobes, system] : plan.also) {
    BakePlan other = plan;
    other.also.clear();
    other.system = system;
    plans.other_lobes.emplace(lobes, std::move(other));
  }
  plans.plan = std::move(plan);
  return plans;
}

BakeSettings with_compared_lobes(BakeSettings settings, const EvidenceOptions& options) {
  settings.also_lobes = options.other_lobes;
  std::erase(settings.also_lobes, settings.lobes);
  return settings;
}

Evidence evaluate(const StackInfo& info, const TexelBlock& sample, const BakePlan& whole_plan,
                  const BakeSettings& whole_settings, const EvidenceOptions& options) {
  const BakeSettings settings = with_compared_lobes(whole_settings, options);
  BakePlan plan = whole_plan;
  if (plan.also.size() != settings.also_lobes.size()) {
    plan_lobes(plan, with_lights(with_gains(info, plan.gains), plan.lights), with_lights(sample, plan.lights),
               settings);
  }
  const std::size_t lights = info.lights.size();
  Evidence evidence;
  evidence.folds = fold_count(lights, options.folds);
  evidence.texels = sample.count();
  Tallies train(lights);
  Predictor(info, sample, plan, settings, options, train).predict(plan.lights);
  Tallies held(lights);
  for (int fold = 0; fold < evidence.folds; ++fold) {
    const LightChoice out = held_out_lights(lights, fold, evidence.folds);
    const LightChoice kept = without(info, out);
    if (kept.empty()) continue;
    const auto make = [&] {
      FoldEvidence made;
      made.plan = plan_bake(info, sample, kept, settings);
      Tallies tallies(lights);
      Predictor(info, sample, made.plan, settings, options, tallies).predict(out);
      made.sums = tallies.sums();
      return made;
    };
    FoldEvidence found = options.fold_of ? options.fold_of(fold, make) : make();
    for (const MethodSums& sums : found.sums) held[method(sums.name)].add(sums);
    if (options.on_fold) options.on_fold(fold, fold_plans(std::move(found.plan)));
    if (options.progress) options.progress(static_cast<double>(fold + 1) / evidence.folds);
  }
  for (MethodEvidence found : train.methods()) {
    found.train = train.find(found.name)->errors();
    if (const Tally* tally = held.find(found.name)) found.held_out = tally->errors();
    evidence.methods.push_back(std::move(found));
  }
  return evidence;
}

}  // namespace brdfit::bake
