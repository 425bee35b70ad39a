// Ratios of values to renders per light, by classes of normals.
#include "bake/gains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

// The centre of the hemisphere towards the viewer, and two rings of six sectors around it.
constexpr std::size_t kClasses = 13;
constexpr std::size_t kFewestTexels = 8;
constexpr std::size_t kFewestClasses = 4;
// Values at lower cosines hang on the normal more than on the light.
constexpr double kLeastCosine = 0.25;

struct Weighted {
  double value;
  double weight;
};

// The value at which half of the weight is reached.
double median(std::vector<Weighted>& values) {
  std::ranges::sort(values, {}, &Weighted::value);
  double total = 0.0;
  for (const Weighted& v : values) total += v.weight;
  double sum = 0.0;
  for (const Weighted& v : values) {
    sum += v.weight;
    if (sum >= 0.5 * total) return v.value;
  }
  return 1.0;
}

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(half));
  const double upper = values[half];
  if (values.size() % 2 == 1) return upper;
  return 0.5 *
         (upper + *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half)));
}

// A normal's components across and along the view.
struct Slope {
  double x;
  double y;
  double along;
};

Slope slope_of(const Vec3& view, const Surface& surface, std::size_t t) {
  const std::size_t n = surface.count();
  const double v[3] = {surface.normals[t], surface.normals[n + t], surface.normals[2 * n + t]};
  const bool upright = std::abs(view.y) < 0.9;
  // Tangents of the view direction.
  const double a[3] = {upright ? view.z : 0.0, upright ? 0.0 : -view.z, upright ? -view.x : view.y};
  const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  const double b[3] = {view.y * a[2] - view.z * a[1], view.z * a[0] - view.x * a[2],
                       view.x * a[1] - view.y * a[0]};
  return {(v[0] * a[0] + v[1] * a[1] + v[2] * a[2]) / length,
          (v[0] * b[0] + v[1] * b[1] + v[2] * b[2]) / length, v[0] * view.x + v[1] * view.y + v[2] * view.z};
}

std::size_t class_of(const Slope& slope) {
  if (slope.along > 0.95) return 0;
  const double turn = std::atan2(slope.y, slope.x) / (2.0 * std::numbers::pi) + 0.5;
  const auto sector = std::min<std::size_t>(static_cast<std::size_t>(turn * 6.0), 5);
  return 1 + sector + (slope.along > 0.8 ? 0 : 6);
}

bool is_usable(const Surface& surface, std::size_t t) {
  return surface.state[t] == TexelState::kOk;
}

// The standard deviation of slopes in the direction in which they spread least.
double least_spread(const StackInfo& info, const Surface& surface) {
  double n = 0.0;
  double sums[5] = {};
  for (std::size_t t = 0; t < surface.count(); ++t) {
    if (!is_usable(surface, t)) continue;
    const Slope s = slope_of(info.view, surface, t);
    n += 1.0;
    sums[0] += s.x;
    sums[1] += s.y;
    sums[2] += s.x * s.x;
    sums[3] += s.y * s.y;
    sums[4] += s.x * s.y;
  }
  if (n < 2.0) return 0.0;
  const double xx = sums[2] / n - sums[0] * sums[0] / (n * n);
  const double yy = sums[3] / n - sums[1] * sums[1] / (n * n);
  const double xy = sums[4] / n - sums[0] * sums[1] / (n * n);
  const double smallest = 0.5 * (xx + yy - std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy));
  return std::sqrt(std::max(smallest, 0.0));
}

struct Ratio {
  double value = 1.0;
  double standard_error = 0.0;
};

// What a light's values are to its render, as classes of normals have it; none where too few see the light.
std::optional<Ratio> ratio_of(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                              const std::vector<float>& render, std::size_t row, std::uint32_t light) {
  std::array<std::vector<Weighted>, kClasses> classes;
  const std::size_t n = block.count();
  for (std::size_t t = 0; t < n; ++t) {
    const double weight = block.weight_of(light, t);
    if (weight <= 0.0 || !is_usable(surface, t)) continue;
    const Incidence at = incidence(info, light, block.texels[t]);
    const double cosine = surface.normals[t] * at.direction.x + surface.normals[n + t] * at.direction.y +
                          surface.normals[2 * n + t] * at.direction.z;
    if (cosine < kLeastCosine) continue;
    double value = 0.0;
    double shown = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      value += kLuminance[c] * block.plane(light, c)[t];
      shown += kLuminance[c] * render[(3 * row + c) * n + t];
    }
    if (shown <= 0.0) continue;
    classes[class_of(slope_of(info.view, surface, t))].push_back({value / shown, weight * shown});
  }
  std::vector<double> ratios;
  for (std::vector<Weighted>& values : classes) {
    if (values.size() >= kFewestTexels) ratios.push_back(median(values));
  }
  if (ratios.size() < kFewestClasses) return std::nullopt;
  const double middle = median(ratios);
  std::vector<double> distances;
  for (const double ratio : ratios) distances.push_back(std::abs(ratio - middle));
  // Of a median of normally distributed ratios, from their median absolute deviation.
  const double deviation = 1.4826 * median(std::move(distances));
  return Ratio{middle, 1.2533 * deviation / std::sqrt(static_cast<double>(ratios.size()))};
}

