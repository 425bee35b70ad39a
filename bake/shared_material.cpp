// Variable projection: Ceres moves what texels share, base colours follow.
#include "bake/shared_material.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

#include "bake/luminance.h"
#include "brdf/simd/dispatch.h"
#include "fit/parameters.h"
#include "fit/solve.h"

namespace brdfit::simd {
BRDFIT_DECLARE_SIMD(void projection_chunk(const bake::ProjectionJob&))
bake::ProjectionFunction projection_function(Isa isa) {
  return BRDFIT_PICK(isa, projection_chunk);
}
}  // namespace brdfit::simd

namespace brdfit::bake {
namespace {

// A material at both ends of its base colour.
struct Ends {
  simd::Coefficients black;
  simd::Coefficients white;
};

Ends ends_of(Material material) {
  Ends ends;
  material.set("base_color", 0.0);
  ends.black = simd::coefficients_of(material);
  material.set("base_color", 1.0);
  ends.white = simd::coefficients_of(material);
  return ends;
}

// The sample in double precision, chunk by chunk.
struct Chunk {
  std::vector<double> at_texels;
  std::array<double, 3 * kChunk> normals;
  std::vector<double> value;        // [light][channel][kChunk]
  std::vector<double> sqrt_weight;  // [light][kChunk]
};

// Residuals as functions of the shared parameters, base colours solved inside.
class Projection {
 public:
  Projection(const StackInfo& info, const TexelBlock& block, const Surface& surface,
             const LightChoice& lights, double width)
      : view_(info.view),
        texels_(block.texels),
        lights_(lights.size()),
        columns_(info, lights),
        width_(width),
        project_(simd::projection_function(simd::best_isa())) {
    for (std::size_t first = 0; first < block.count(); first += kChunk) {
      add_chunk(block, surface, lights, first);
    }
  }

  double cost(const Ends& ends) const {
    std::vector<double> costs(chunks_.size());
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t k) {
      Eigen::VectorXd r(rows());
      residuals(k, ends, r.data());
      costs[k] = 0.5 * r.squaredNorm();
    });
    double sum = 0.0;
    for (const double chunk : costs) sum += chunk;
    return sum;
  }

  // at: the material at x. aside: materials a step away along each parameter, and the steps.
  struct Aside {
    Ends ends;
    double step;
  };
  Eigen::MatrixXd gram(const Ends& at, const std::vector<Aside>& aside, double* cost) const {
    const auto n = static_cast<Eigen::Index>(aside.size());
    std::vector<Eigen::MatrixXd> grams(chunks_.size());
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t k) {
      Eigen::MatrixXd j(rows(), n + 1);
      residuals(k, at, j.col(n).data());
      for (Eigen::Index p = 0; p < n; ++p) {
        const Aside& there = aside[static_cast<std::size_t>(p)];
        residuals(k, there.ends, j.col(p).data());
        j.col(p) = (j.col(p) - j.col(n)) / there.step;
      }
      grams[k] = j.transpose() * j;
    });
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (const Eigen::MatrixXd& chunk : grams) sum += chunk;
    if (cost != nullptr) *cost = 0.5 * sum(n, n);
    return sum;
  }

 private:
  Eigen::Index rows() const { return static_cast<Eigen::Index>(lights_ * 3 * kChunk); }

  void add_chunk(const TexelBlock& block, const Surface& surface, const LightChoice& lights,
                 std::size_t first) {
    Chunk chunk;
    copy_chunk(surface.normals, block.count(), first, chunk.normals.data());
    chunk.value.resize(lights_ * 3 * kChunk);
    chunk.sqrt_weight.resize(lights_ * kChunk);
    const std::size_t length = std::min(kChunk, block.count() - first);
    for (std::size_t k = 0; k < lights_; ++k) {
      for (std::size_t t = 0; t < length; ++t) {
        const double weight = block.weight_of(lights[k], first + t);
        chunk.sqrt_weight[k * kChunk + t] = std::sqrt(weight);
        for (std::size_t c = 0; c < 3; ++c) {
          const double value = weight > 0.0 ? block.plane(lights[k], c)[first + t] : 0.0;
          chunk.value[(3 * k + c) * kChunk + t] = value;
        }
      }
    }
    chunks_.push_back(std::move(chunk));
  }

  // Robust residuals of a chunk, base colours solved.
  void residuals(std::size_t k, const Ends& ends, double* r) const {
    const Chunk& chunk = chunks_[k];
    const std::size_t size = lights_ * 3 * kChunk;
    const std::size_t first = k * kChunk;
    std::vector<double> affine(2 * size);
    std::vector<double> at_texels;
    ProjectionJob job;
    job.affine.lights = columns_.columns(
        std::span(texels_).subspan(first, std::min(kChunk, texels_.size() - first)), at_texels);
    job.affine.black = ends.black;
    job.affine.white = ends.white;
    job.affine.normals = chunk.normals.data();
    job.affine.view[0] = view_.x;
    job.affine.view[1] = view_.y;
    job.affine.view[2] = view_.z;
    job.affine.offset = affine.data();
    job.affine.slope = affine.data() + size;
    job.value = chunk.value.data();
    job.root_weight = chunk.sqrt_weight.data();
    job.robust_width = width_;
    job.residual = r;
    project_(job);
  }

  Vec3 view_;
  std::vector<std::uint32_t> texels_;
  std::size_t lights_;
  ChunkLightsOf<double> columns_;
  double width_;
  ProjectionFunction project_;
  std::vector<Chunk> chunks_;
};

