// Options of pictures.
#include "cli/picture_options.h"

namespace brdfit::cli {

void add_picture_arguments(CLI::App& app, PictureArguments& arguments) {
  app.add_option("--size", arguments.size, "pixels along the side of a picture")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  app.add_option("--exposure", arguments.exposure_stops, "in stops: values are multiplied by 2^EXPOSURE")
      ->check(CLI::Range(-64.0, 64.0))
      ->capture_default_str();
  app.add_option(
         "--view", arguments.view,
         "linear (clipped, 8-bit code proportional to the value), srgb (clipped, sRGB curve) or gt (Gran "
         "Turismo tone mapper, sRGB curve)")
      ->check(CLI::IsMember({"linear", "srgb", "gt"}))
      ->capture_default_str();
  app.add_option("--channel", arguments.channel, "what is shown; a single channel as grey")
      ->check(CLI::IsMember({"rgb", "red", "green", "blue", "luminance"}))
      ->capture_default_str();
}

render::ViewOptions view_options_of(const PictureArguments& arguments) {
  return {render::view_transform_by_name(arguments.view).value(), arguments.exposure_stops,
          render::channel_by_name(arguments.channel).value()};
}

void add_slice_arguments(CLI::App& app, SliceArguments& arguments) {
  app.add_option("--phi-d", arguments.phi_d_deg, "azimuth of the slice in degrees")->capture_default_str();
  app.add_option("--axis", arguments.axis, "spacing of theta_h; sqrt gives room to narrow peaks")
      ->check(CLI::IsMember({"linear", "sqrt"}))
      ->capture_default_str();
  app.add_option("--quantity", arguments.quantity, "f, or f-cos: f times the cosine of the light's angle")
      ->check(CLI::IsMember({"f", "f-cos"}))
      ->capture_default_str();
  app.add_option("--sampling", arguments.sampling,
                 "smooth (interpolated between cells) or stored (each pixel shows its cell, as the slice "
                 "measures compare)")
      ->check(CLI::IsMember({"smooth", "stored"}))
      ->capture_default_str();
  app.add_flag("--regions", arguments.regions,
               "name the regions: Fresnel, specular, retroreflection, diffuse");
}

render::SliceOptions slice_options_of(const SliceArguments& arguments, int size) {
  render::SliceOptions options;
  options.size = size;
  options.phi_d_deg = arguments.phi_d_deg;
  options.axis = arguments.axis == "sqrt" ? render::ThetaHAxis::kSquareRoot : render::ThetaHAxis::kLinear;
  options.quantity = arguments.quantity == "f-cos" ? render::Quantity::kFCos : render::Quantity::kF;
  options.sampling =
      arguments.sampling == "stored" ? render::SliceSampling::kStored : render::SliceSampling::kSmooth;
  std::string why;
  if (!options.is_valid(&why)) throw UsageError(why);
  return options;
}

}  // namespace brdfit::cli
