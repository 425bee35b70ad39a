// Rows of an asset through the device and through the processor.
#include "cli/verify_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "cli/asset_files.h"
#include "gpu/error_tally.h"
#include "gpu/realis_pass.h"
#include "io/realis_json.h"

namespace brdfit::cli {
namespace {

constexpr int kLights = 16;
constexpr int kRowsAtOnce = 64;
// Of the sum of a texel's absolute amplitudes, where that is above 1: what single precision loses grows with
// what cancels.
constexpr double kAllowed = 1e-6;
// Under every other light the surface is not what was baked, so that the correction fades.
constexpr float kOtherAlbedo = 0.8F;

// Rounded to float, as the device has them.
std::vector<RealisLight> lights_of(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<RealisLight> lights;
  for (int k = 0; k < kLights; ++k) {
    const double z = uniform(random);
    const double phi = 2.0 * std::numbers::pi * uniform(random);
    const double s = std::sqrt(1.0 - z * z);
    const auto as_float = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    lights.push_back(
        {{as_float(s * std::cos(phi)), as_float(s * std::sin(phi)), as_float(z)}, {1.0, 1.0, 1.0}});
  }
  return lights;
}

// A texture's bytes as the device reads them: the four of a texel in one word, red lowest.
std::vector<std::uint32_t> words_of(const bake::PackedTexels& bytes) {
  std::vector<std::uint32_t> words;
  for (const std::vector<std::uint8_t>& texture : bytes.textures) {
    for (std::size_t at = 0; at < texture.size(); at += 4) {
      std::uint32_t word = 0;
      for (std::size_t b = 0; b < 4; ++b) word |= static_cast<std::uint32_t>(texture[at + b]) << (8 * b);
      words.push_back(word);
    }
  }
  return words;
}

std::vector<std::uint32_t> masks_of(const bake::PackedTexels& bytes, std::size_t count) {
  std::vector<std::uint32_t> masks;
  if (bytes.mask.empty()) return masks;
  const std::size_t channels = bytes.mask.size() / count;
  for (std::size_t k = 0; k < count; ++k) {
    std::uint32_t mask = 0;
    for (std::size_t b = 0; b < channels; ++b)
      mask |= static_cast<std::uint32_t>(bytes.mask[k * channels + b]) << (8 * b);
    masks.push_back(mask);
  }
  return masks;
}

double largest_sum(const RealisAsset& asset, const bake::RunTimeTexels& texels) {
  const std::size_t count = texels.surface.count();
  double largest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    double sum = 0.0;
    for (std::size_t plane = 0; plane < asset.plane_count(); ++plane)
      sum += std::abs(static_cast<double>(texels.amplitudes[plane * count + k]));
    largest = std::max(largest, sum);
  }
  return largest;
}

struct Found {
  explicit Found(const ErrorThreshold& t) : errors(t) {}
  ErrorTally errors;
  // Where the largest error is.
  std::size_t worst_texel = 0;  // y * width + x
  Vec3 worst_light;
  double largest_correction = 0.0;
  std::optional<double> device_ns = 0.0;
  std::uint64_t texels = 0;
};

class Verification {
 public:
  Verification(const VerifyRequest& request, ComputeDevice& device)
      : asset_(io::read_realis(request.file)),
        reader_(asset_, std::filesystem::path(request.file).parent_path(), true),
        pass_(device),
        lights_(lights_of(request.seed)) {}

  const RealisAsset& asset() const { return asset_; }

  Found run() {
    Found found({std::numeric_limits<double>::infinity(), 0.0, kAllowed});
    for (int row = 0; row < asset_.height; row += kRowsAtOnce) {
      if (interrupted()) throw std::runtime_error("interrupted");
      compare(reader_.read(row, std::min(kRowsAtOnce, asset_.height - row)), row, found);
    }
    return found;
  }

