// The options of bake, and what they ask for.
#include "cli/bake_options.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "bake/shrunk_stack.h"
#include "io/realis_json.h"
#include "io/transfer.h"

namespace brdfit::cli {
namespace {

// A whole number in [lower, upper], or nothing.
std::optional<int> whole_number(const std::string& text, int lower, int upper) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < lower || value > upper)
    return std::nullopt;
  return value;
}

}  // namespace

void add_bake_options(CLI::App& app, BakeArguments& a) {
  app.add_option("stack", a.stack, "olat.json, or a light file (.lp)")->required();
  app.add_option("-o,--output", a.output, "folder for the asset")->capture_default_str()->take_last();
  app.add_option("--name", a.name, "of the asset; the stack's where it is not given")->take_last();
  app.add_option(
         "--transfer", a.transfer,
         fmt::format("how pixels encode light, in place of what the stack says: {}", io::kTransferNames))
      ->take_last();
  app.add_option("--lobes", a.lobes, "how many, or auto: by held-out error")
      ->capture_default_str()
      ->take_last();
  app.add_option("--lobe-set", a.lobe_set,
                 "lobes, ridge and ranges of codes of another asset (NAME.realis.json), as they are")
      ->take_last();
  app.add_flag(
      "--lobes-only", a.lobes_only,
      "of the lobe set the lobes alone: ridge and ranges of codes are found on a sample of this stack");
  app.add_flag("--uniform", a.uniform, "lobes spread evenly over the lights, not optimised");
  app.add_option("--colour", a.colour, "what amplitudes hold")
      ->check(CLI::IsMember({"luminance", "scaled-chroma", "rgb"}))
      ->capture_default_str()
      ->take_last();
  app.add_option("--base", a.base, "what is rendered before the correction; auto: by held-out error")
      ->check(CLI::IsMember({"auto", "lambert", "material"}))
      ->capture_default_str()
      ->take_last();
  app.add_option("--model", a.model, "of the material that all texels share")
      ->check(CLI::IsMember({"callisto", "burley", "lambert-ggx"}))
      ->capture_default_str()
      ->take_last();
  app.add_option("--ridge-factor", a.ridge_factor,
                 "what the ridge that is chosen is multiplied by: above 1 holds amplitudes back more")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->take_last();
  app.add_option("--shrink", a.shrink,
                 "bake squares of so many texels a side as one: smaller textures, sooner")
      ->check(CLI::Range(1, bake::kMostShrink))
      ->capture_default_str()
      ->take_last();
  app.add_flag("--gains", a.gains, "estimate how much brighter each light is than the stack says");
  app.add_flag("--modulate-albedo", a.albedo_in_modulation, "the correction is multiplied by the albedo too");
  app.add_option("--bits", a.bits, "of a packed amplitude")
      ->check(CLI::IsMember({4, 8}))
      ->capture_default_str()
      ->take_last();
  app.add_option("--dominant", a.dominant, "lobes kept per texel, or all")
      ->capture_default_str()
      ->take_last();
  app.add_flag("--no-dither", a.no_dither, "round packed amplitudes to the nearest code");
  app.add_flag("--half", a.half, "amplitudes in the EXR as halves instead of floats");
  app.add_flag("--no-evidence", a.no_evidence,
               "no held-out errors, which cost a bake of the sample for each fold");
  app.add_option("--folds", a.folds,
                 "of lights held out; 0: each by itself up to 24 lights, else about ten at a time")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str()
      ->take_last();
  CLI::Option* panels = app.add_option(
      "--panels", a.panels,
      "lights to draw as held out, beside their capture, with other sizes of Realis below: worst, "
      "median, best, all, a picture's name with or without its ending, or its place from 0; "
      "repeatable. Costs a bake of about 384 x 384 texels for each fold, and several for each "
      "light. Without it worst, median and best are drawn where there is evidence, without other "
      "sizes");
  panels->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--no-panels", a.no_panels, "no pictures of held-out lights, and no map of where Realis helps")
      ->excludes(panels);
  app.add_option("--sample", a.sample_texels, "texels on which choices are made and evidence is taken")
      ->check(CLI::Range(64, 10000000))
      ->capture_default_str()
      ->take_last();
  app.add_option("--memory", a.memory_mib, "MiB to use, about")
      ->check(CLI::Range(16, 1 << 20))
      ->capture_default_str()
      ->take_last();
  app.add_option("--spill", a.spill,
                 "keep decoded pixels in a temporary file between the passes; auto: where that is faster")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str()
      ->take_last();
  app.add_option(
         "--noise", a.noise,
         "READ,SHOT: a sensor value v has the variance READ^2 + SHOT v, and counts by its inverse; in "
         "place of what the stack says")
      ->delimiter(',')
      ->expected(2);
  app.add_flag(
      "--contours", a.contours,
      "texels between the shadow contours of a photograph and of its render count less; costs a pass "
      "over the pictures and a temporary file");
  app.add_flag(
      "--zip", a.zip,
      "compress EXR files and the PNG files of codes, which takes longer than the bake and saves little");
  app.add_flag("--timings", a.timings,
               "print the time of each phase in units of decoding alone, and peak memory");
  app.add_flag("--fresh", a.fresh,
               "begin anew, where the same command would go on from what an interrupted bake has left in "
               "NAME.realis.part");
  app.add_option("--stop-after", a.stop_after,
                 "stop as Ctrl-C does when the plan, one fold more, the evidence, one strip more, or the "
                 "textures are done; the same command goes on from there")
      ->check(CLI::IsMember({"plan", "fold", "evidence", "strip", "textures"}))
      ->take_last();
  app.add_option("--fade-albedo", a.fade_albedo, "distance in linear albedo at which the correction is gone")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->take_last();
  app.add_option("--fade-normal", a.fade_normal_deg, "angle in degrees at which the correction is gone")
      ->check(CLI::Range(1e-3, 180.0))
      ->capture_default_str()
      ->take_last();
  app.add_option("--seed", a.seed, "of the starts of the lobe search")->capture_default_str()->take_last();
  add_common_options(app, a.common, true);
}

