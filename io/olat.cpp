// OLAT manifests (olat.json).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "io/json.h"
#include "io/stack_picture.h"
#include "io/stack_source.h"

namespace brdfit::io {
namespace {

namespace fs = std::filesystem;
using Side = IoError::Side;

constexpr double kLargest = 1e9;
// Of a near light above the plane, in pixels: nearer ones would have no direction at a texel below them.
constexpr double kLeastHeight = 1e-3;

bool are_numbers(const Json& value, std::size_t count) {
  return value.is_array() && value.size() == count &&
         std::all_of(value.begin(), value.end(), [](const Json& item) {
           return item.is_number() && std::abs(item.get<double>()) <= kLargest;
         });
}

std::array<double, 3> three_numbers(ObjectReader& reader, std::string_view key) {
  const Json& value = reader.member(key);
  if (!are_numbers(value, 3)) reader.fail(key, "is something else", "three numbers");
  return value.get<std::array<double, 3>>();
}

Vec3 vector_of(ObjectReader& reader, std::string_view key) {
  const auto v = three_numbers(reader, key);
  return {v[0], v[1], v[2]};
}

// A direction that must be unit, so that a position given under the wrong key is noticed.
Vec3 unit_vector(ObjectReader& reader, std::string_view key) {
  const Vec3 v = vector_of(reader, key);
  const double length = std::hypot(v.x, v.y, v.z);
  constexpr double kTolerance = 0.01;
  if (std::abs(length - 1.0) > kTolerance) {
    reader.fail(key, fmt::format("has length {:.4g}", length), "a unit vector");
  }
  return light_direction(v, reader.file(), fmt::format("'{}'", reader.place(key)));
}

class Manifest {
 public:
  explicit Manifest(const fs::path& file)
      : file_(file), json_(read_json(file)), root_(json_, file.string()) {}

  StackSource read() {
    StackSource source;
    source.file = file_;
    // lion of lion.olat.json too.
    const fs::path stem = file_.stem();
    source.name = (stem.extension() == ".olat" ? stem.stem() : stem).string();
    root_.integer("version", 1, 1);
    read_images(source);
    source.dark = optional_file(root_, "dark", "the dark frame");
    source.flat = optional_file(root_, "flat", "the flat frame");
    source.mask = optional_file(root_, "mask", "the mask");
    source.normals = optional_file(root_, "normals", "the normal map");
    source.albedo = optional_file(root_, "albedo", "the albedo map");
    read_noise(source);
    read_encoding(source);
    if (root_.has("view")) source.view = unit_vector(root_, "view");
    read_plane(source);
    root_.finish();
    check_exposures(source);
    settle_pictures(source.pictures, root_.file());
    return source;
  }

 private:
  void read_images(StackSource& source) {
    const Json& images = root_.member("images");
    if (!images.is_array() || images.empty()) root_.fail("images", "holds no list", "one object per picture");
    for (std::size_t k = 0; k < images.size(); ++k) {
      ObjectReader image(images[k], root_.file(), fmt::format("images[{}]", k));
      source.pictures.push_back(read_image(image));
      image.finish();
    }
  }

  StackPicture read_image(ObjectReader& image) const {
    StackPicture picture;
    picture.file = file_.parent_path() / image.string("file");
    require_file(picture.file, root_.file(), fmt::format("'{}'", image.place("file")), "the picture");
    if (image.has("direction") == image.has("position")) {
      image.fail("direction", image.has("position") ? "stands beside 'position'" : "is missing",
                 "either 'direction' or 'position'");
    }
    if (image.has("direction")) picture.light.direction = unit_vector(image, "direction");
    if (image.has("position")) picture.light.position = vector_of(image, "position");
    if (image.has("intensity")) {
      picture.light.intensity = three_numbers(image, "intensity");
      const Rgb& intensity = picture.light.intensity;
      if (!std::all_of(intensity.begin(), intensity.end(), [](double v) { return v > 0.0; })) {
        image.fail("intensity", "is not above 0", "three positive numbers");
      }
    }
    if (image.has("exposure_seconds")) {
      picture.exposure_seconds = image.number("exposure_seconds", 1e-9, 1e6);
    }
    picture.weight = optional_file(image, "weight", "the weight map");
    picture.shadow = optional_file(image, "shadow", "the shadow map");
    return picture;
  }

