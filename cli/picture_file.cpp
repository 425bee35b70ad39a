// Writing pictures.
#include "cli/picture_file.h"

#include <array>

#include "cli/common.h"
#include "render/figure.h"

namespace brdfit::cli {

PictureFormat picture_format_of(const std::filesystem::path& file) {
  if (file.extension() == ".png") return PictureFormat::kPng;
  if (file.extension() == ".exr") return PictureFormat::kExr;
  throw UsageError(file.string() + ": the output must end in .png (for eyes) or .exr (values)");
}

void write_picture(const std::filesystem::path& file, const render::Picture& picture,
                   const io::ImageMetadata& metadata) {
  io::write_bytes(file, io::encode_png({picture.width, picture.height, 3, picture.rgb}, metadata));
}

void write_values(const std::filesystem::path& file, const render::Image& image, io::ImageMetadata metadata) {
  std::vector<float> samples;
  samples.reserve(4 * image.pixel_count());
  for (std::size_t k = 0; k < image.pixel_count(); ++k) {
    samples.insert(samples.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * k),
                   image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * k + 3));
    samples.push_back(image.state[k] == render::PixelState::kValue ? 1.0F : 0.0F);
  }
  const std::string missing = render::describe_missing(image);
  metadata.emplace_back("brdfit:missing", missing.empty() ? "none" : missing);
  io::write_bytes(file, io::encode_exr({image.width, image.height, {"R", "G", "B", "A"}, samples}, metadata));
}

}  // namespace brdfit::cli
