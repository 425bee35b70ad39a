// Folds over lights: plan, bake, predict, tally.
#include "bake/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "bake/baselines.h"
#include "bake/channel_errors.h"
#include "bake/kept_amplitudes.h"
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

// The sums of one method; of channels where they are asked for.
MethodSums empty_sums(const std::string& name, std::size_t lights, bool coloured) {
  MethodSums sums{name, ErrorSums::of_lights(lights), {}};
  if (coloured) sums.rgb = ErrorSums::of_lights(lights);
  return sums;
}

// The methods of one evaluation, in the order in which they were first met.
class Tallies {
 public:
  Tallies(std::size_t lights, bool coloured) : lights_(lights), coloured_(coloured) {}
  MethodSums& operator[](const MethodEvidence& method) {
    const auto found = place_.find(method.name);
    if (found != place_.end()) return sums_[found->second];
    place_[method.name] = sums_.size();
    methods_.push_back(method);
    sums_.push_back(empty_sums(method.name, lights_, coloured_));
    return sums_.back();
  }
  const std::vector<MethodEvidence>& methods() const { return methods_; }
  const std::vector<MethodSums>& sums() const { return sums_; }
  const MethodSums* find(const std::string& name) const {
    const auto found = place_.find(name);
    return found == place_.end() ? nullptr : &sums_[found->second];
  }

 private:
  std::size_t lights_;
  bool coloured_;
  std::map<std::string, std::size_t> place_;
  std::vector<MethodEvidence> methods_;
  std::vector<MethodSums> sums_;
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

// Errors are taken of planes: of luminance, and where colour is baked of red, green and blue too.
constexpr std::size_t kLuminancePlane = 0;
constexpr std::size_t kFirstChannel = 1;
constexpr std::size_t kPlanes = 4;

// [light][texel].
std::vector<float> values_of(const TexelBlock& block, std::size_t plane) {
  std::vector<float> out(block.lights * block.count());
  for (std::size_t light = 0; light < block.lights; ++light) {
    for (std::size_t k = 0; k < block.count(); ++k) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3 && plane == kLuminancePlane; ++c)
        sum += kLuminance[c] * static_cast<double>(block.plane(light, c)[k]);
      out[light * block.count() + k] =
          plane == kLuminancePlane ? static_cast<float>(sum) : block.plane(light, plane - kFirstChannel)[k];
    }
  }
  return out;
}

// What a basis of directions, fitted per texel to what was seen, misses of the truth under other lights.
std::vector<float> error_of_fit(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to, std::size_t texels,
                                std::span<const float> seen, std::span<const float> truth) {
  std::vector<float> errors = fit_and_predict(from, seen, texels, to);
  for (std::size_t k = 0; k < errors.size(); ++k) errors[k] = truth[k] - errors[k];
  return errors;
}

// What a plan predicts of some lights.
class Predictor {
 public:
  Predictor(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
            const BakeSettings& settings, const EvidenceOptions& options, Tallies& tallies)
      : info_(info),
        sample_(sample),
        plan_(plan),
        settings_(settings),
        colour_(settings.colour),
        options_(options),
        tallies_(tallies) {
    settings_.colour = RealisColour::kLuminance;
    baked_ = bake_block(info, sample, plan, settings_);
    problems_ = std::move(baked_.problems);
    if (is_coloured()) {
      add_channels(problems_, train_info(), train_block(),
                   rendered(train_info(), train_block(), baked_.surface, plan_.base));
    }
  }

  void predict(const LightChoice& lights) {
    const Targets targets = targets_of(info_, sample_, plan_, lights);
    const auto check = [&] {
      if (options_.check) options_.check();
    };
    check();
    compare_bases(targets);
    check();
    const Base base = base_of(targets, baked_.surface, plan_.base);
    compare_baselines(targets, base);
    check();
    compare_realis(targets, base);
  }

 private:
  // A base model under the lights to predict.
  struct Base {
    std::vector<TexelProblem> problems;  // of planes
    std::vector<float> shade;

    const TexelProblem& luminance() const { return problems[kLuminancePlane]; }
  };

  bool is_coloured() const { return colour_ != RealisColour::kLuminance; }

  static std::span<const TexelProblem, 3> channels_of(const std::vector<TexelProblem>& problems) {
    return std::span<const TexelProblem, kPlanes>(problems.data(), kPlanes).subspan<kFirstChannel, 3>();
  }

  static void add_channels(std::vector<TexelProblem>& problems, const StackInfo& info,
                           const TexelBlock& block, const BlockRender& render) {
    for (TexelProblem& channel : rgb_problems(info, block, render)) problems.push_back(std::move(channel));
  }

  BlockRender rendered(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                       const BaseModel& base) const {
    return render_of(info, block, surface, all_lights(info), base, settings_.albedo_in_modulation);
  }

  Base base_of(const Targets& targets, const Surface& surface, const BaseModel& model) const {
    BlockRender render = rendered(targets.info, targets.block, surface, model);
    Base base;
    base.problems.push_back(luminance_problem(targets.info, targets.block, render));
    if (is_coloured()) add_channels(base.problems, targets.info, targets.block, render);
    base.shade = std::move(render.shade);
    return base;
  }

