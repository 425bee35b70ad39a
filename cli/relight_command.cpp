// brdfit relight: a baked asset under a light from anywhere.
#include <fmt/format.h>

#include <cmath>

#include "bake/reconstruct.h"
#include "cli/asset_files.h"
#include "cli/common.h"
#include "cli/picture_file.h"
#include "cli/run_time_surface.h"
#include "cli/threads.h"
#include "io/realis_json.h"
#include "render/view.h"

namespace brdfit::cli {
namespace {

constexpr int kRowsAtOnce = 64;

struct Arguments {
  CommonOptions common;
  std::string asset;
  std::string output;
  std::vector<double> light{0.0, 0.0, 1.0};
  std::vector<double> intensity{1.0, 1.0, 1.0};
  std::string albedo;
  std::string normals;
  std::vector<double> albedo_scale{1.0, 1.0, 1.0};
  bool base_only = false;
  bool unpacked = false;
  double exposure_stops = 0.0;
};

void require_not_negative(const std::vector<double>& values, const std::string& option) {
  for (const double value : values) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw UsageError(fmt::format("{} holds {}, not a number of 0 or more", option, value));
    }
  }
}

RealisLight light_of(const Arguments& a) {
  require_not_negative(a.intensity, "--intensity");
  const double length = std::hypot(a.light[0], a.light[1], a.light[2]);
  if (!(length > 0.0) || !std::isfinite(length)) throw UsageError("--light is no direction");
  return {{a.light[0] / length, a.light[1] / length, a.light[2] / length},
          {a.intensity[0], a.intensity[1], a.intensity[2]}};
}

RunTimeSurface surface_of(const Arguments& a, const RealisAsset& asset) {
  require_not_negative(a.albedo_scale, "--albedo-scale");
  return RunTimeSurface(asset,
                        {a.albedo, a.normals, {a.albedo_scale[0], a.albedo_scale[1], a.albedo_scale[2]}});
}

void write_relit(const std::filesystem::path& file, const render::Image& image, double exposure_stops) {
  if (picture_format_of(file) == PictureFormat::kExr) {
    write_values(file, image, {{"brdfit:encoding", "linear Rec.709"}});
    return;
  }
  render::ViewOptions view;
  view.exposure_stops = exposure_stops;
  write_picture(file, render::to_picture(image, view), {});
}

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  const RealisLight light = light_of(a);
  const RealisAsset asset = io::read_realis(a.asset);
  const std::filesystem::path file = a.output.empty() ? asset.name + ".relit.png" : a.output;
  prepare_output(file, a.common.force);
  AssetReader reader(asset, std::filesystem::path(a.asset).parent_path(), !a.unpacked);
  RunTimeSurface surface = surface_of(a, asset);
  render::Image image(asset.width, asset.height);
  std::fill(image.state.begin(), image.state.end(), render::PixelState::kValue);
  for (int row = 0; row < asset.height; row += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, asset.height - row);
    bake::RunTimeTexels texels = reader.read(row, rows);
    surface.replace(texels, row, rows);
    const bake::Relit relit = bake::relight(asset, texels, light);
    const std::vector<float>& planes = a.base_only ? relit.render : relit.corrected;
    const std::size_t count = planes.size() / 3;
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(asset.width);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t c = 0; c < 3; ++c) image.rgb[(first + k) * 3 + c] = planes[c * count + k];
    }
  }
  write_relit(file, image, a.exposure_stops);
  if (a.common.json) {
    fmt::print("{}\n", io::Json{{"file", file.string()}, {"light", a.light}}.dump(2));
  } else if (!a.common.quiet) {
    fmt::print("{}\n", file.string());
  }
  return kDone;
}

}  // namespace

Command add_relight_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("relight", "a baked asset under a light from anywhere");
  app->footer(
      "Example: brdfit relight baked/lion.realis.json --light 0.5,0.2,0.8 -o lion.png\n"
      "writes the render with the Realis correction; .exr for linear values.");
  app->add_option("asset", a->asset, "NAME.realis.json")->required();
  app->add_option("-o,--output", a->output,
                  "PNG for eyes or EXR for values; NAME.relit.png where it is not given")
      ->take_last();
  app->add_option("--light", a->light, "x,y,z towards the light: x right, y up, z towards the viewer")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  app->add_option("--intensity", a->intensity, "linear red,green,blue")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  app->add_option(
         "--albedo", a->albedo,
         "picture of the asset's size: the albedo at run time. The correction fades as it leaves the "
         "baked one (bake --fade-albedo)")
      ->take_last();
  app->add_option(
         "--normals", a->normals,
         "picture of the asset's size: the normals at run time, as floats or n * 0.5 + 0.5; likewise "
         "(bake --fade-normal)")
      ->take_last();
  app->add_option("--albedo-scale", a->albedo_scale, "red,green,blue that the albedo is multiplied by")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  app->add_flag("--base", a->base_only, "the render alone, without Realis");
  app->add_flag("--unpacked", a->unpacked, "amplitudes from the EXR instead of the packed codes");
  app->add_option("--exposure", a->exposure_stops, "stops, for PNG")->capture_default_str()->take_last();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