 private:
  void compare(bake::RunTimeTexels texels, int first_row, Found& found) {
    const std::size_t count = texels.surface.count();
    const std::vector<std::uint32_t> codes = words_of(reader_.packed_bytes());
    const std::vector<std::uint32_t> masks = masks_of(reader_.packed_bytes(), count);
    const double scale = std::max(1.0, largest_sum(asset_, texels));
    const std::vector<float> albedo = texels.surface.albedo;
    std::vector<float> values(3 * count);
    for (std::size_t light = 0; light < lights_.size(); ++light) {
      const float factor = light % 2 == 0 ? 1.0F : kOtherAlbedo;
      std::transform(albedo.begin(), albedo.end(), texels.surface.albedo.begin(),
                     [factor](float a) { return factor * a; });
      const RealisTexels view = {count,
                                 codes,
                                 masks,
                                 texels.surface.normals,
                                 texels.surface.albedo,
                                 texels.baked.normals,
                                 texels.baked.albedo,
                                 texels.chroma};
      const auto ns = pass_.correction(asset_, view, lights_[light], values);
      found.device_ns = ns && found.device_ns ? std::optional(*found.device_ns + *ns) : std::nullopt;
      const std::vector<double> reference = bake::correction(asset_, texels, lights_[light]);
      for (std::size_t k = 0; k < values.size(); ++k) {
        found.largest_correction = std::max(found.largest_correction, std::abs(reference[k]));
        // In units of what cancels.
        if (!found.errors.add(reference[k] / scale, static_cast<float>(values[k] / scale)).worst) continue;
        found.worst_texel =
            k % count + static_cast<std::size_t>(first_row) * static_cast<std::size_t>(asset_.width);
        found.worst_light = lights_[light].direction;
      }
      found.texels += count;
    }
  }

  RealisAsset asset_;
  AssetReader reader_;
  RealisPass pass_;
  std::vector<RealisLight> lights_;
};

io::Json found_json(const Found& found, const VerifyRequest& request, const RealisAsset& asset,
                    const ComputeDevice& device) {
  const auto width = static_cast<std::size_t>(asset.width);
  const LogHistogram& errors = found.errors.absolute();
  return {{"brdfit_verify_realis", 1},
          {"file", request.file},
          {"device", device.name()},
          {"device_is_processor", device.is_processor()},
          {"lights", kLights},
          {"seed", request.seed},
          {"texels", found.texels},
          {"allowed", kAllowed},
          {"largest_correction", found.largest_correction},
          {"error",
           {{"median", errors.percentile(0.5)}, {"p99", errors.percentile(0.99)}, {"max", errors.maximum()}}},
          {"worst",
           {{"x", found.worst_texel % width},
            {"y", found.worst_texel / width},
            {"light", {found.worst_light.x, found.worst_light.y, found.worst_light.z}}}},
          {"over", found.errors.over()},
          {"not_finite", found.errors.not_finite()},
          {"device_ns_per_texel", found.device_ns && found.texels > 0
                                      ? io::Json(*found.device_ns / static_cast<double>(found.texels))
                                      : io::Json(nullptr)},
          {"passed", found.errors.over() == 0}};
}

}  // namespace

bool is_baked_asset(const std::string& file) {
  return file.ends_with(".realis.json");
}

int verify_bake(const VerifyRequest& request, ComputeDevice& device) {
  Verification verification(request, device);
  const Found found = verification.run();
  const RealisAsset& asset = verification.asset();
  const LogHistogram& errors = found.errors.absolute();
  if (request.common.json) {
    fmt::print("{}\n", found_json(found, request, asset, device).dump(2));
  } else if (!request.common.quiet) {
    fmt::print("{}: {} of {} lobes in {} bits on {}{}, {} texels under {} lights\n", asset.name,
               asset.packing.dominant, asset.lobes.size(), asset.packing.bits, device.name(),
               device.is_processor() ? " (the processor)" : "", asset.texel_count(), kLights);
    fmt::print(
        "error of the correction against double: median {:.2g}, 99% {:.2g}, largest {:.2g}; allowed {:g}, "
        "times the sum of absolute amplitudes where that exceeds 1\n",
        errors.percentile(0.5), errors.percentile(0.99), errors.maximum(), kAllowed);
    fmt::print("the largest correction is {:.3g}{}\n", found.largest_correction,
               found.device_ns ? fmt::format("; {:.1f} ns per texel and light on the device",
                                             *found.device_ns / static_cast<double>(found.texels))
                               : "");
    fmt::print("worst: texel {}, {} under light {:.9g},{:.9g},{:.9g}\n",
               found.worst_texel % static_cast<std::size_t>(asset.width),
               found.worst_texel / static_cast<std::size_t>(asset.width), found.worst_light.x,
               found.worst_light.y, found.worst_light.z);
    fmt::print("{} of {} values are beyond that, {} of them not finite\n", found.errors.over(),
               3 * found.texels, found.errors.not_finite());
  }
  return found.errors.over() == 0 ? kDone : kNotAllDone;
}

}  // namespace brdfit::cli
