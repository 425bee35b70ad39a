// Plans shared, bakes timed in turns, errors under lights held out.
#include "cli/cost/stack_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "bake/bake_rows.h"
#include "bake/evidence.h"
#include "bake/luminance.h"
#include "bake/shrunk_stack.h"
#include "cli/bake_stack.h"
#include "cli/clocks.h"
#include "cli/cost/paired_timing.h"
#include "cli/cost/pareto.h"
#include "cli/cost/peak_memory.h"
#include "cli/cost/stack_device.h"
#include "cli/cost/stack_errors.h"
#include "cli/cost/stack_evaluation.h"
#include "cli/progress.h"

namespace brdfit::cli {
namespace {

constexpr int kQuickFolds = 6;
constexpr int kEvaluationsPerBake = 5;

// The stack in one size, with the texels that are baked of it.
struct Size {
  StackInfo info;
  TexelBlock sample;
};

// Points that share plans: their base and size.
struct Family {
  std::optional<Model> base;
  int shrink = 1;
  std::vector<std::size_t> choices;  // indices of points
  std::vector<int> lobes;            // that they need, the first one planned and the others beside it
};

class StackMeter {
 public:
  explicit StackMeter(const StackSweepOptions& options)
      : options_(options), stack_(options.bake, true), settings_(settings_of_all()) {
    const BothClocks clocks;
    sizes_[1] = {stack_.info(), stack_.read_texels(even_sample(
                                    stack_.info(), static_cast<std::size_t>(options.bake.sample_texels)))};
    decode_seconds_ = clocks.taken().cpu_seconds;
  }

  // Around which the points lie, and what else there is.
  std::pair<std::optional<Model>, std::optional<Model>> bases() {
    const Model model = *model_by_name(options_.bake.model);
    if (options_.bake.base == "lambert") return {std::nullopt, model};
    if (options_.bake.base == "material") return {model, std::nullopt};
    const Size& size = sizes_.at(1);
    bake::BakeSettings settings = settings_;
    settings.lobes = 1;
    const bake::BakePlan plan =
        bake::plan_bake(size.info, size.sample, bake::all_lights(size.info), settings);
    if (plan.base.material) return {plan.base.material->model(), std::nullopt};
    return {std::nullopt, model};
  }

  CostRun measure(std::vector<PlannedChoice> choices) {
    choices_ = std::move(choices);
    find_families();
    CostRun run;
    run.kind = "stack";
    run.input = std::filesystem::path(options_.bake.stack).filename().string();
    run.leading_error = kStackLeadingError;
    for (const PlannedChoice& planned : choices_) {
      CostPoint point;
      point.name = planned.name;
      point.sweep = planned.sweep;
      point.settings = settings_of(planned.choice);
      point.bytes = planned.choice.bytes_per_texel(stack_.info());
      run.points.push_back(std::move(point));
    }
    time_bakes(run);
    measure_errors(run);
    time_evaluations(run);
    add_notes(run);
    mark_fronts(run);
    return run;
  }

  // The default of a run that was measured, relit in other ways.
  void add_devices(CostRun& run) {
    StackEvaluation& evaluation = *evaluations_.front();
    std::vector<std::pair<std::string, std::function<double()>>> ways = {
        {"processor, double precision", [&] { return evaluation.nanoseconds_in_double(); }}};
    std::string why;
    std::vector<float> correction;
    const std::unique_ptr<StackDevice> device = open_stack_device(options_.device, why);
    if (device) {
      ways.emplace_back("Vulkan: " + device->name(), [&] {
        return device->nanoseconds(evaluation.asset(), evaluation.held(), evaluation.lights(), correction);
      });
    } else {
      run.notes.push_back("no Vulkan device was timed: " + why);
    }
    for (const auto& way : ways) way.second();
    const TimesInTurns times = time_in_turns(
        ways.size(), [&](std::size_t k) { return ways[k].second(); }, evaluation_turns());
    for (std::size_t k = 0; k < ways.size(); ++k) {
      CostPoint point = run.points.front();
      point.name += ", " + ways[k].first;
      point.sweep = "device";
      point.settings.emplace_back("device", ways[k].first);
      point.evaluation_ns = times.works[k];
      run.points.push_back(std::move(point));
    }
    mark_fronts(run);
  }

