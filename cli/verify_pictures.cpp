// Pairs of directions of pictures, evaluated twice.
#include "cli/verify_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "brdf/half_diff.h"
#include "render/difference.h"
#include "render/slice.h"
#include "render/sphere.h"
#include "render/tile_panel.h"
#include "render/view.h"

namespace brdfit::cli {
namespace {

constexpr int kSize = 256;
// Of the bar: with values near 1 a difference a thousand times as strong fills it.
constexpr double kRange = 1e-3;
// Closer to the horizon than this rounding decides what is drawn, as in render/slice.h.
constexpr double kHorizon = 1e-9;

// The directions that a pixel shows; nothing beside the shape.
using PairAt = std::function<std::optional<DirectionPair>(int x, int y)>;

struct Drawn {
  render::Image processor{kSize, kSize};
  render::Image device{kSize, kSize};
};

FloatPair rounded(const DirectionPair& pair) {
  const auto as_float = [](double x) { return static_cast<float>(x); };
  return {{as_float(pair.wi.x), as_float(pair.wi.y), as_float(pair.wi.z)},
          {as_float(pair.wo.x), as_float(pair.wo.y), as_float(pair.wo.z)}};
}

Drawn draw(const Material& material, MaterialPass& pass, const PairAt& pair_at, double scale) {
  std::vector<FloatPair> pairs;
  std::vector<std::size_t> pixels;
  Drawn drawn;
  for (render::Image* image : {&drawn.processor, &drawn.device})
    std::ranges::fill(image->state, render::PixelState::kOutside);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::optional<DirectionPair> pair = pair_at(x, y);
      if (!pair) continue;
      pairs.push_back(rounded(*pair));
      pixels.push_back(static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x));
    }
  }
  std::vector<Rgb> reference(pairs.size());
  std::vector<FloatRgb> values(pairs.size());
  eval_cos_reference(material, pairs, reference);
  pass.eval_cos(material, pairs, values);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      drawn.processor.rgb[3 * pixels[k] + c] = static_cast<float>(scale * reference[k][c]);
      drawn.device.rgb[3 * pixels[k] + c] = static_cast<float>(scale * static_cast<double>(values[k][c]));
    }
    drawn.processor.state[pixels[k]] = render::PixelState::kValue;
    drawn.device.state[pixels[k]] = render::PixelState::kValue;
  }
  return drawn;
}

Drawn draw_slice(const Material& material, MaterialPass& pass) {
  render::SliceOptions options;
  options.size = kSize;
  return draw(
      material, pass,
      [&](int x, int y) -> std::optional<DirectionPair> {
        const DirectionPair pair = directions_from_half_diff(render::slice_angles(options, x, y));
        if (pair.wi.z < kHorizon || pair.wo.z < kHorizon) return {};
        return pair;
      },
      1.0);
}

// Radiance: the light's irradiance is pi.
Drawn draw_sphere(const Material& material, MaterialPass& pass, double light_angle_deg) {
  const render::Scene scene(render::Shape::kSphere, light_angle_deg, kSize);
  return draw(
      material, pass,
      [&](int x, int y) -> std::optional<DirectionPair> {
        const render::SurfacePoint point = scene.at(x, y);
        if (!point.inside) return {};
        return DirectionPair{point.wi, point.wo};
      },
      std::numbers::pi);
}

std::vector<render::Tile> row_of(const std::string& title, const Drawn& drawn) {
  const render::ViewOptions view;
  const render::Difference difference =
      render::difference_of(drawn.device, drawn.processor, render::DifferenceKind::kSigned, view);
  double largest = 0.0;
  for (const float value : difference.value)
    largest = std::max(largest, std::abs(static_cast<double>(value)));
  return {{title + ", processor", render::to_picture(drawn.processor, view), {}},
          {"device", render::to_picture(drawn.device, view), {}},
          {"difference × 1000",
           render::difference_picture(difference, render::DifferenceKind::kSigned, kRange),
           {fmt::format("largest\t{:.1e}", largest)}}};
}

}  // namespace

render::Picture verify_panel(const Material& material, const std::string& name, const std::string& device,
                             MaterialPass& pass) {
  render::TilePanel panel;
  panel.title = fmt::format("{} on {}", name, device);
  panel.description = {"Processor in double and device in single precision, sRGB, clipped at 1;",
                       "differences of luminance (device − processor) before clipping."};
  panel.range = kRange;
  panel.rows.push_back(row_of("f cos θi, φd 90°", draw_slice(material, pass)));
  for (const double angle : {0.0, 90.0, 140.0})
    panel.rows.push_back(row_of(fmt::format("light at {:.0f}°", angle), draw_sphere(material, pass, angle)));
  return render::draw_tile_panel(panel).picture;
}

}  // namespace brdfit::cli