// The free numbers of a model on a projection, as solve() takes them.
class SharedFit {
 public:
  SharedFit(const Projection& projection, const SharedMaterialOptions& options, Effects effects)
      : projection_(projection) {
    Material start(options.model);
    start.options() = options.material_options;
    fit::FreedomOptions freedom;
    freedom.tier = options.tier;
    freedom.effects = effects;
    freedom.fixed["base_color"] = {0.5};
    for (const ParameterInfo& row : parameters_of(options.model)) {
      const bool tint = row.kind == Kind::kTint || row.name == "sheen_tint";
      if (!tint || !effects.has(row.effect)) continue;
      freedom.fixed[std::string(row.name)] = {row.name == "sheen_tint" ? 0.0 : 1.0};
    }
    parametrisation_ = fit::make_parametrisation(start, freedom);
    for (fit::FreeParameter& parameter : parametrisation_.free) {
      if (parameter.name == "roughness") parameter.lower = options.least_roughness;
    }
  }

  const fit::Parametrisation& parametrisation() const { return parametrisation_; }

  fit::Objective objective() const {
    return {[this](std::span<const double> x) { return projection_.cost(ends(x)); },
            [this](std::span<const double> x, double* cost) { return gram(x, cost); }};
  }

  Eigen::MatrixXd gram(std::span<const double> x, double* cost) const {
    constexpr double kStep = 1e-6;
    std::vector<Projection::Aside> aside;
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double size = kStep * parametrisation_.scale(k, x[k]);
      const double step = x[k] + size <= parametrisation_.free[k].upper ? size : -size;
      std::vector<double> there(x.begin(), x.end());
      there[k] += step;
      aside.push_back({ends(there), step});
    }
    return projection_.gram(ends(x), aside, cost);
  }

  // The numbers of a material, inside their bounds.
  std::vector<double> start(const Material& material) const {
    std::vector<double> x = parametrisation_.from_material(material);
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[k] = std::clamp(x[k], parametrisation_.free[k].lower, parametrisation_.free[k].upper);
    }
    return x;
  }

  Material material(std::span<const double> x) const { return parametrisation_.to_material(x); }

  fit::Solution solve(const std::vector<double>& x, int max_iterations, double tolerance) const {
    fit::SolveOptions options;
    options.max_iterations = max_iterations;
    options.function_tolerance = tolerance;
    return fit::solve_pinning(objective(), x, fit::full_box(parametrisation_), options);
  }

 private:
  Ends ends(std::span<const double> x) const { return ends_of(parametrisation_.to_material(x)); }

  const Projection& projection_;
  fit::Parametrisation parametrisation_;
};

using Values = std::map<std::string_view, double>;

// Off the neutral values, at which falloffs have no gradient; the sign turns those with two sides.
Values off_neutral(double sign) {
  return {{"metallic", 0.1},
          {"specular", 0.5},
          {"diffuse_fresnel", 1.0 + 0.5 * sign},
          {"retroreflection", 1.0 + 0.5 * sign},
          {"diffuse_fresnel_falloff", 0.75},
          {"retroreflection_falloff", 0.75},
          {"smooth_terminator", -0.3 * sign},
          {"specular_fresnel_falloff", 0.4},
          {"dual_specular_opacity", 0.3},
          {"dual_specular_roughness_scale", 2.5},
          {"subsurface", 0.3},
          {"sheen", 0.3},
          {"clearcoat", 0.3},
          {"clearcoat_gloss", 0.7}};
}

