// Synthetic stacks: shape, light, shadow, residual and faults of a surface, one light at a time.
#include "data/synthetic/stack.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bake/lobes.h"
#include "brdf/models.h"
#include "data/synthetic/counter_random.h"
#include "data/synthetic/relief.h"
#include "data/synthetic/streams.h"

namespace brdfit::synthetic {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// Far above what any surface gives back.
constexpr double kHotValue = 1000.0;
constexpr std::size_t kTexelsAtOnce = 4096;

double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vec3 from_angles(double theta_rad, double phi_rad) {
  return {std::sin(theta_rad) * std::cos(phi_rad), std::sin(theta_rad) * std::sin(phi_rad),
          std::cos(theta_rad)};
}

bake::Cap cap_of(const LightsRecipe& lights) {
  return {{0.0, 0.0, 1.0}, lights.theta_deg * kDegree};
}

Vec3 light_direction(const LightsRecipe& lights, int k, std::uint64_t seed) {
  switch (lights.arrangement) {
    case Arrangement::kDome:
      return bake::cap_point(cap_of(lights), k, lights.count);
    case Arrangement::kRing:
      return from_angles(lights.theta_deg * kDegree, 2.0 * std::numbers::pi * k / lights.count);
    case Arrangement::kSparse:
      break;
  }
  const CounterRandom random(seed, kLightStream);
  const auto counter = static_cast<std::uint64_t>(2 * k);
  const double cos_theta = 1.0 - random.uniform(counter) * (1.0 - std::cos(lights.theta_deg * kDegree));
  return from_angles(std::acos(cos_theta), 2.0 * std::numbers::pi * random.uniform(counter + 1));
}

// Lights as they really stand.
std::vector<StackLight> lights_of(const StackRecipe& recipe, const std::string& ending) {
  std::vector<StackLight> lights(static_cast<std::size_t>(recipe.lights.count));
  for (int k = 0; k < recipe.lights.count; ++k) {
    StackLight& light = lights[static_cast<std::size_t>(k)];
    std::string number = std::to_string(k);
    number.insert(0, 4 - std::min<std::size_t>(4, number.size()), '0');
    light.name = recipe.name + '.' + number + '.' + ending;
    light.direction = light_direction(recipe.lights, k, recipe.seed);
    if (recipe.lights.distance > 0.0) {
      light.position =
          Vec3{light.direction.x * recipe.lights.distance, light.direction.y * recipe.lights.distance,
               light.direction.z * recipe.lights.distance};
    }
    light.intensity.fill(recipe.lights.intensity);
  }
  return lights;
}

// What the manifest says of them: names, or directions, exchanged and turned over.
std::vector<StackLight> as_in_manifest(std::vector<StackLight> lights, const StackFaults& faults) {
  for (const auto& [first, second] : faults.swapped) {
    std::swap(lights[static_cast<std::size_t>(first)].direction,
              lights[static_cast<std::size_t>(second)].direction);
    std::swap(lights[static_cast<std::size_t>(first)].position,
              lights[static_cast<std::size_t>(second)].position);
  }
  if (!faults.upside_down) return lights;
  for (StackLight& light : lights) {
    light.direction.y = -light.direction.y;
    if (light.position) light.position->y = -light.position->y;
  }
  return lights;
}

LobeSet lobes_of(const StackRecipe& recipe) {
  LobeSet lobes;
  for (int k = 0; k < recipe.residual.lobes; ++k) {
    lobes.push_back({bake::cap_point(cap_of(recipe.lights), k, recipe.residual.lobes),
                     recipe.residual.sharpness, std::cos(recipe.residual.cut_off_deg * kDegree)});
  }
  return lobes;
}

// Components of a direction in a frame whose z is the normal; which way x points does not matter to an
// isotropic material (Duff et al. 2017).
struct Frame {
  Vec3 x;
  Vec3 y;
  Vec3 z;
  explicit Frame(const Vec3& n) : z(n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    x = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    y = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 local(const Vec3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

Material with_black_base(Material material) {
  material.set("base_color", 0.0);
  return material;
}

}  // namespace

// Geometry and what varies over it.
struct SyntheticStack::Surface {
  explicit Surface(const StackRecipe& recipe)
      : relief(recipe.shape, recipe.width, recipe.height, recipe.seed) {
    for (const Material& material : recipe.materials) {
      black_based.push_back(recipe.albedo_variation > 0.0 ? with_black_base(material) : material);
    }
  }
  ReliefSurface relief;
  std::vector<Material> black_based;
};

SyntheticStack::SyntheticStack(StackRecipe recipe) : recipe_(std::move(recipe)) {
  std::string why;
  if (!recipe_.is_valid(&why)) throw std::invalid_argument("SyntheticStack: " + why);
  info_.name = recipe_.name;
  info_.width = recipe_.width;
  info_.height = recipe_.height;
  const double pixel = 1.0 / recipe_.width;
  info_.plane = {{-0.5 * pixel * (recipe_.width - 1), 0.5 * pixel * (recipe_.height - 1), 0.0}, pixel};
  info_.has_normals = recipe_.files.give_normals;
  info_.has_albedo = recipe_.files.give_albedo;
  true_lights_ = lights_of(recipe_, recipe_.files.format);
  info_.lights = as_in_manifest(true_lights_, recipe_.faults);
  lobes_ = lobes_of(recipe_);
  surface_ = std::make_unique<Surface>(recipe_);
}

SyntheticStack::~SyntheticStack() = default;

bool SyntheticStack::is_masked(std::uint32_t texel) const {
  return surface_->relief.is_outside(texel);
}

Vec3 SyntheticStack::normal(std::uint32_t texel) const {
  return surface_->relief.normal(texel);
}

bool SyntheticStack::in_cast_shadow(std::uint32_t texel, const Vec3& direction) const {
  return recipe_.cast_shadows && surface_->relief.is_shadowed(texel, direction);
}

std::size_t SyntheticStack::material_of(std::uint32_t texel) const {
  if (recipe_.patch_px == 0) return 0;
  const auto width = static_cast<std::uint32_t>(recipe_.width);
  const auto edge = static_cast<std::uint32_t>(recipe_.patch_px);
  const std::uint64_t patch = static_cast<std::uint64_t>(texel / width / edge) * width + texel % width / edge;
  return CounterRandom(recipe_.seed, kPatchStream).below(patch, recipe_.materials.size());
}

double SyntheticStack::shade_of_albedo(std::uint32_t texel) const {
  if (recipe_.albedo_variation == 0.0) return 1.0;
  const auto width = static_cast<std::uint32_t>(recipe_.width);
  const double wave = smooth_wave(texel % width, texel / width, 0.7 * recipe_.shape.wavelength_px,
                                  CounterRandom(recipe_.seed, kAlbedoStream), 0);
  return 1.0 - recipe_.albedo_variation * (0.5 + 0.5 * wave);
}

Rgb SyntheticStack::albedo(std::uint32_t texel) const {
  Rgb colour = recipe_.materials[material_of(texel)].colour("base_color");
  for (double& channel : colour) channel *= shade_of_albedo(texel);
  return colour;
}

double SyntheticStack::amplitude(std::uint32_t texel, std::size_t lobe) const {
  const auto width = static_cast<std::uint32_t>(recipe_.width);
  return recipe_.residual.strength * smooth_wave(texel % width, texel / width, recipe_.shape.wavelength_px,
                                                 CounterRandom(recipe_.seed, kAmplitudeStream), lobe);
}

// pi f cos_i of a run of texels that all have one material, for lights from these directions.
void SyntheticStack::reflect(std::size_t material, const Run& run, std::span<const std::uint32_t> texels,
                             std::span<Rgb> reflected) const {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  for (const std::size_t k : run.places) {
    const Frame frame(normal(texels[k]));
    wi.push_back(frame.local(run.towards[k]));
    wo.push_back(frame.local(info_.view));
  }
  std::vector<Rgb> values(wi.size());
  std::vector<Rgb> without(wi.size());
  eval_cos(recipe_.materials[material], wi, wo, values);
  if (recipe_.albedo_variation > 0.0) eval_cos(surface_->black_based[material], wi, wo, without);
  for (std::size_t k = 0; k < run.places.size(); ++k) {
    const double shade = shade_of_albedo(texels[run.places[k]]);
    for (std::size_t c = 0; c < 3; ++c) {
      const double base = recipe_.albedo_variation > 0.0 ? without[k][c] : 0.0;
      reflected[run.places[k]][c] = std::numbers::pi * (base + shade * (values[k][c] - base));
    }
  }
}

double SyntheticStack::residual(std::uint32_t texel, const Vec3& direction) const {
  double sum = 0.0;
  for (std::size_t lobe = 0; lobe < lobes_.size(); ++lobe) {
    sum += amplitude(texel, lobe) * eval(lobes_[lobe], direction);
  }
  return sum * std::max(dot(normal(texel), direction), 0.0);
}

double SyntheticStack::noisy(double value, std::size_t light, std::uint32_t texel,
                             std::size_t channel) const {
  const std::uint64_t counter = (light * info_.texel_count() + texel) * 3 + channel;
  if (recipe_.noise.multiplicative > 0.0) {
    const CounterRandom random(recipe_.seed, kMultiplicativeStream);
    value *= 1.0 + recipe_.noise.multiplicative * random.normal(counter);
  }
  if (recipe_.noise.additive > 0.0) {
    value += recipe_.noise.additive * CounterRandom(recipe_.seed, kAdditiveStream).normal(counter);
  }
  return value;
}

void SyntheticStack::add_hot_pixels(std::size_t light, std::span<const std::uint32_t> texels,
                                    std::span<float> picture) const {
  const CounterRandom place(recipe_.seed, kHotStream);
  const CounterRandom when(recipe_.seed, kHotLightStream);
  for (int which = 0; which < recipe_.faults.hot_pixels; ++which) {
    const auto pixel = static_cast<std::uint64_t>(which);
    if (when.below(pixel * info_.lights.size() + light, 4) != 0) continue;
    const auto texel = static_cast<std::uint32_t>(place.below(pixel, info_.texel_count()));
    const auto found = std::lower_bound(texels.begin(), texels.end(), texel);
    if (found == texels.end() || *found != texel) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      picture[c * texels.size() + static_cast<std::size_t>(found - texels.begin())] =
          static_cast<float>(kHotValue);
    }
  }
}

std::vector<Rgb> SyntheticStack::radiance(const StackInfo& truth, std::size_t light,
                                          std::span<const std::uint32_t> texels) const {
  std::vector<Rgb> values(texels.size(), Rgb{});
  std::vector<double> falloff;
  Run run;
  for (const std::uint32_t texel : texels) {
    const Incidence from = incidence(truth, light, texel);
    run.towards.push_back(from.direction);
    falloff.push_back(from.falloff);
  }
  for (std::size_t material = 0; material < recipe_.materials.size(); ++material) {
    run.places.clear();
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const bool lit = !is_masked(texels[k]) && material_of(texels[k]) == material &&
                       dot(normal(texels[k]), run.towards[k]) > 0.0 &&
                       !in_cast_shadow(texels[k], run.towards[k]);
      if (lit) run.places.push_back(k);
    }
    if (!run.places.empty()) reflect(material, run, texels, values);
  }
  for (std::size_t k = 0; k < texels.size(); ++k) {
    const double rest = lobes_.empty() ? 0.0 : residual(texels[k], run.towards[k]);
    for (std::size_t c = 0; c < 3; ++c) {
      values[k][c] = (values[k][c] + rest) * truth.lights[light].intensity[c] * falloff[k];
    }
  }
  return values;
}

std::vector<float> SyntheticStack::picture(std::size_t light, std::span<const std::uint32_t> texels) const {
  StackInfo truth = info_;
  truth.lights = true_lights_;
  double gain = 1.0;
  for (const auto& [which, factor] : recipe_.faults.gains) {
    if (static_cast<std::size_t>(which) == light) gain *= factor;
  }
  std::vector<float> out(3 * texels.size(), 0.0F);
  const tbb::blocked_range<std::size_t> all(0, texels.size(), kTexelsAtOnce);
  tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& some) {
    const std::span<const std::uint32_t> chunk = texels.subspan(some.begin(), some.size());
    const std::vector<Rgb> values = radiance(truth, light, chunk);
    for (std::size_t k = 0; k < chunk.size(); ++k) {
      if (is_masked(chunk[k])) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        out[c * texels.size() + some.begin() + k] =
            static_cast<float>(noisy(gain * values[k][c], light, chunk[k], c));
      }
    }
  });
  add_hot_pixels(light, texels, out);
  return out;
}

