// Pictures read for nothing.
#include "io/decode_floor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <system_error>
#include <vector>

#include "io/image_reader.h"

namespace brdfit::io {
namespace {

constexpr int kRowsAtOnce = 16;
// Of the memory that is free, and of the folder: others need some too.
constexpr double kShare = 0.5;

void decode(const std::filesystem::path& file) {
  ImageReader reader(file);
  const ImageHeader& header = reader.header();
  std::vector<std::byte> rows(kRowsAtOnce * header.row_bytes());
  for (int first = 0; first < header.height; first += kRowsAtOnce) {
    const int count = std::min(kRowsAtOnce, header.height - first);
    reader.read_native(first, count,
                       std::span(rows).first(static_cast<std::size_t>(count) * header.row_bytes()));
  }
}

}  // namespace

void decode_all(const StackSource& source) {
  // Maps of floats take longest: begun last, they would leave the other cores idle.
  std::vector<std::filesystem::path> files;
  for (const auto& frame : {source.dark, source.flat, source.mask, source.normals, source.albedo}) {
    if (frame) files.push_back(*frame);
  }
  for (const StackPicture& picture : source.pictures) files.push_back(picture.file);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, files.size(), 1),
      [&](const auto& some) {
        for (std::size_t k = some.begin(); k < some.end(); ++k) decode(files[k]);
      },
      tbb::simple_partitioner());
}

bool pays_to_spill(const StackSource& source) {
  const ImageReader reader(source.pictures.front().file);
  const ImageHeader& header = reader.header();
  if (header.format != "jpeg" && header.format != "png") return false;
  const double bytes =
      static_cast<double>(header.row_bytes()) * header.height * static_cast<double>(source.pictures.size());
  const double memory =
      static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  std::error_code error;
  const std::filesystem::space_info folder =
      std::filesystem::space(std::filesystem::temp_directory_path(), error);
  return !error && bytes <= kShare * memory && bytes <= kShare * static_cast<double>(folder.available);
}

}  // namespace brdfit::io