std::vector<double> start_of(const fit::Parametrisation& parametrisation, const Values& values) {
  std::vector<double> x;
  for (const fit::FreeParameter& parameter : parametrisation.free) {
    const auto at = values.find(parameter.parameter);
    const double value =
        at != values.end()
            ? at->second
            : find_parameter(parametrisation.start.model(), parameter.parameter)->default_value;
    x.push_back(std::clamp(value, parameter.lower, parameter.upper));
  }
  return x;
}

// Starts need not be followed to their ends to tell which is best.
constexpr double kExploredTolerance = 1e-4;
constexpr double kRefinedTolerance = 1e-6;

fit::Solution best_of(const SharedFit& fit, const std::vector<Values>& starts, int max_iterations) {
  fit::Solution best;
  for (const Values& start : starts) {
    fit::Solution solution =
        fit.solve(start_of(fit.parametrisation(), start), max_iterations, kExploredTolerance);
    if (best.x.empty() || solution.cost < best.cost) best = std::move(solution);
  }
  return best;
}

// Texels with a normal of their own and some light, thinned evenly.
TexelBlock sample_of(const TexelBlock& block, const Surface& surface, std::size_t at_most, Surface& sampled) {
  std::vector<std::uint32_t> usable;
  for (std::size_t t = 0; t < block.count(); ++t) {
    if (surface.state[t] == TexelState::kOk) usable.push_back(static_cast<std::uint32_t>(t));
  }
  std::vector<std::uint32_t> chosen;
  const std::size_t count = std::min(at_most, usable.size());
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(usable[k * usable.size() / count]);
  sampled = chosen_texels(surface, chosen);
  return chosen_texels(block, chosen);
}

// The robust standard deviation of Lambert's residuals.
double lambert_deviation(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                         const LightChoice& lights) {
  const std::vector<float> render = render_block(info, block, surface, lights, {});
  std::vector<float> residuals;
  double sum = 0.0;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    for (std::size_t t = 0; t < block.count(); ++t) {
      if (block.weight_of(lights[k], t) <= 0.0F) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = block.plane(lights[k], c)[t];
        sum += std::abs(value);
        residuals.push_back(std::abs(value - render[(3 * k + c) * block.count() + t]));
      }
    }
  }
  if (residuals.empty()) return 1.0;
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::ranges::nth_element(residuals, middle);
  return std::max(
      {1.4826 * static_cast<double>(*middle), 1e-4 * sum / static_cast<double>(residuals.size()), 1e-12});
}

Rgb mean_colour(const Surface& surface) {
  Rgb mean = {0.0, 0.0, 0.0};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t t = 0; t < surface.count(); ++t) mean[c] += surface.albedo[c * surface.count() + t];
    mean[c] = std::clamp(mean[c] / static_cast<double>(surface.count()), 0.0, 1.0);
  }
  return mean;
}

Effects usable_effects(const SharedMaterialOptions& options) {
  return Effects(options.effects.bits() & effects_of(options.model).bits())
      .without(Effect::kAnisotropic)
      .without(Effect::kSpecularTint);
}

}  // namespace

bool SharedMaterialOptions::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (!(robust_width > 0.0)) return fails("robust_width must be positive");
  if (!(least_roughness >= 0.01 && least_roughness < 1.0))
    return fails("least_roughness must lie in [0.01, 1)");
  if (values == 0) return fails("values must be positive");
  if (max_iterations < 1) return fails("max_iterations must be positive");
  return true;
}

