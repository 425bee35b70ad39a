// Choices of a bake, their names and their options.
#include "cli/cost/stack_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "bake/shrunk_stack.h"
#include "brdf/models.h"

namespace brdfit::cli {
namespace {

constexpr const char* kHalf = "half";
constexpr const char* kFloat = "float";

std::string name_of(bake::AmplitudeBits bits) {
  if (bits == bake::AmplitudeBits::kHalf) return kHalf;
  if (bits == bake::AmplitudeBits::kFloat) return kFloat;
  return fmt::format("{}", static_cast<int>(bits));
}

std::string title_of(const StackChoice& choice) {
  std::string title = fmt::format("{} lobes", choice.lobes);
  if (choice.dominant < choice.lobes) title += fmt::format(", {} kept", choice.dominant);
  const std::string bits = name_of(choice.bits);
  title += choice.is_code()                            ? fmt::format(", {} bits", bits)
           : choice.bits == bake::AmplitudeBits::kHalf ? ", halves"
                                                       : ", floats";
  if (choice.colour != RealisColour::kLuminance) title += fmt::format(", {}", brdfit::name_of(choice.colour));
  title += fmt::format(" over {}", choice.base ? brdfit::name_of(*choice.base) : "lambert");
  if (choice.ridge_factor != 1.0) title += fmt::format(", ridge x {:g}", choice.ridge_factor);
  if (choice.shrink != 1) title += fmt::format(", at 1/{} of the size", choice.shrink);
  return title;
}

template <class Number>
Number number_of(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw std::invalid_argument(fmt::format("a choice of a bake: '{}' is no number", text));
  }
  return value;
}

class Plan {
 public:
  explicit Plan(StackChoice around) : around_(around) { add("default", around); }

  // The default with something changed.
  template <class Change>
  void vary(const std::string& sweep, const Change& change) {
    StackChoice choice = around_;
    change(choice);
    add(sweep, choice);
  }

  std::vector<PlannedChoice> take() { return std::move(choices_); }

 private:
  void add(const std::string& sweep, const StackChoice& choice) {
    if (std::ranges::find(choices_, choice, &PlannedChoice::choice) != choices_.end()) return;
    choices_.push_back({title_of(choice), sweep, choice});
  }

  StackChoice around_;
  std::vector<PlannedChoice> choices_;
};

}  // namespace

double StackChoice::bytes_per_texel(const StackInfo& whole) const {
  RealisAsset asset;
  asset.lobes.resize(static_cast<std::size_t>(lobes));
  asset.colour = colour;
  asset.packing.bits = static_cast<int>(bits);
  asset.packing.dominant = dominant;
  const auto shrunk = [this](int size) { return static_cast<double>((size + shrink - 1) / shrink); };
  return asset.bytes_per_texel() * shrunk(whole.width) * shrunk(whole.height) /
         static_cast<double>(whole.texel_count());
}

std::vector<std::pair<std::string, std::string>> settings_of(const StackChoice& choice) {
  std::vector<std::pair<std::string, std::string>> settings = {
      {"lobes", fmt::format("{}", choice.lobes)},
      {"dominant", fmt::format("{}", choice.dominant)},
      {"bits", name_of(choice.bits)},
      {"colour", std::string(brdfit::name_of(choice.colour))},
      {"base", choice.base ? "material" : "lambert"}};
  if (choice.base) settings.emplace_back("model", std::string(brdfit::name_of(*choice.base)));
  settings.emplace_back("ridge-factor", fmt::format("{}", choice.ridge_factor));
  settings.emplace_back("shrink", fmt::format("{}", choice.shrink));
  return settings;
}