  // Errors of a plane.
  void add(const MethodEvidence& name, const Targets& targets, const Base& base, std::size_t plane,
           std::span<const float> errors) {
    MethodSums& sums = tallies_[name];
    ErrorSums& to = plane == kLuminancePlane ? sums.luminance : sums.rgb;
    to.add(targets.lights, base.problems[plane], base.shade, errors);
  }

  void add_channel_errors(const MethodEvidence& name, const Targets& targets, const Base& base,
                          const ChannelPlanes& errors) {
    for (std::size_t c = 0; c < 3; ++c) add(name, targets, base, kFirstChannel + c, errors[c]);
  }

  // Of the base model itself.
  void add_base_errors(const MethodEvidence& name, const Targets& targets, const Base& base) {
    for (std::size_t plane = 0; plane < base.problems.size(); ++plane) {
      add(name, targets, base, plane, base.problems[plane].residual);
    }
  }

  void compare_bases(const Targets& targets) {
    const LightChoice all = all_lights(train_info());
    const Surface lambert = photometric_stereo(train_info(), train_block(), all);
    compare_base("lambert", targets, lambert, BaseModel{});
    if (!plan_.material || !plan_.material->model.material) return;
    const BaseModel& model = plan_.material->model;
    compare_base("model", targets, with_base_colour(train_info(), train_block(), lambert, all, model), model);
  }

  void compare_base(const std::string& name, const Targets& targets, const Surface& surface,
                    const BaseModel& model) {
    add_base_errors(method(name), targets, base_of(targets, surface, model));
  }

  void compare_baselines(const Targets& targets, const Base& base) {
    const std::size_t texels = sample_.count();
    const std::vector<Vec3> from = directions_of(train_info());
    const std::vector<Vec3> to = directions_of(targets.info);
    const Eigen::MatrixXd harmonics_from = harmonics_basis(from);
    const Eigen::MatrixXd harmonics_to = harmonics_basis(to);
    for (std::size_t plane = 0; plane < base.problems.size(); ++plane) {
      const std::vector<float> seen = values_of(train_block(), plane);
      const std::vector<float> truth = values_of(targets.block, plane);
      add(method("ptm"), targets, base, plane,
          error_of_fit(ptm_basis(from), ptm_basis(to), texels, seen, truth));
      add(method("sh9"), targets, base, plane,
          error_of_fit(harmonics_from, harmonics_to, texels, seen, truth));
      add(method("sh9-residual"), targets, base, plane,
          error_of_fit(harmonics_from, harmonics_to, texels, problems_[plane].residual,
                       base.problems[plane].residual));
    }
  }

  // What is left of the base's error of luminance when lobes with these amplitudes correct it.
  std::vector<float> corrected(const Base& base, const Targets& targets, const LobeSystem& system,
                               std::span<const float> amplitudes) const {
    const TexelProblem& problem = base.luminance();
    const std::vector<float> sums = lobe_sums(system.lobes(), directions_of(targets.info), problem.directions,
                                              amplitudes, problem.texels);
    std::vector<float> errors = problem.residual;
    for (std::size_t k = 0; k < errors.size(); ++k) errors[k] -= problem.modulation[k] * sums[k];
    return errors;
  }

  // The same in each channel, as the asset corrects it.
  ChannelPlanes corrected_channels(const Base& base, const Targets& targets, const LobeSystem& system,
                                   std::span<const std::vector<float>> amplitudes,
                                   std::span<const float> chroma) const {
    return channel_errors(channels_of(base.problems), system.lobes(), directions_of(targets.info), amplitudes,
                          chroma);
  }

  void compare_realis(const Targets& targets, const Base& base) {
    if (is_coloured()) compare_without_colour(targets, base);
    compare_lobes("realis", base, targets, plan_.system, settings_.lobes, options_.compressed);
    for (const auto& [lobes, system] : plan_.also) {
      compare_lobes(fmt::format("realis-k{}", lobes), base, targets, system, lobes, false);
    }
  }

  // One amplitude per lobe for all channels.
  void compare_without_colour(const Targets& targets, const Base& base) {
    const int lobes = plan_.system ? static_cast<int>(plan_.system->lobes().size()) : settings_.lobes;
    const RealisKind kind =
        realis_kinds("realis-luminance", lobes, RealisColour::kLuminance, false, options_.dither)[0];
    const MethodEvidence name = realis_method(kind);
    if (!plan_.system) return add_base_errors(name, targets, base);
    const std::vector<float>& amplitudes = baked_.solved[0].amplitudes;
    add(name, targets, base, kLuminancePlane, corrected(base, targets, *plan_.system, amplitudes));
    add_channel_errors(name, targets, base,
                       corrected_channels(base, targets, *plan_.system, {&amplitudes, 1}, {}));
  }