namespace {

// Texels of a fit with their residuals, and what is known before it.
struct Data {
  TexelBlock sample;
  Surface surface;
  double width = 0.0;  // of the robust loss
};

Data data_of(const StackInfo& info, const TexelBlock& block, const Surface& surface,
             const LightChoice& lights, std::size_t values, std::size_t fewest_texels, double robust_width) {
  Data data;
  const std::size_t per_texel = std::max<std::size_t>(3 * lights.size(), 1);
  data.sample = sample_of(block, surface, std::max(fewest_texels, values / per_texel), data.surface);
  if (data.sample.count() == 0 || lights.empty()) return data;
  data.width = robust_width * lambert_deviation(info, data.sample, data.surface, lights);
  return data;
}

struct Found {
  Material material;
  fit::Solution solution;
};

Found explore(const Projection& projection, const SharedMaterialOptions& options) {
  // The plain highlight first: it tells where the refinements of a model begin.
  const SharedFit plain(projection, options, Effects());
  std::vector<Values> starts;
  for (const double roughness : {0.2, 0.35, 0.7}) {
    starts.push_back(off_neutral(1.0));
    starts.back()["roughness"] = roughness;
  }
  Found found;
  found.solution = best_of(plain, starts, options.max_iterations);
  found.material = plain.material(found.solution.x);
  const SharedFit full(projection, options, usable_effects(options));
  if (full.parametrisation().size() == plain.parametrisation().size()) return found;
  starts.clear();
  for (const double sign : {1.0, -1.0}) {
    starts.push_back(off_neutral(sign));
    for (const char* name : {"metallic", "specular", "roughness"}) {
      starts.back()[name] = found.material.number(name);
    }
  }
  fit::Solution refined = best_of(full, starts, options.max_iterations);
  if (!(refined.cost < found.solution.cost)) return found;
  found.material = full.material(refined.x);
  found.solution = std::move(refined);
  return found;
}

bool has_texels(const Data& data, const LightChoice& lights) {
  return data.sample.count() > 0 && !lights.empty();
}

void check(const StackInfo& info, const TexelBlock& block, const Surface& surface,
           const SharedMaterialOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("fit_shared_material: " + why);
  if (surface.count() != block.count() || block.lights != info.lights.size()) {
    throw std::invalid_argument("fit_shared_material: sizes disagree");
  }
}

constexpr std::size_t kFewestTexels = 192;
constexpr std::size_t kFewestExplored = 48;

// What a fit says of itself; the base colour is the mean of the texels'.
SharedMaterial described(const StackInfo& info, const Data& data, const LightChoice& lights,
                         const Found& found) {
  SharedMaterial result;
  result.texels = data.sample.count();
  result.lambert_rmse =
      luminance_rmse(data.sample, render_block(info, data.sample, data.surface, lights, {}), lights);
  result.model = {found.material, data.width};
  result.converged = found.solution.converged;
  result.termination = found.solution.termination;
  result.iterations = found.solution.iterations;
  const Surface coloured = with_base_colour(info, data.sample, data.surface, lights, result.model);
  result.rmse =
      luminance_rmse(data.sample, render_block(info, data.sample, coloured, lights, result.model), lights);
  result.model.material->set("base_color", mean_colour(coloured));
  return result;
}

SharedMaterial nothing_to_fit() {
  SharedMaterial result;
  result.termination = "no texel has a normal of its own";
  return result;
}

}  // namespace

SharedMaterial explore_shared_material(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                       const LightChoice& lights, const SharedMaterialOptions& options) {
  check(info, block, surface, options);
  const Data data =
      data_of(info, block, surface, lights, options.explored_values, kFewestExplored, options.robust_width);
  if (!has_texels(data, lights)) return nothing_to_fit();
  const Projection projection(info, data.sample, data.surface, lights, data.width);
  return described(info, data, lights, explore(projection, options));
}

SharedMaterial fit_shared_material(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                   const LightChoice& lights, const SharedMaterialOptions& options) {
  check(info, block, surface, options);
  std::optional<Material> start = options.start;
  if (!start) start = explore_shared_material(info, block, surface, lights, options).model.material;
  const Data data = data_of(
      info, block, surface, lights, options.values,
      std::min<std::size_t>(kFewestTexels, std::max<std::size_t>(kFewestExplored, options.values / 100)),
      options.robust_width);
  if (!start || !has_texels(data, lights)) return nothing_to_fit();
  const Projection projection(info, data.sample, data.surface, lights, data.width);
  const SharedFit full(projection, options, usable_effects(options));
  Found found;
  found.solution = full.solve(full.start(*start), options.max_iterations, kRefinedTolerance);
  found.material = full.material(found.solution.x);
  SharedMaterial result = described(info, data, lights, found);
  const fit::Identifiability seen =
      fit::identify(full.parametrisation(), found.solution.x, full.gram(found.solution.x, nullptr));
  result.parameters = fit::public_states(full.parametrisation(), found.solution.x, seen);
  std::erase_if(result.parameters, [](const auto& state) { return state.name == "base_color"; });
  return result;
}

}  // namespace brdfit::bake