bake::BakeSettings bake_settings_of(const BakeArguments& a) {
  bake::BakeSettings settings;
  settings.optimise = !a.uniform;
  settings.colour = *realis_colour_by_name(a.colour);
  settings.model = *model_by_name(a.model);
  settings.base = a.base == "auto"      ? bake::BaseKind::kAuto
                  : a.base == "lambert" ? bake::BaseKind::kLambert
                                        : bake::BaseKind::kMaterial;
  settings.ridge_factor = a.ridge_factor;
  settings.gains = a.gains;
  settings.albedo_in_modulation = a.albedo_in_modulation;
  settings.seed = a.seed;
  if (!a.lobe_set.empty()) {
    const RealisAsset set = io::read_realis(a.lobe_set);
    settings.given_lobes = set.lobes;
    settings.lobes = static_cast<int>(set.lobes.size());
    if (!a.lobes_only && set.penalty && *set.penalty > 0.0) settings.given_penalty = set.penalty;
    return settings;
  }
  if (a.lobes_only) throw UsageError("--lobes-only says what to take of a --lobe-set");
  const std::optional<int> count = a.lobes == "auto" ? 0 : whole_number(a.lobes, 1, bake::kMaxLobes);
  if (!count)
    throw UsageError(fmt::format("--lobes {} is neither auto nor in [1, {}]", a.lobes, bake::kMaxLobes));
  settings.lobes = *count;
  return settings;
}

std::vector<RealisRange> given_ranges(const BakeArguments& a, const bake::BakeSettings& settings) {
  if (!settings.given_penalty) return {};
  const RealisAsset set = io::read_realis(a.lobe_set);
  const bool is_rgb = settings.colour == RealisColour::kRgb;
  const bool fits = is_rgb == (set.colour == RealisColour::kRgb) && set.packing.bits == a.bits;
  return fits ? set.packing.ranges : std::vector<RealisRange>();
}

int dominant_of(const BakeArguments& a, int lobes) {
  if (a.dominant == "all") return lobes;
  const std::optional<int> count = whole_number(a.dominant, 1, bake::kMaxLobes);
  if (!count)
    throw UsageError(fmt::format("--dominant {} is neither all nor in [1, {}]", a.dominant, bake::kMaxLobes));
  return std::min(*count, lobes);
}

}  // namespace brdfit::cli