  // asked: the number of lobes where there is no system, as no lobes help.
  void compare_lobes(const std::string& name, const Base& base, const Targets& targets,
                     const std::optional<LobeSystem>& system, int asked, bool compressed) {
    const int lobes = system ? static_cast<int>(system->lobes().size()) : asked;
    const std::vector<RealisKind> kinds = realis_kinds(name, lobes, colour_, compressed, options_.dither);
    if (!system) {
      for (const RealisKind& kind : kinds) add_base_errors(realis_method(kind), targets, base);
      return;
    }
    const std::span<const TexelProblem> problems = colour_ == RealisColour::kRgb
                                                       ? std::span<const TexelProblem>(channels_of(problems_))
                                                       : std::span<const TexelProblem>(problems_).first(1);
    std::vector<SolveResult> solved;
    for (const TexelProblem& problem : problems) solved.push_back(solve(*system, problem));
    std::vector<float> chroma;
    if (colour_ == RealisColour::kScaledChroma) {
      chroma = chroma_of(*system, channels_of(problems_), solved[0].amplitudes);
    }
    KeptAmplitudes kept(*system, problems, solved, sample_.texels, info_.width);
    for (const RealisKind& kind : kinds) {
      std::vector<std::vector<RealisRange>> ranges;
      if (kind.options.bits > 0) ranges = kept.ranges(kind.options);
      const std::vector<std::vector<float>> amplitudes = kept.amplitudes(kind.options, ranges);
      add_corrected(realis_method(kind), targets, base, *system, amplitudes, chroma);
    }
  }

  void add_corrected(const MethodEvidence& name, const Targets& targets, const Base& base,
                     const LobeSystem& system, std::span<const std::vector<float>> amplitudes,
                     std::span<const float> chroma) {
    if (!is_coloured()) {
      add(name, targets, base, kLuminancePlane, corrected(base, targets, system, amplitudes[0]));
      return;
    }
    const ChannelPlanes errors = corrected_channels(base, targets, system, amplitudes, chroma);
    add(name, targets, base, kLuminancePlane, luminance_of(errors));
    add_channel_errors(name, targets, base, errors);
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
  RealisColour colour_;
  const EvidenceOptions& options_;
  Tallies& tallies_;
  BakedBlock baked_;                    // for luminance, its problem moved to
  std::vector<TexelProblem> problems_;  // of planes, under the lights that were baked from
  std::optional<StackInfo> train_info_;
  std::optional<TexelBlock> train_block_;
};

}  // namespace

double RealisKind::bytes_per_texel() const {
  RealisAsset asset;
  asset.lobes.resize(static_cast<std::size_t>(lobes));
  asset.colour = colour;
  asset.packing.bits = options.bits == 0 ? 32 : options.bits;
  asset.packing.dominant = options.dominant;
  return asset.bytes_per_texel();
}

std::vector<RealisKind> realis_kinds(const std::string& name, int lobes, RealisColour colour, bool compressed,
                                     bool dither) {
  const int half = std::max(1, lobes / 2);
  std::vector<RealisKind> kinds{{name, lobes, {0, lobes, false}, colour}};
  if (compressed) {
    kinds.push_back({name + "-8bit", lobes, {8, lobes, dither}, colour});
    kinds.push_back({name + "-4bit", lobes, {4, lobes, dither}, colour});
    kinds.push_back({fmt::format("{}-m{}", name, half), lobes, {0, half, false}, colour});
    kinds.push_back({fmt::format("{}-m{}-8bit", name, half), lobes, {8, half, dither}, colour});
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
  const bool coloured = settings.colour != RealisColour::kLuminance;
  Tallies train(lights, coloured);
  Predictor(info, sample, plan, settings, options, train).predict(plan.lights);
  Tallies held(lights, coloured);
  for (int fold = 0; fold < evidence.folds; ++fold) {
    const LightChoice out = held_out_lights(lights, fold, evidence.folds);
    const LightChoice kept = without(info, out);
    if (kept.empty()) continue;
    const auto make = [&] {
      FoldEvidence made;
      made.plan = plan_bake(info, sample, kept, settings);
      Tallies tallies(lights, coloured);
      Predictor(info, sample, made.plan, settings, options, tallies).predict(out);
      made.sums = tallies.sums();
      return made;
    };
    FoldEvidence found = options.fold_of ? options.fold_of(fold, make) : make();
    for (const MethodSums& sums : found.sums) {
      MethodSums& all = held[method(sums.name)];
      all.luminance.add(sums.luminance);
      all.rgb.add(sums.rgb);
    }
    if (options.on_fold) options.on_fold(fold, fold_plans(std::move(found.plan)));
    if (options.progress) options.progress(static_cast<double>(fold + 1) / evidence.folds);
  }
  for (MethodEvidence found : train.methods()) {
    const MethodSums& baked_from = *train.find(found.name);
    found.train = baked_from.luminance.errors();
    if (coloured) found.rgb.emplace().train = baked_from.rgb.errors();
    if (const MethodSums* sums = held.find(found.name)) {
      found.held_out = sums->luminance.errors();
      if (coloured) found.rgb->held_out = sums->rgb.errors();
    }
    evidence.methods.push_back(std::move(found));
  }
  return evidence;
}

}  // namespace brdfit::bake