// Gains times what makes the median of those that are known 1.
void fix_gauge(std::vector<double>& gains, const std::vector<GainState>& state) {
  std::vector<double> known;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (state[k] != GainState::kNotSeen) known.push_back(gains[k]);
  }
  if (known.empty()) return;
  const double middle = median(std::move(known));
  if (!(middle > 0.0)) return;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    if (state[k] != GainState::kNotSeen) gains[k] /= middle;
  }
}

// Draws gains to 1 by how sure they are (the positive part of James and Stein's estimate, with two standard
// errors for one).
void draw_to_one(GainEstimate& estimate) {
  for (std::size_t k = 0; k < estimate.gain.size(); ++k) {
    if (estimate.state[k] == GainState::kNotSeen) continue;
    const double off = estimate.gain[k] - 1.0;
    const double doubt = 2.0 * estimate.standard_error[k];
    const double share = off == 0.0 ? 0.0 : 1.0 - doubt * doubt / (off * off);
    estimate.gain[k] = 1.0 + std::max(share, 0.0) * off;
    estimate.state[k] = share > 0.0 ? GainState::kOk : GainState::kUnsure;
  }
}

// One round: the gains that the surface found with the last ones asks for; the largest change of any.
double refine(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
              const GainOptions& options, GainEstimate& estimate) {
  // A gain of 0 would leave a light without say for good.
  constexpr double kLeast = 1e-3;
  const StackInfo gained = with_gains(info, estimate.gain);
  Surface surface = photometric_stereo(gained, block, lights, options.stereo);
  surface = with_base_colour(gained, block, surface, lights, options.model);
  const std::vector<float> render = render_block(gained, block, surface, lights, options.model);
  std::vector<double> gains = estimate.gain;
  for (std::size_t row = 0; row < lights.size(); ++row) {
    const std::uint32_t light = lights[row];
    const auto ratio = ratio_of(info, block, surface, render, row, light);
    estimate.state[light] = ratio ? GainState::kOk : GainState::kNotSeen;
    gains[light] = ratio ? std::max(estimate.gain[light] * ratio->value, kLeast) : 1.0;
    estimate.standard_error[light] = ratio ? estimate.gain[light] * ratio->standard_error : 0.0;
  }
  fix_gauge(gains, estimate.state);
  double change = 0.0;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    change = std::max(change, std::abs(gains[k] / estimate.gain[k] - 1.0));
  }
  estimate.gain = std::move(gains);
  return change;
}

}  // namespace

bool GainOptions::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (rounds < 1) return fails("rounds must be positive");
  if (!(tolerance > 0.0)) return fails("tolerance must be positive");
  if (!(least_spread >= 0.0)) return fails("least_spread must not be negative");
  return stereo.is_valid(why);
}

std::string_view name_of(GainState state) {
  switch (state) {
    case GainState::kOk:
      return "ok";
    case GainState::kUnsure:
      return "unsure";
    case GainState::kNotSeen:
      return "not seen";
  }
  return "";
}

GainEstimate estimate_gains(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                            const GainOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("estimate_gains: " + why);
  GainEstimate estimate;
  estimate.gain.assign(info.lights.size(), 1.0);
  estimate.standard_error.assign(info.lights.size(), 0.0);
  estimate.state.assign(info.lights.size(), GainState::kNotSeen);
  const Surface surface = photometric_stereo(info, block, lights, options.stereo);
  if (least_spread(info, surface) < options.least_spread) {
    estimate.is_flat = true;
    return estimate;
  }
  for (estimate.rounds = 1; estimate.rounds < options.rounds; ++estimate.rounds) {
    if (refine(info, block, lights, options, estimate) < options.tolerance) break;
  }
  draw_to_one(estimate);
  return estimate;
}

StackInfo with_gains(StackInfo info, const std::vector<double>& gains) {
  if (gains.size() != info.lights.size()) throw std::invalid_argument("with_gains: sizes disagree");
  for (std::size_t k = 0; k < gains.size(); ++k) {
    for (double& channel : info.lights[k].intensity) channel *= gains[k];
  }
  return info;
}

}  // namespace brdfit::bake