 private:
  bake::BakeSettings settings_of_all() const {
    if (!options_.bake.lobe_set.empty()) throw UsageError("cost chooses lobes itself: no --lobe-set");
    BakeArguments arguments = options_.bake;
    arguments.lobes = "8";
    arguments.ridge_factor = 1.0;
    arguments.colour = name_of(RealisColour::kLuminance);
    return bake_settings_of(arguments);
  }

  bake::BakeSettings settings_with(const Family& family, int lobes) const {
    bake::BakeSettings settings = settings_;
    settings.lobes = lobes;
    settings.base = family.base ? bake::BaseKind::kMaterial : bake::BaseKind::kLambert;
    if (family.base) settings.model = *family.base;
    return settings;
  }

  void find_families() {
    for (std::size_t k = 0; k < choices_.size(); ++k) {
      const StackChoice& choice = choices_[k].choice;
      auto found = std::ranges::find_if(families_, [&](const Family& family) {
        return family.base == choice.base && family.shrink == choice.shrink;
      });
      if (found == families_.end()) {
        families_.push_back({choice.base, choice.shrink, {}, {}});
        found = families_.end() - 1;
      }
      found->choices.push_back(k);
      if (std::ranges::find(found->lobes, choice.lobes) == found->lobes.end()) {
        found->lobes.push_back(choice.lobes);
      }
      if (!sizes_.contains(choice.shrink)) sizes_[choice.shrink] = shrunk(choice.shrink);
    }
    plans_.resize(families_.size());
  }

  // All that magnifying to the sample needs.
  Size shrunk(int shrink) {
    bake::ShrunkStack stack(stack_, shrink);
    std::set<std::uint32_t> needed;
    for (const std::uint32_t texel : sizes_.at(1).sample.texels) {
      const bake::ShrunkPlace place = bake::shrunk_place(stack_.info(), shrink, texel);
      needed.insert(place.texels.begin(), place.texels.end());
    }
    const std::vector<std::uint32_t> texels(needed.begin(), needed.end());
    return {stack.info(), stack.read_texels(texels)};
  }

  // Bakes of each family and number of lobes in turns, `repeats` times.
  void time_bakes(CostRun& run) {
    std::vector<Repeats> repeats(choices_.size());
    const int rounds = options_.quick ? 1 : options_.repeats;
    Progress progress(static_cast<std::size_t>(rounds) * plan_count(), is_quiet());
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t f = 0; f < families_.size(); ++f) {
        for (const int lobes : families_[f].lobes) {
          time_bakes(f, lobes, repeats, run);
          progress.step("bakes");
        }
      }
    }
    for (std::size_t k = 0; k < choices_.size(); ++k) run.points[k].make_seconds = repeats[k].summary();
  }

  std::size_t plan_count() const {
    std::size_t count = 0;
    for (const Family& family : families_) count += family.lobes.size();
    return count;
  }

