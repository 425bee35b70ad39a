// The dielectric alternative of a candidate.
#include "fit/metallic.h"

#include <fmt/format.h>

#include <algorithm>

#include "brdf/kernel/fresnel.h"
#include "fit/descend.h"

namespace brdfit::fit {
namespace {

constexpr double kVisibleMetallic = 0.005;
// A dielectric whose loss is higher by less than this share is kept instead of a metal.
constexpr double kSameLoss = 0.01;
// The least f0 of bare metals in their brightest channel, with a margin (Akenine-Moeller et al. 2018,
// Real-Time Rendering, table 9.2: titanium 0.54).
constexpr double kMetalF0 = 0.45;
// A metal whose loss is less than a third of the dielectric's has been told apart by the measurement.
constexpr double kDecidedExcess = 2.0;
constexpr DescentOptions kDielectric = {30, 1e-6, 1e-4};

double f0_of(const Material& material, double base_color) {
  return kernel::metallic_f0(base_color, material.number("metallic"), material.number("specular"));
}

double largest_f0(const Material& material) {
  double largest = 0.0;
  for (const double base : material.colour("base_color")) largest = std::max(largest, f0_of(material, base));
  return largest;
}

// The same diffuse albedo and the same mean f0 with metallic 0, as far as ranges allow.
Material as_dielectric(const Material& material) {
  Material copy = material;
  Rgb base = material.colour("base_color");
  double mean_f0 = 0.0;
  for (double& channel : base) {
    mean_f0 += f0_of(material, channel) / 3.0;
    channel *= 1.0 - material.number("metallic");
  }
  copy.set("base_color", base);
  copy.set("metallic", 0.0);
  copy.set("specular", std::min(mean_f0 / 0.08, 1.0));
  return copy;
}

}  // namespace

Decided decide_metallic(const Problem& problem, const Candidate& candidate) {
  Decided decided;
  decided.candidate = candidate;
  const Parametrisation& parametrisation = problem.parametrisation();
  const auto found = std::ranges::find(parametrisation.free, "metallic", &FreeParameter::name);
  if (found == parametrisation.free.end()) return decided;
  const auto at = static_cast<std::size_t>(found - parametrisation.free.begin());
  const double metallic = candidate.solution.x[at];
  if (metallic < kVisibleMetallic) return decided;
  const Material metal = parametrisation.to_material(candidate.solution.x);
  Candidate dielectric = candidate;
  dielectric.box.moves[at] = false;
  const std::vector<double> start = parametrisation.from_material(as_dielectric(metal));
  dielectric.solution = descend(problem, start, dielectric.box, kDielectric);
  decided.evaluations = dielectric.solution.evaluations;
  const double excess = dielectric.solution.cost / std::max(candidate.solution.cost, 1e-300) - 1.0;
  const double f0 = largest_f0(metal);
  if (excess <= kSameLoss) {
    decided.candidate = std::move(dielectric);
    decided.metallic_undecided = true;
    decided.note = fmt::format(
        "metallic and specular cannot be told apart: metallic 0 fits as well as {:.2f} (loss {:+.1f}%) and "
        "was kept",
        metallic, 100.0 * excess);
  } else if (f0 < kMetalF0 && excess <= kDecidedExcess) {
    decided.note = fmt::format(
        "metallic and specular cannot be told apart: f0 is {:.2f} at most, below that of bare metals (about "
        "0.5), so "
        "metallic {:.2f} stands in for something else; without it the loss is {:.1f}% higher (--fix "
        "metallic=0)",
        f0, metallic, 100.0 * excess);
  }
  return decided;
}

}  // namespace brdfit::fit
