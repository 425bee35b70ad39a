// Pictures to files: the format by the file's ending.
#ifndef BRDFIT_CLI_PICTURE_FILE_H_
#define BRDFIT_CLI_PICTURE_FILE_H_

#include <filesystem>
#include <string>

#include "io/image_file.h"
#include "render/image.h"

namespace brdfit::cli {

enum class PictureFormat { kPng, kExr };

// Of "x.png" or "x.exr"; throws UsageError for other endings.
PictureFormat picture_format_of(const std::filesystem::path& file);

void write_picture(const std::filesystem::path& file, const render::Picture& picture,
                   const io::ImageMetadata& metadata);

// Values with an alpha channel that is 1 where there is a value; the counts of other pixels are added to the
// metadata.
void write_values(const std::filesystem::path& file, const render::Image& image, io::ImageMetadata metadata);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_PICTURE_FILE_H_