  void time_bakes(std::size_t f, int lobes, std::vector<Repeats>& repeats, CostRun& run) {
    const Family& family = families_[f];
    const Size& size = sizes_.at(family.shrink);
    const bake::BakeSettings settings = settings_with(family, lobes);
    stop_if_interrupted();
    reset_peak_memory();
    const BothClocks clocks;
    bake::BakePlan plan = bake::plan_bake(size.info, size.sample, bake::all_lights(size.info), settings);
    const double plan_seconds = clocks.taken().cpu_seconds;
    const double plan_mib = peak_memory_mib();
    for (const std::size_t k : family.choices) {
      if (choices_[k].choice.lobes != lobes) continue;
      stop_if_interrupted();
      reset_peak_memory();
      const double reference = time_reference().cpu_seconds;
      // Pictures are decoded for the sample and for the strips.
      const double seconds =
          2.0 * decode_seconds_ + plan_seconds + bake_seconds(choices_[k].choice, size, plan, settings);
      repeats[k].add(seconds, reference);
      run.points[k].peak_mib = std::max({run.points[k].peak_mib, plan_mib, peak_memory_mib()});
    }
    if (plans_[f].systems.empty()) {
      plans_[f] = LobePlans::of(std::move(plan), lobes);
    } else {
      plans_[f].systems[lobes] = std::move(plan.system);
    }
  }

  // Ranges of codes from the sample, then all texels: the sample's time in proportion.
  double bake_seconds(const StackChoice& choice, const Size& size, const bake::BakePlan& plan,
                      bake::BakeSettings settings) const {
    settings.colour = choice.colour;
    RealisPacking packing;
    packing.bits = choice.is_code() ? static_cast<int>(choice.bits) : 8;
    packing.dominant = choice.dominant;
    const bool dither = !options_.bake.no_dither;
    const bake::CompressOptions compression{packing.bits, choice.dominant, dither};
    const BothClocks sampled;
    const bake::BakedBlock baked = bake::bake_block(size.info, size.sample, plan, settings);
    const std::size_t channels = baked.solved.size();
    const std::vector<std::uint32_t> masks =
        channels > 1 && choice.dominant < choice.lobes
            ? bake::dominant_masks(*plan.system, baked.problems, baked.solved, choice.dominant)
            : std::vector<std::uint32_t>();
    std::vector<std::vector<RealisRange>> ranges(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      ranges[c] =
          bake::code_ranges(*plan.system, baked.problems[c], baked.solved[c].amplitudes, compression, masks);
    }
    const double sample_seconds = sampled.taken().cpu_seconds;
    if (channels == 1) packing.ranges = ranges[0];
    const BothClocks solved;
    if (bake::has_short_way(size.info, plan, settings, packing)) {
      bake::bake_rows(size.info, size.sample, plan, settings, packing, dither);
    } else {
      const bake::BakedBlock block = bake::bake_block(size.info, size.sample, plan, settings);
      for (std::size_t c = 0; c < channels; ++c) {
        bake::compress_block(*plan.system, block.problems[c], block.solved[c].amplitudes, size.sample.texels,
                             size.info.width, ranges[c], compression, masks);
      }
    }
    const double ratio =
        static_cast<double>(size.info.texel_count()) / static_cast<double>(size.sample.count());
    return sample_seconds + solved.taken().cpu_seconds * ratio;
  }

  struct Sums {
    explicit Sums(std::size_t lights, std::size_t points) : each(points, StackErrorSums(lights)) {}
    std::vector<StackErrorSums> each;
  };

  void add_family_errors(const Family& family, const LobePlans& plans, const bake::LightChoice& lights,
                         Sums& sums, const std::function<void(ChoiceBake&)>& also = {}) {
    const Size& size = sizes_.at(family.shrink);
    const bake::BakeSettings settings = settings_with(family, family.lobes.front());
    ChoiceBake baked(size.info, size.sample, plans, settings, !options_.bake.no_dither);
    std::vector<StackChoice> choices;
    std::vector<StackErrorSums*> to;
    for (const std::size_t k : family.choices) {
      choices.push_back(choices_[k].choice);
      to.push_back(&sums.each[k]);
    }
    const StackTargets targets{sizes_.at(1).info, sizes_.at(1).sample};
    add_errors(targets, lights, size.sample, plans, settings, baked, choices, to);
    if (also) also(baked);
  }