  // The file that a member names; nothing where it is absent.
  std::optional<fs::path> optional_file(ObjectReader& reader, std::string_view key,
                                        const std::string& what) const {
    if (!reader.has(key)) return {};
    const fs::path wanted = file_.parent_path() / reader.string(key);
    require_file(wanted, root_.file(), fmt::format("'{}'", reader.place(key)), what);
    return wanted;
  }

  void read_noise(StackSource& source) {
    if (!root_.has("noise")) return;
    ObjectReader noise = root_.object("noise");
    StatedNoise stated;
    stated.read_deviation = noise.number("read_deviation", 0.0, kLargest, 0.0);
    stated.shot = noise.number("shot", 0.0, kLargest, 0.0);
    noise.finish();
    source.noise = stated;
  }

  void read_encoding(StackSource& source) {
    if (root_.has("transfer")) {
      const std::string text = root_.string("transfer");
      source.transfer = transfer_from(text);
      if (!source.transfer) root_.fail("transfer", fmt::format("is '{}'", text), std::string(kTransferNames));
    }
    if (root_.has("color_matrix") && root_.has("chart")) {
      root_.fail("chart", "stands beside 'color_matrix'", "one of the two");
    }
    if (root_.has("color_matrix")) source.color_matrix = read_matrix();
    if (root_.has("chart")) read_chart(source);
  }

  Matrix3 read_matrix() {
    const Json& rows = root_.member("color_matrix");
    const bool fits =
        rows.is_array() && rows.size() == 3 &&
        std::all_of(rows.begin(), rows.end(), [](const Json& row) { return are_numbers(row, 3); });
    if (!fits) root_.fail("color_matrix", "is something else", "three rows of three numbers");
    return rows.get<Matrix3>();
  }

  void read_chart(StackSource& source) {
    const Json& patches = root_.member("chart");
    const bool fits =
        patches.is_array() && patches.size() == kChartPatches &&
        std::all_of(patches.begin(), patches.end(), [](const Json& patch) { return are_numbers(patch, 3); });
    const std::string expected = "24 linear camera colours of three numbers, from dark skin to black";
    if (!fits) root_.fail("chart", "is something else", expected);
    try {
      const auto camera = patches.get<std::array<Rgb, kChartPatches>>();
      const ChartFit fit = fit_chart(camera);
      source.color_matrix = fit.matrix;
      source.chart_rms = fit.rms;
    } catch (const std::invalid_argument& error) {
      root_.fail("chart", std::string("cannot be used: ") + error.what(), expected);
    }
  }

  void read_plane(StackSource& source) {
    const bool is_near = std::any_of(source.pictures.begin(), source.pictures.end(),
                                     [](const StackPicture& p) { return p.light.position.has_value(); });
    for (const char* key : {"pixel_size", "origin", "units"}) {
      if (is_near && !root_.has(key)) root_.fail(key, "is missing", "it where lights have a 'position'");
    }
    if (root_.has("pixel_size")) source.plane.pixel_size = root_.number("pixel_size", 1e-9, kLargest);
    if (root_.has("origin")) source.plane.origin = vector_of(root_, "origin");
    source.units = root_.string("units", "");
    for (const StackPicture& picture : source.pictures) {
      const double least = source.plane.origin.z + kLeastHeight * source.plane.pixel_size;
      if (!picture.light.position || picture.light.position->z > least) continue;
      throw IoError(
          Side::kInput, root_.file(),
          fmt::format("the light of {} is below the surface plane (z {}, plane {})",
                      picture.file.filename().string(), picture.light.position->z, source.plane.origin.z),
          fmt::format("a position above it, by {} pixels at least", kLeastHeight));
    }
  }

  void check_exposures(const StackSource& source) const {
    const auto has = [](const StackPicture& p) { return p.exposure_seconds.has_value(); };
    const auto& pictures = source.pictures;
    if (std::all_of(pictures.begin(), pictures.end(), has) ||
        std::none_of(pictures.begin(), pictures.end(), has))
      return;
    const auto without = std::find_if_not(pictures.begin(), pictures.end(), has);
    throw IoError(Side::kInput, root_.file(),
                  fmt::format("{} has no exposure_seconds, others have", without->file.filename().string()),
                  "it for every picture or for none");
  }

  fs::path file_;
  Json json_;
  ObjectReader root_;
};

}  // namespace

StackSource read_olat(const fs::path& file) {
  return Manifest(file).read();
}

}  // namespace brdfit::io
