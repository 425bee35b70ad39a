// What an OLAT manifest (olat.json) or a light file (.lp) says: pictures, lights, and how to read them.
#ifndef BRDFIT_IO_STACK_SOURCE_H_
#define BRDFIT_IO_STACK_SOURCE_H_

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/colour_chart.h"
#include "io/transfer.h"
#include "measured/image_stack.h"

namespace brdfit::io {

// One picture and its light.
struct StackPicture {
  std::filesystem::path file;
  StackLight light;  // a near light's direction is filled in when the pictures' size is known
  std::optional<double> exposure_seconds;       // > 0
  std::optional<std::filesystem::path> weight;  // how much each texel counts under this light
  std::optional<std::filesystem::path> shadow;  // how much of the light a renderer lets reach each texel
};

// What a manifest says of the camera's noise: the variance of a sensor value v (the linear value times
// exposure_seconds) is read_deviation^2 + shot v. Both >= 0.
struct StatedNoise {
  double read_deviation = 0.0;
  double shot = 0.0;
  friend bool operator==(const StatedNoise&, const StatedNoise&) = default;
};

struct StackSource {
  std::filesystem::path file;          // the manifest or light file
  std::string name;                    // of that file, without its ending
  std::vector<StackPicture> pictures;  // sorted by file name, whatever the order in the file was
  std::optional<std::filesystem::path> dark;
  std::optional<std::filesystem::path> flat;
  std::optional<std::filesystem::path> mask;
  std::optional<std::filesystem::path> normals;
  std::optional<std::filesystem::path> albedo;
  std::optional<StatedNoise> noise;
  std::optional<Transfer> transfer;  // nothing: as each picture says, else as is usual
  Matrix3 color_matrix = kIdentity3;
  std::optional<double> chart_rms;  // where the matrix was computed from a chart
  Vec3 view{0.0, 0.0, 1.0};
  ImagePlane plane;
  std::string units;  // of positions, pixel_size and origin; empty where there are none

  // The maps of one kind, per picture; and how many pictures have one.
  std::vector<std::optional<std::filesystem::path>> maps_of(
      std::optional<std::filesystem::path> StackPicture::*map) const {
    std::vector<std::optional<std::filesystem::path>> maps;
    for (const StackPicture& picture : pictures) maps.push_back(picture.*map);
    return maps;
  }
  std::size_t count_of(std::optional<std::filesystem::path> StackPicture::*map) const {
    return static_cast<std::size_t>(std::count_if(
        pictures.begin(), pictures.end(), [map](const StackPicture& p) { return (p.*map).has_value(); }));
  }
};

// A file by its ending: .lp, or JSON. Throws IoError (kInput), always one line: what cannot be read or
// parsed, unknown keys, a wrong count, pictures that are not there or named twice, a light that is below the
// surface plane or has no direction, exposures that only some pictures have, positions without pixel_size and
// origin.
StackSource read_stack_source(const std::filesystem::path& file);

// As read_stack_source, for each format. See docs/schema/olat.schema.json.
StackSource read_olat(const std::filesystem::path& file);

// First line a count, then `file x y z` per picture, where the file's name may hold spaces. A picture is
// looked for where the line says, from the light file's folder, and else under its bare name in that folder:
// light files often keep the paths of the machine that they were made on. Directions need not be unit.
StackSource read_light_positions(const std::filesystem::path& file);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_STACK_SOURCE_H_