  void measure_errors(CostRun& run) {
    const StackInfo& info = sizes_.at(1).info;
    Sums train(info.lights.size(), choices_.size());
    evaluations_.resize(choices_.size());
    for (std::size_t f = 0; f < families_.size(); ++f) {
      add_family_errors(families_[f], plans_[f], bake::all_lights(info), train, [&](ChoiceBake& baked) {
        for (const std::size_t k : families_[f].choices) {
          const Stored stored = baked.stored(choices_[k].choice);
          evaluations_[k] = std::make_unique<StackEvaluation>(
              sizes_.at(families_[f].shrink).info, plans_[f].plan.base, choices_[k].choice, stored,
              baked.surface(), settings_.albedo_in_modulation);
        }
      });
    }
    folds_ = bake::fold_count(info.lights.size(),
                              options_.bake.folds == 0 && options_.quick ? kQuickFolds : options_.bake.folds);
    Sums held(info.lights.size(), choices_.size());
    Progress progress(static_cast<std::size_t>(folds_) * families_.size(), is_quiet());
    for (int fold = 0; fold < folds_; ++fold) {
      const bake::LightChoice out = bake::held_out_lights(info.lights.size(), fold, folds_);
      const bake::LightChoice kept = bake::without(info, out);
      if (kept.empty()) continue;
      for (const Family& family : families_) {
        stop_if_interrupted();
        const Size& size = sizes_.at(family.shrink);
        bake::BakeSettings settings = settings_with(family, family.lobes.front());
        settings.also_lobes.assign(family.lobes.begin() + 1, family.lobes.end());
        const LobePlans plans =
            LobePlans::of(bake::plan_bake(size.info, size.sample, kept, settings), settings.lobes);
        add_family_errors(family, plans, out, held);
        progress.step("held-out lights");
      }
    }
    for (std::size_t k = 0; k < choices_.size(); ++k) {
      add_summary("held_out_", held.each[k].summary(), run.points[k]);
      add_summary("train_", train.each[k].summary(), run.points[k]);
    }
  }

  static void add_summary(const std::string& prefix, const StackErrorSummary& summary, CostPoint& point) {
    point.errors.emplace_back(prefix + "rgb_rmse_255", summary.rgb_rmse_255);
    point.errors.emplace_back(prefix + "rmse_255", summary.rmse_255);
    point.errors.emplace_back(prefix + "lit_rmse_255", summary.lit_rmse_255);
    point.errors.emplace_back(prefix + "worst_light_rmse_255", summary.worst_light_rmse_255);
  }

  TurnOptions evaluation_turns() const {
    TurnOptions turns;
    turns.repeats = options_.repeats * kEvaluationsPerBake;
    turns.cpu_time = true;
    turns.per_second = 1e9;
    turns.before_each = stop_if_interrupted;
    return turns;
  }

  void time_evaluations(CostRun& run) {
    for (const auto& evaluation : evaluations_) evaluation->nanoseconds();
    const TimesInTurns times = time_in_turns(
        evaluations_.size(), [&](std::size_t k) { return evaluations_[k]->nanoseconds(); },
        evaluation_turns());
    for (std::size_t k = 0; k < run.points.size(); ++k) run.points[k].evaluation_ns = times.works[k];
    run.reference_seconds = times.reference_seconds;
  }

  void add_notes(CostRun& run) const {
    const Size& size = sizes_.at(1);
    run.notes.push_back(
        fmt::format("errors are those of {} of {} texels, held out over {} folds of {} lights",
                    size.sample.count(), size.info.texel_count(), folds_, size.info.lights.size()));
    run.notes.emplace_back(
        "times to bake are CPU seconds of all threads, without writing files; those of an evaluation are of "
        "one thread, render and correction of one texel under one light");
    for (std::size_t f = 0; f < families_.size(); ++f) {
      for (const auto& [lobes, system] : plans_[f].systems) {
        if (!system) run.notes.push_back(fmt::format("{} lobes do not help: such points have none", lobes));
      }
    }
  }

  bool is_quiet() const { return options_.bake.common.quiet || options_.bake.common.json; }

