// Renders of blocks, and base colours in closed form.
#include "bake/base_model.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "bake/luminance.h"
#include "brdf/simd/dispatch.h"

namespace brdfit::simd {
BRDFIT_DECLARE_SIMD(void render_chunk(const bake::RenderJob&))
BRDFIT_DECLARE_SIMD(void base_colour_chunk(const bake::BaseColourJob&))
bake::RenderFunction render_function(Isa isa) {
  return BRDFIT_PICK(isa, render_chunk);
}
bake::BaseColourFunction base_colour_function(Isa isa) {
  return BRDFIT_PICK(isa, base_colour_chunk);
}
}  // namespace brdfit::simd

namespace brdfit::bake {
namespace {

void check(const StackInfo& info, const TexelBlock& block, const Surface& surface, const LightChoice& lights,
           const BaseModel& model) {
  if (block.lights != info.lights.size() || surface.normals.size() != 3 * block.count() ||
      surface.albedo.size() != 3 * block.count()) {
    throw std::invalid_argument("base model: sizes disagree");
  }
  if (std::ranges::any_of(lights, [&](std::uint32_t k) { return k >= info.lights.size(); })) {
    throw std::invalid_argument("base model: no such light");
  }
  if (model.material && !is_affine(*model.material)) {
    throw std::invalid_argument("base model: the material is not affine in its base colour");
  }
}

simd::Coefficients with_base(Material material, double base) {
  material.set("base_color", base);
  return simd::coefficients_of(material);
}

// What the vector code needs of a model, the same for all chunks.
struct Prepared {
  simd::Coefficients black;
  simd::Coefficients white;

  explicit Prepared(const BaseModel& model) {
    if (!model.material) return;
    black = with_base(*model.material, 0.0);
    white = with_base(*model.material, 1.0);
  }

  AffineJob<float> job(const StackInfo& info, const LightColumns& lights, const float* normals) const {
    AffineJob<float> job;
    job.lights = lights;
    job.black = black;
    job.white = white;
    job.normals = normals;
    job.view[0] = static_cast<float>(info.view.x);
    job.view[1] = static_cast<float>(info.view.y);
    job.view[2] = static_cast<float>(info.view.z);
    return job;
  }
};

std::span<const std::uint32_t> texels_of(const TexelBlock& block, std::size_t first) {
  return std::span(block.texels).subspan(first, std::min(kChunk, block.count() - first));
}

}  // namespace

bool is_affine(const Material& material) {
  if (material.model() != Model::kBurley) return true;
  const bool tinted_specular =
      material.effects().has(Effect::kSpecularTint) && material.number("specular_tint") != 0.0;
  const bool tinted_sheen = material.effects().has(Effect::kSheen) && material.number("sheen") != 0.0 &&
                            material.number("sheen_tint") != 0.0;
  return !tinted_specular && !tinted_sheen;
}

std::vector<float> render_block(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                const LightChoice& lights, const BaseModel& model) {
  std::vector<float> render(lights.size() * 3 * block.count());
  render_block(info, block, surface, lights, model, render);
  return render;
}

void render_block(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                  const LightChoice& lights, const BaseModel& model, std::span<float> render) {
  check(info, block, surface, lights, model);
  const std::size_t texels = block.count();
  if (render.size() != lights.size() * 3 * texels) {
    throw std::invalid_argument("base model: sizes disagree");
  }
  const ChunkLights chunk_lights(info, lights);
  const Prepared prepared(model);
  const RenderFunction run = simd::render_function(simd::best_isa());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk_count(texels), 8), [&](const auto& range) {
    std::vector<float> at_texels;
    std::vector<float> last;
    std::array<float, 3 * kChunk> normals;
    std::array<float, 3 * kChunk> albedo;
    for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
      const std::size_t first = chunk * kChunk;
      copy_chunk(surface.normals, texels, first, normals.data());
      copy_chunk(surface.albedo, texels, first, albedo.data());
      RenderJob job;
      job.affine =
          prepared.job(info, chunk_lights.columns(texels_of(block, first), at_texels), normals.data());
      job.lambert = !model.material;
      job.albedo = albedo.data();
      const bool is_whole = first + kChunk <= texels;
      if (!is_whole) last.resize(lights.size() * 3 * kChunk);
      job.out = is_whole ? render.data() + first : last.data();
      job.channel_stride = is_whole ? texels : kChunk;
      job.light_stride = 3 * job.channel_stride;
      run(job);
      if (!is_whole) store_chunk(last.data(), lights.size() * 3, texels, first, render);
    }
  });
}

namespace {

// Base colours into surface.albedo, where the block gives none; residuals too where there is room for them.
void solve_base_colours(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                        const BaseModel& model, Surface& surface, std::span<float> residual) {
  const std::size_t texels = block.count();
  const ChunkLights chunk_lights(info, lights);
  const Prepared prepared(model);
  const BaseColourFunction run = simd::base_colour_function(simd::best_isa());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk_count(texels), 8), [&](const auto& range) {
    std::vector<float> at_texels;
    std::vector<float> padded;
    std::vector<float> last;
    std::vector<float> affine(lights.size() * 6 * kChunk);
    std::array<float, 3 * kChunk> normals;
    std::array<float, 3 * kChunk> base_colour;
    for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
      const std::size_t first = chunk * kChunk;
      copy_chunk(surface.normals, texels, first, normals.data());
      BaseColourJob job;
      job.affine =
          prepared.job(info, chunk_lights.columns(texels_of(block, first), at_texels), normals.data());
      job.affine.offset = affine.data();
      job.affine.slope = affine.data() + lights.size() * 3 * kChunk;
      job.values = chunk_values(block, lights, first, padded);
      job.robust_width = static_cast<float>(model.robust_width);
      job.base_colour = base_colour.data();
      job.is_given = !block.albedo.empty();
      if (job.is_given) copy_chunk(surface.albedo, texels, first, base_colour.data());
      for (std::size_t c = 0; c < 3; ++c) job.mix[c] = static_cast<float>(kLuminance[c]);
      const bool is_whole = first + kChunk <= texels;
      if (!residual.empty()) {
        if (!is_whole) last.resize(lights.size() * kChunk);
        job.residual = is_whole ? residual.data() + first : last.data();
        job.residual_stride = is_whole ? texels : kChunk;
      }
      run(job);
      if (!job.is_given) store_chunk(base_colour.data(), 3, texels, first, surface.albedo);
      if (!residual.empty() && !is_whole) store_chunk(last.data(), lights.size(), texels, first, residual);
    }
  });
}

}  // namespace

Surface with_base_colour(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                         const LightChoice& lights, const BaseModel& model) {
  check(info, block, surface, lights, model);
  Surface result = surface;
  if (!model.material || !block.albedo.empty()) return result;
  solve_base_colours(info, block, lights, model, result, {});
  return result;
}

Surface base_colour_and_residual(const StackInfo& info, const TexelBlock& block, Surface surface,
                                 const LightChoice& lights, const BaseModel& model,
                                 std::vector<float>& residual) {
  check(info, block, surface, lights, model);
  if (!model.material) throw std::invalid_argument("base model: Lambert has no base colour to solve");
  residual.resize(lights.size() * block.count());
  solve_base_colours(info, block, lights, model, surface, residual);
  return surface;
}

}  // namespace brdfit::bake