StackChoice choice_of(const CostPoint& point) {
  StackChoice choice;
  choice.lobes = number_of<int>(setting_of(point, "lobes"));
  choice.dominant = number_of<int>(setting_of(point, "dominant"));
  const std::string bits = setting_of(point, "bits");
  choice.bits = bits == kHalf    ? bake::AmplitudeBits::kHalf
                : bits == kFloat ? bake::AmplitudeBits::kFloat
                : bits == "4"    ? bake::AmplitudeBits::k4
                                 : bake::AmplitudeBits::k8;
  const std::optional<RealisColour> colour = realis_colour_by_name(setting_of(point, "colour"));
  if (!colour) throw std::invalid_argument("a choice of a bake: no colour");
  choice.colour = *colour;
  if (setting_of(point, "base") == "material") choice.base = model_by_name(setting_of(point, "model"));
  choice.ridge_factor = number_of<double>(setting_of(point, "ridge-factor"));
  choice.shrink = number_of<int>(setting_of(point, "shrink"));
  return choice;
}

BakeArguments with_choice(BakeArguments arguments, const StackChoice& choice) {
  arguments.lobes = fmt::format("{}", choice.lobes);
  arguments.dominant = fmt::format("{}", choice.dominant);
  arguments.bits = choice.is_code() ? static_cast<int>(choice.bits) : 8;
  arguments.half = choice.bits == bake::AmplitudeBits::kHalf;
  arguments.colour = brdfit::name_of(choice.colour);
  arguments.base = choice.base ? "material" : "lambert";
  if (choice.base) arguments.model = brdfit::name_of(*choice.base);
  arguments.ridge_factor = choice.ridge_factor;
  arguments.shrink = choice.shrink;
  return arguments;
}

std::vector<PlannedChoice> plan_choices(std::optional<Model> base, std::optional<Model> other_base,
                                        bool quick) {
  StackChoice around;
  around.base = base;
  Plan plan(around);
  const std::vector<int> counts = quick ? std::vector<int>{4, 8} : std::vector<int>{2, 4, 6, 8, 12, 16};
  for (const int lobes : counts) {
    plan.vary("lobes", [&](StackChoice& c) { c.lobes = c.dominant = lobes; });
  }
  for (const bake::AmplitudeBits bits :
       {bake::AmplitudeBits::k4, bake::AmplitudeBits::kHalf, bake::AmplitudeBits::kFloat}) {
    plan.vary("bits", [&](StackChoice& c) { c.bits = bits; });
  }
  for (const int kept : quick ? std::vector<int>{4} : std::vector<int>{1, 2, 4, 6}) {
    plan.vary("dominant", [&](StackChoice& c) { c.dominant = kept; });
  }
  for (const RealisColour colour : {RealisColour::kScaledChroma, RealisColour::kRgb}) {
    plan.vary("colour", [&](StackChoice& c) { c.colour = colour; });
  }
  for (const double factor :
       quick ? std::vector<double>{10.0} : std::vector<double>{0.01, 0.1, 10.0, 100.0}) {
    plan.vary("ridge-factor", [&](StackChoice& c) { c.ridge_factor = factor; });
  }
  plan.vary("base", [&](StackChoice& c) { c.base = other_base; });
  for (const int shrink : quick ? std::vector<int>{2} : std::vector<int>{2, 4}) {
    plan.vary("shrink", [&](StackChoice& c) { c.shrink = shrink; });
  }
  if (quick) return plan.take();
  for (const int lobes : counts) {
    plan.vary("lobes, 4 bits", [&](StackChoice& c) {
      c.lobes = c.dominant = lobes;
      c.bits = bake::AmplitudeBits::k4;
    });
  }
  for (const int lobes : counts) {
    plan.vary("lobes, half kept", [&](StackChoice& c) {
      c.lobes = lobes;
      c.dominant = lobes / 2;
    });
  }
  for (const int lobes : counts) {
    plan.vary("lobes, half kept, 4 bits", [&](StackChoice& c) {
      c.lobes = lobes;
      c.dominant = lobes / 2;
      c.bits = bake::AmplitudeBits::k4;
    });
  }
  return plan.take();
}

}  // namespace brdfit::cli