  const StackSweepOptions& options_;
  BakeStack stack_;
  bake::BakeSettings settings_;
  std::map<int, Size> sizes_;
  double decode_seconds_ = 0.0;
  std::vector<PlannedChoice> choices_;
  std::vector<Family> families_;
  std::vector<LobePlans> plans_;  // of all lights, of each family
  std::vector<std::unique_ptr<StackEvaluation>> evaluations_;
  int folds_ = 0;
};

std::string exact_number(double value) {
  return fmt::format("{}", value);
}

}  // namespace

std::vector<std::string> stack_error_keys() {
  std::vector<std::string> keys;
  for (const char* prefix : {"held_out_", "train_"}) {
    for (const char* measure : {"rgb_rmse_255", "rmse_255", "lit_rmse_255", "worst_light_rmse_255"}) {
      keys.push_back(fmt::format("{}{}", prefix, measure));
    }
  }
  return keys;
}

CostRun sweep_stack(const StackSweepOptions& options) {
  StackMeter meter(options);
  const auto [base, other] = meter.bases();
  CostRun run = meter.measure(plan_choices(base, other, options.quick));
  meter.add_devices(run);
  return run;
}

CostPoint measure_stack_choice(const CostPoint& point, const StackSweepOptions& options) {
  StackMeter meter(options);
  return meter.measure({{point.name, point.sweep, choice_of(point)}}).points.front();
}

std::vector<std::string> bake_command_of(const CostPoint& point, const StackSweepOptions& options,
                                         const std::filesystem::path& folder) {
  const BakeArguments a = with_choice(options.bake, choice_of(point));
  std::vector<std::string> words = {"bake", a.stack, "--output", folder.string(), "--lobes", a.lobes};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.push_back(option);
    words.push_back(value);
  };
  add("--dominant", a.dominant);
  add("--bits", std::to_string(a.bits));
  add("--colour", a.colour);
  add("--base", a.base);
  if (a.base == "material") add("--model", a.model);
  if (a.ridge_factor != 1.0) add("--ridge-factor", exact_number(a.ridge_factor));
  if (a.shrink != 1) add("--shrink", std::to_string(a.shrink));
  if (a.half) words.emplace_back("--half");
  if (!a.transfer.empty()) add("--transfer", a.transfer);
  if (!a.name.empty()) add("--name", a.name);
  if (a.uniform) words.emplace_back("--uniform");
  if (a.gains) words.emplace_back("--gains");
  if (a.albedo_in_modulation) words.emplace_back("--modulate-albedo");
  if (a.no_dither) words.emplace_back("--no-dither");
  if (!a.noise.empty()) add("--noise", fmt::format("{},{}", a.noise[0], a.noise[1]));
  if (a.contours) words.emplace_back("--contours");
  if (a.zip) words.emplace_back("--zip");
  add("--sample", std::to_string(a.sample_texels));
  add("--memory", std::to_string(a.memory_mib));
  add("--spill", a.spill);
  add("--fade-albedo", exact_number(a.fade_albedo));
  add("--fade-normal", exact_number(a.fade_normal_deg));
  add("--seed", std::to_string(a.seed));
  if (a.common.threads > 0) add("--threads", std::to_string(a.common.threads));
  if (a.common.force) words.emplace_back("--force");
  words.insert(words.end(), {"--no-evidence", "--no-panels", "--quiet"});
  return words;
}

int write_stack_choice(const CostPoint& point, const StackSweepOptions& options,
                       const std::filesystem::path& folder) {
  std::vector<std::string> words = bake_command_of(point, options, folder);
  std::string command_line = "brdfit";
  for (const std::string& word : words) command_line += " " + quoted_word(word);
  CLI::App program("brdfit", "brdfit");
  const Command bake = add_bake_command(program);
  std::ranges::reverse(words);  // as CLI11 takes them
  program.parse(words);
  return bake.run(command_line);
}

}  // namespace brdfit::cli