TexelBlock SyntheticStack::read_rows(int first_row, int rows) {
  if (first_row < 0 || rows < 0 || first_row + rows > info_.height) {
    throw std::invalid_argument("SyntheticStack: rows outside the picture");
  }
  const auto width = static_cast<std::size_t>(info_.width);
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(rows) * width);
  std::iota(texels.begin(), texels.end(),
            static_cast<std::uint32_t>(static_cast<std::size_t>(first_row) * width));
  return read_texels(texels);
}

TexelBlock SyntheticStack::read_texels(std::span<const std::uint32_t> texels) {
  if (std::any_of(texels.begin(), texels.end(),
                  [this](std::uint32_t k) { return k >= info_.texel_count(); })) {
    throw std::invalid_argument("SyntheticStack: texel outside the picture");
  }
  TexelBlock block;
  block.texels.assign(texels.begin(), texels.end());
  block.lights = info_.lights.size();
  for (std::size_t light = 0; light < block.lights; ++light) {
    const std::vector<float> one = picture(light, texels);
    block.rgb.insert(block.rgb.end(), one.begin(), one.end());
  }
  if (recipe_.shape.relief == Relief::kSphere) {
    block.weight.assign(block.lights * texels.size(), 1.0F);
    for (std::size_t k = 0; k < block.weight.size(); ++k) {
      if (is_masked(texels[k % texels.size()])) block.weight[k] = 0.0F;
    }
  }
  const auto fill = [&](std::vector<float>& planes, auto&& three_values) {
    planes.resize(3 * texels.size());
    for (std::size_t k = 0; k < texels.size(); ++k) {
      const std::array<double, 3> v = three_values(texels[k]);
      for (std::size_t c = 0; c < 3; ++c) planes[c * texels.size() + k] = static_cast<float>(v[c]);
    }
  };
  if (info_.has_normals) {
    fill(block.normals, [this](std::uint32_t texel) {
      const Vec3 n = normal(texel);
      return std::array{n.x, n.y, n.z};
    });
  }
  if (info_.has_albedo) fill(block.albedo, [this](std::uint32_t texel) { return albedo(texel); });
  return block;
}

}  // namespace brdfit::synthetic
