// Chunks handed to the vector code, and the state of each texel.
#include "bake/photometric_stereo.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "bake/luminance.h"
#include "brdf/simd/dispatch.h"

namespace brdfit::simd {
BRDFIT_DECLARE_SIMD(void stereo_chunk(const bake::StereoJob&))
bake::StereoFunction stereo_function(Isa isa) {
  return BRDFIT_PICK(isa, stereo_chunk);
}
}  // namespace brdfit::simd

namespace brdfit::bake {
namespace {

void check(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
           const StereoOptions& options) {
  std::string why;
  if (!options.is_valid(&why)) throw std::invalid_argument("photometric_stereo: " + why);
  const std::size_t texels = block.count();
  const bool fits = block.lights == info.lights.size() && block.rgb.size() == block.lights * 3 * texels &&
                    (block.weight.empty() || block.weight.size() == block.lights * texels) &&
                    (block.normals.empty() || block.normals.size() == 3 * texels) &&
                    (block.albedo.empty() || block.albedo.size() == 3 * texels);
  if (!fits) throw std::invalid_argument("photometric_stereo: sizes disagree");
  if (std::ranges::any_of(lights, [&](std::uint32_t k) { return k >= info.lights.size(); })) {
    throw std::invalid_argument("photometric_stereo: no such light");
  }
}

// Lights of any colour show a grey texel alike: each channel is divided by the light's share in it.
struct Grey {
  std::vector<float> factor;
  std::vector<float> intensity;
  std::vector<float> direction;  // times intensity
};

Grey grey_of(const StackInfo& info, const LightChoice& lights) {
  Grey grey;
  for (const std::uint32_t light : lights) {
    const Rgb& colour = info.lights[light].intensity;
    double luminance = 0.0;
    double seen = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (colour[c] > 0.0) seen += kLuminance[c];
      luminance += kLuminance[c] * std::max(colour[c], 0.0);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double factor = colour[c] > 0.0 ? kLuminance[c] / seen * luminance / colour[c] : 0.0;
      grey.factor.push_back(static_cast<float>(factor));
    }
    grey.intensity.push_back(static_cast<float>(luminance));
    const Vec3& towards = info.lights[light].direction;
    for (const double part : {towards.x, towards.y, towards.z}) {
      grey.direction.push_back(static_cast<float>(luminance * part));
    }
  }
  return grey;
}

// Memory of one worker.
struct Workspace {
  std::vector<float> at_texels;
  std::vector<float> padded;
  std::vector<float> scratch;
  std::array<float, 3 * kChunk> given;
  std::array<float, 7 * kChunk> out;
};

}  // namespace

std::string_view name_of(TexelState state) {
  switch (state) {
    case TexelState::kOk:
      return "ok";
    case TexelState::kWeakNormal:
      return "weak normal";
    case TexelState::kTurned:
      return "turned";
    case TexelState::kFewLights:
      return "few lights";
    case TexelState::kBlack:
      return "black";
    case TexelState::kUnlit:
      return "unlit";
  }
  return "";
}

bool StereoOptions::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (absolute_rounds < 0 || robust_rounds < 0) return fails("rounds must not be negative");
  if (!(robust_width > 0.0)) return fails("robust_width must be positive");
  if (!(slope_deviation > 0.0)) return fails("slope_deviation must be positive");
  if (!(least_cosine > 0.0 && least_cosine < 1.0)) return fails("least_cosine must lie between 0 and 1");
  return true;
}

Surface photometric_stereo(const StackInfo& info, const TexelBlock& block, const LightChoice& lights,
                           const StereoOptions& options) {
  check(info, block, lights, options);
  const std::size_t texels = block.count();
  Surface surface;
  surface.state.assign(texels, TexelState::kOk);
  if (!block.normals.empty() && !block.albedo.empty()) {
    surface.normals = block.normals;
    surface.albedo = block.albedo;
    return surface;
  }
  surface.normals.resize(3 * texels);
  surface.albedo.resize(3 * texels);
  const ChunkLights chunk_lights(info, lights);
  const Grey grey = grey_of(info, lights);
  const StereoFunction solve = simd::stereo_function(simd::best_isa());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chunk_count(texels), 8), [&](const auto& range) {
    Workspace work;
    work.scratch.resize(2 * std::max<std::size_t>(lights.size(), 1) * kChunk);
    for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
      const std::size_t first = chunk * kChunk;
      StereoJob job;
      job.lights = chunk_lights.columns(
          std::span(block.texels).subspan(first, std::min(kChunk, texels - first)), work.at_texels);
      job.values = chunk_values(block, lights, first, work.padded);
      job.grey = grey.factor.data();
      job.grey_intensity = grey.intensity.data();
      job.scaled_direction = grey.direction.data();
      if (!block.normals.empty()) {
        copy_chunk(block.normals, texels, first, work.given.data());
        job.given_normals = work.given.data();
      }
      job.view[0] = static_cast<float>(info.view.x);
      job.view[1] = static_cast<float>(info.view.y);
      job.view[2] = static_cast<float>(info.view.z);
      job.absolute_rounds = options.absolute_rounds;
      job.robust_rounds = options.robust_rounds;
      job.robust_width = static_cast<float>(options.robust_width);
      job.slope_deviation = static_cast<float>(options.slope_deviation);
      job.least_cosine = static_cast<float>(options.least_cosine);
      job.scratch = work.scratch.data();
      job.normals = work.out.data();
      job.albedo = job.normals + 3 * kChunk;
      job.state = job.albedo + 3 * kChunk;
      solve(job);
      store_chunk(job.normals, 3, texels, first, surface.normals);
      store_chunk(job.albedo, 3, texels, first, surface.albedo);
      for (std::size_t t = 0; t < std::min(kChunk, texels - first); ++t) {
        surface.state[first + t] = static_cast<TexelState>(job.state[t]);
      }
    }
  });
  if (!block.albedo.empty()) surface.albedo = block.albedo;
  return surface;
}

}  // namespace brdfit::bake
