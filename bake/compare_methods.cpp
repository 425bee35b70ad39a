// Bases, polynomials and harmonics, and sizes of Realis, plane by plane.
#include "bake/compare_methods.h"

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

// The methods in the order in which they were first met.
class Tallies {
 public:
  Tallies(std::size_t lights, bool coloured) : lights_(lights), coloured_(coloured) {}
  MethodSums& operator[](const MethodEvidence& method) {
    const auto [found, is_new] = place_.emplace(method.name, compared_.methods.size());
    if (is_new) {
      compared_.methods.push_back(method);
      MethodSums sums{method.name, ErrorSums::of_lights(lights_), {}};
      if (coloured_) sums.rgb = ErrorSums::of_lights(lights_);
      compared_.sums.push_back(std::move(sums));
    }
    return compared_.sums[found->second];
  }
  ComparedMethods take() { return std::move(compared_); }

 private:
  std::size_t lights_;
  bool coloured_;
  std::map<std::string, std::size_t> place_;
  ComparedMethods compared_;
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
  std::vector<float> out;
  out.reserve(block.lights * block.count());
  for (std::size_t light = 0; light < block.lights; ++light) {
    if (plane != kLuminancePlane) {
      const auto channel = block.plane(light, plane - kFirstChannel);
      out.insert(out.end(), channel.begin(), channel.end());
      continue;
    }
    for (std::size_t k = 0; k < block.count(); ++k) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        sum += kLuminance[c] * static_cast<double>(block.plane(light, c)[k]);
      out.push_back(static_cast<float>(sum));
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

// What a plan predicts of some lights, each way.
class Comparison {
 public:
  Comparison(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
             const BakeSettings& settings, const MethodOptions& options)
      : info_(info),
        sample_(sample),
        plan_(plan),
        settings_(settings),
        colour_(settings.colour),
        options_(options),
        tallies_(info.lights.size(), settings.colour != RealisColour::kLuminance) {
    settings_.colour = RealisColour::kLuminance;
    baked_ = bake_block(info, sample, plan, settings_);
    problems_ = std::move(baked_.problems);
    if (is_coloured()) {
      add_channels(problems_, train_info(), train_block(),
                   rendered(train_info(), train_block(), baked_.surface, plan_.base));
    }
  }

  ComparedMethods compare(const LightChoice& lights) {
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
    return tallies_.take();
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
    const RealisKind kind = realis_kinds("realis-luminance", lobes, options_.kept, RealisColour::kLuminance,
                                         false, options_.dither)[0];
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
    const std::vector<RealisKind> kinds =
        realis_kinds(name, lobes, options_.kept, colour_, compressed, options_.dither);
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
  const MethodOptions& options_;
  Tallies tallies_;
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

int half_of(int lobes) {
  return std::max(1, lobes / 2);
}

std::vector<RealisKind> realis_kinds(const std::string& name, int lobes, int kept, RealisColour colour,
                                     bool compressed, bool dither) {
  std::vector<RealisKind> kinds{{name, lobes, {0, lobes, false}, colour}};
  if (compressed) {
    const int dominant = std::min(kept, lobes);
    kinds.push_back({name + "-8bit", lobes, {8, lobes, dither}, colour});
    kinds.push_back({name + "-4bit", lobes, {4, lobes, dither}, colour});
    kinds.push_back({fmt::format("{}-m{}", name, kept), lobes, {0, dominant, false}, colour});
    kinds.push_back({fmt::format("{}-m{}-8bit", name, kept), lobes, {8, dominant, dither}, colour});
  }
  return kinds;
}

ComparedMethods compare_methods(const StackInfo& info, const TexelBlock& sample, const BakePlan& plan,
                                const BakeSettings& settings, const MethodOptions& options,
                                const LightChoice& lights) {
  return Comparison(info, sample, plan, settings, options).compare(lights);
}

}  // namespace brdfit::bake
