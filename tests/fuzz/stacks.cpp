// OLAT manifests and light files, in a folder that has the pictures which the seeds name.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "io/json.h"
#include "io/realis_json.h"
#include "io/stack_source.h"
#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {
namespace {

namespace fs = std::filesystem;
using io::Json;
using io::StackPicture;
using io::StackSource;

// That a file is there is all that a manifest's reader asks of it.
class StackFolder {
 public:
  StackFolder() {
    for (const std::string_view name :
         {"a.png", "b.png", "c.png", "my light.png", "dark.png", "flat.png", "mask.png", "normals.exr",
          "albedo.png", "weight.png", "shadow.png"}) {
      tests::write_text(folder_ / name, "");
    }
  }
  fs::path operator/(std::string_view name) const { return folder_ / name; }

 private:
  tests::TempFolder folder_;
};

void check_light(const StackSource& source, std::size_t k) {
  const StackLight& light = source.pictures[k].light;
  require(!light.name.empty(), "a light has a name");
  require(std::all_of(light.intensity.begin(), light.intensity.end(),
                      [](double v) { return std::isfinite(v) && v > 0.0; }),
          "intensities are positive");
  if (!light.position) {
    require(is_unit(light.direction) && light.direction.z >= 0.0, "a light's direction is unit and above");
    return;
  }
  StackInfo info;
  info.width = 3;
  info.height = 2;
  info.lights = {light};
  info.plane = source.plane;
  for (std::uint32_t texel = 0; texel < info.texel_count(); ++texel) {
    const Incidence seen = incidence(info, 0, texel);
    require(is_finite(seen.direction) && is_unit(seen.direction), "a near light has a direction everywhere");
    require(std::isfinite(seen.falloff) && seen.falloff > 0.0, "a near light's falloff is finite");
  }
}

void check(const StackSource& source) {
  require(!source.pictures.empty(), "a stack has pictures");
  require(std::is_sorted(source.pictures.begin(), source.pictures.end(),
                         [](const StackPicture& a, const StackPicture& b) { return a.file < b.file; }),
          "pictures are sorted");
  for (std::size_t k = 0; k < source.pictures.size(); ++k) {
    check_light(source, k);
    const auto& exposure = source.pictures[k].exposure_seconds;
    require(!exposure || (std::isfinite(*exposure) && *exposure > 0.0), "exposures are positive");
  }
  require(is_unit(source.view) && source.view.z >= 0.0, "the view is unit and above");
  require(is_finite(source.plane.origin) && source.plane.pixel_size > 0.0, "the plane is finite");
  for (const auto& row : source.color_matrix) {
    require(std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); }),
            "the colour matrix is finite");
  }
  require(!source.chart_rms || std::isfinite(*source.chart_rms), "the chart's error is finite");
}

// As the file would say it: a chart as its matrix.
Json json_of(const StackSource& source) {
  Json json = {{"version", 1}, {"images", Json::array()}};
  const auto add = [](Json& object, const char* key, const auto& file) {
    if (file) object[key] = file->string();
  };
  for (const StackPicture& picture : source.pictures) {
    Json image = {{"file", picture.file.string()}, {"intensity", picture.light.intensity}};
    const bool is_near = picture.light.position.has_value();
    image[is_near ? "position" : "direction"] =
        io::vector_to_json(is_near ? *picture.light.position : picture.light.direction);
    if (picture.exposure_seconds) image["exposure_seconds"] = *picture.exposure_seconds;
    add(image, "weight", picture.weight);
    add(image, "shadow", picture.shadow);
    json["images"].push_back(std::move(image));
  }
  add(json, "dark", source.dark);
  add(json, "flat", source.flat);
  add(json, "mask", source.mask);
  add(json, "normals", source.normals);
  add(json, "albedo", source.albedo);
  if (source.noise) {
    json["noise"] = {{"read_deviation", source.noise->read_deviation}, {"shot", source.noise->shot}};
  }
  if (source.transfer) json["transfer"] = name_of(*source.transfer);
  json["color_matrix"] = source.color_matrix;
  json["view"] = io::vector_to_json(source.view);
  json["pixel_size"] = source.plane.pixel_size;
  json["origin"] = io::vector_to_json(source.plane.origin);
  json["units"] = source.units;
  return json;
}

bool is_near(const Json& a, const Json& b) {
  // Directions are made unit again.
  constexpr double kRounding = 1e-15;
  if (a.is_number() && b.is_number()) {
    const double larger = std::max(std::abs(a.get<double>()), std::abs(b.get<double>()));
    return std::abs(a.get<double>() - b.get<double>()) <= kRounding * std::max(larger, 1.0);
  }
  if (!a.is_structured()) return a == b;
  const auto same_member = [](const auto& x, const auto& y) {
    return x.key() == y.key() && is_near(x.value(), y.value());
  };
  const auto x = a.items();
  const auto y = b.items();
  return a.type() == b.type() && a.size() == b.size() &&
         std::equal(x.begin(), x.end(), y.begin(), same_member);
}

// Numbers as short as they come back.
std::string light_file_of(const StackSource& source) {
  std::string text = fmt::format("{}\n", source.pictures.size());
  for (const StackPicture& picture : source.pictures) {
    const Vec3& d = picture.light.direction;
    text += fmt::format("{} {} {} {}\n", picture.file.string(), d.x, d.y, d.z);
  }
  return text;
}

}  // namespace

bool run_olat(Bytes input) {
  static const StackFolder folder;
  const fs::path file = folder / "input.olat.json";
  write_input(file, input);
  const auto source = read_unless_refused([&] { return io::read_stack_source(file); });
  if (!source) return false;
  check(*source);
  const fs::path again = folder / "again.olat.json";
  io::write_json(again, json_of(*source));
  require(is_near(json_of(io::read_stack_source(again)), json_of(*source)),
          "a manifest comes back unchanged");
  return true;
}

bool run_light_file(Bytes input) {
  static const StackFolder folder;
  const fs::path file = folder / "input.lp";
  write_input(file, input);
  const auto source = read_unless_refused([&] { return io::read_stack_source(file); });
  if (!source) return false;
  check(*source);
  const fs::path again = folder / "again.lp";
  tests::write_text(again, light_file_of(*source));
  require(is_near(json_of(io::read_stack_source(again)), json_of(*source)),
          "a light file comes back unchanged");
  return true;
}

}  // namespace brdfit::fuzz
