// Albedo and normals from pictures, in place of what was baked.
#include "cli/run_time_surface.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "io/error.h"
#include "io/frame_image.h"

namespace brdfit::cli {
namespace {

// Normals that are made unit again move by as much.
constexpr float kRounding = 1e-6F;

std::optional<io::FrameImage> open(const std::filesystem::path& file,
                                   const std::optional<io::Transfer>& transfer, const io::FrameSize& size) {
  if (file.empty()) return {};
  return io::FrameImage(file, transfer, size);
}

}  // namespace

class RunTimeSurface::Impl {
 public:
  Impl(const RealisAsset& asset, const RunTimeSurfaceFiles& files)
      : scale_(files.albedo_scale),
        width_(asset.width),
        albedo_(open(files.albedo, {}, {asset.width, asset.height, asset.name + ".realis.json"})),
        normals_(
            open(files.normals, io::Transfer{}, {asset.width, asset.height, asset.name + ".realis.json"})) {}

  void replace(bake::RunTimeTexels& texels, int first_row, int rows) {
    const io::PixelChoice choice = {first_row, rows, {}};
    if (albedo_) texels.surface.albedo = read_albedo(choice);
    scale_albedo(texels.surface.albedo);
    if (normals_) replace_normals(texels, choice);
  }

 private:
  std::vector<float> read_albedo(const io::PixelChoice& choice) {
    io::Unusable unusable;
    std::vector<float> albedo = albedo_->values(choice, unusable);
    const std::size_t count = choice.count(width_);
    if (unusable.non_finite > 0) fail(choice, unusable.pixels.front(), "is not finite");
    for (std::size_t k = 0; k < albedo.size(); ++k) {
      if (albedo[k] < 0.0F) fail(choice, k % count, fmt::format("holds {:.4g}", albedo[k]));
    }
    return albedo;
  }

  void fail(const io::PixelChoice& choice, std::size_t pixel, const std::string& found) const {
    const auto width = static_cast<std::size_t>(width_);
    throw io::IoError(io::IoError::Side::kInput, albedo_->name(),
                      fmt::format("pixel ({}, {}) {}", pixel % width,
                                  static_cast<std::size_t>(choice.first_row) + pixel / width, found),
                      "an albedo of 0 or more");
  }

  void scale_albedo(std::vector<float>& albedo) const {
    const std::size_t count = albedo.size() / 3;
    for (std::size_t k = 0; k < albedo.size(); ++k) {
      albedo[k] = static_cast<float>(scale_[k / count] * static_cast<double>(albedo[k]));
    }
  }

  void replace_normals(bake::RunTimeTexels& texels, const io::PixelChoice& choice) {
    const std::vector<float> read = normals_->unit_vectors(choice);
    std::vector<float>& normals = texels.surface.normals;
    const std::size_t count = choice.count(width_);
    for (std::size_t k = 0; k < count; ++k) {
      const auto differs = [&](std::size_t c) {
        return std::abs(read[c * count + k] - normals[c * count + k]) > kRounding;
      };
      const bool is_normal = read[k] != 0.0F || read[count + k] != 0.0F || read[2 * count + k] != 0.0F;
      if (!is_normal || (!differs(0) && !differs(1) && !differs(2))) continue;
      for (std::size_t c = 0; c < 3; ++c) normals[c * count + k] = read[c * count + k];
    }
  }

  Rgb scale_;
  int width_;
  std::optional<io::FrameImage> albedo_;
  std::optional<io::FrameImage> normals_;
};

RunTimeSurface::RunTimeSurface(const RealisAsset& asset, const RunTimeSurfaceFiles& files)
    : impl_(std::make_unique<Impl>(asset, files)) {}

RunTimeSurface::~RunTimeSurface() = default;

void RunTimeSurface::replace(bake::RunTimeTexels& texels, int first_row, int rows) {
  impl_->replace(texels, first_row, rows);
}

}  // namespace brdfit::cli
