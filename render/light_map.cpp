// One list of shapes, drawn as SVG or with its edges smoothed into pixels.
#include "render/light_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "render/canvas.h"
#include "render/plot.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr std::size_t kFewLights = 24;
constexpr double kHead = 56.0, kFoot = 44.0, kSide = 40.0;
constexpr Colour8 kWhite = {255, 255, 255};
constexpr Colour8 kGrid = {221, 221, 221};
constexpr Colour8 kFrame = {68, 68, 68};
// Okabe and Ito 2008.
constexpr Colour8 kLight = {0, 114, 178};
constexpr Colour8 kSuspect = {213, 94, 0};

// A disc (inner 0) or a ring.
struct Ring {
  double x, y, inner, outer;
  Colour8 colour;
  std::string tooltip;
};

struct Label {
  double x, y;
  std::string text;
  int size_px;
  AlignX align;
  bool is_bold;
};

struct Scene {
  int width, height;
  std::vector<Ring> rings;
  std::vector<Label> labels;
};

Scene scene_of(const std::vector<MappedLight>& lights, const LightMapOptions& options) {
  if (options.width_px < 320)
    throw std::invalid_argument("map of lights: the width must be 320 pixels or more");
  const double radius = 0.5 * options.width_px - kSide;
  Scene scene;
  scene.width = options.width_px;
  scene.height = static_cast<int>(kHead + 2.0 * radius + kFoot + 24.0);
  const double cx = 0.5 * options.width_px, cy = kHead + radius;
  for (int height = 15; height < 90; height += 15) {
    const double r = radius * std::cos(height * kDegree);
    scene.rings.push_back({cx, cy, r - 0.5, r + 0.5, kGrid, ""});
    if (height % 30 == 0)
      scene.labels.push_back({cx + 3.0, cy - r - 3.0, fmt::format("{}°", height), 12, AlignX::kLeft, false});
  }
  scene.rings.push_back({cx, cy, radius - 0.7, radius + 0.7, kFrame, ""});
  scene.labels.push_back({cx + radius + 6.0, cy + 5.0, "x", 15, AlignX::kLeft, true});
  scene.labels.push_back({cx, cy - radius - 6.0, "y", 15, AlignX::kCentre, true});
  const double dot = std::clamp(60.0 / std::sqrt(static_cast<double>(lights.size()) + 1.0), 3.0, 7.0);
  for (const bool is_suspect : {false, true}) {
    for (const MappedLight& light : lights) {
      if (light.is_suspect != is_suspect) continue;
      const double x = cx + radius * light.direction.x, y = cy - radius * light.direction.y;
      scene.rings.push_back(
          {x, y, light.is_near ? dot - 2.0 : 0.0, dot, is_suspect ? kSuspect : kLight, light.label});
      if (!is_suspect && lights.size() > kFewLights) continue;
      const bool is_right = light.direction.x > 0.6;
      scene.labels.push_back({x + (is_right ? -dot - 3.0 : dot + 3.0), y + 4.0, light.label, 11,
                              is_right ? AlignX::kRight : AlignX::kLeft, false});
    }
  }
  scene.labels.push_back({0.5 * options.width_px, 24.0, options.title, 17, AlignX::kCentre, true});
  scene.labels.push_back(
      {0.5 * options.width_px, scene.height - 18.0, options.note, 13, AlignX::kCentre, false});
  return scene;
}

std::string hex(const Colour8& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b);
}

// How much of a pixel a ring covers, by the distance of the pixel's centre: exact enough for an edge.
double cover(const Ring& ring, double x, double y) {
  const double distance = std::hypot(x - ring.x, y - ring.y);
  const double outside = std::clamp(ring.outer - distance + 0.5, 0.0, 1.0);
  const double inside = ring.inner > 0.0 ? std::clamp(ring.inner - distance + 0.5, 0.0, 1.0) : 0.0;
  return outside - inside;
}

void draw_ring(Picture& picture, const Ring& ring) {
  const auto first = [](double v) { return std::max(0, static_cast<int>(std::floor(v)) - 1); };
  const int right = std::min(picture.width, static_cast<int>(ring.x + ring.outer) + 3);
  const int bottom = std::min(picture.height, static_cast<int>(ring.y + ring.outer) + 3);
  for (int y = first(ring.y - ring.outer); y < bottom; ++y) {
    for (int x = first(ring.x - ring.outer); x < right; ++x) {
      const double share = cover(ring, x + 0.5, y + 0.5);
      if (share <= 0.0) continue;
      const std::uint8_t colour[] = {ring.colour.r, ring.colour.g, ring.colour.b};
      std::uint8_t* pixel =
          picture.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                    static_cast<std::size_t>(x));
      for (int c = 0; c < 3; ++c) {
        pixel[c] = static_cast<std::uint8_t>(std::lround(share * colour[c] + (1.0 - share) * pixel[c]));
      }
    }
  }
}

}  // namespace

std::string light_map_svg(const std::vector<MappedLight>& lights, const LightMapOptions& options) {
  const Scene scene = scene_of(lights, options);
  Svg svg(scene.width, scene.height, options.title.empty() ? "Lights" : options.title,
          fmt::format("{} light directions on the hemisphere seen from above", lights.size()));
  svg.rect({0.0, 0.0}, scene.width, scene.height, R"(fill="#fff")");
  svg.begin_group(kPlotFont);
  for (const Ring& ring : scene.rings) {
    const double middle = 0.5 * (ring.inner + ring.outer);
    const std::string style = ring.inner > 0.0 ? fmt::format(R"(fill="none" stroke="{}" stroke-width="{}")",
                                                             hex(ring.colour), ring.outer - ring.inner)
                                               : fmt::format(R"(class="light" fill="{}")", hex(ring.colour));
    svg.circle({ring.x, ring.y}, ring.inner > 0.0 ? middle : ring.outer, style, ring.tooltip);
  }
  for (const Label& label : scene.labels) {
    const char* anchor = label.align == AlignX::kLeft    ? "start"
                         : label.align == AlignX::kRight ? "end"
                                                         : "middle";
    svg.text({label.x, label.y}, label.text,
             fmt::format(R"(font-size="{}" text-anchor="{}"{})", label.size_px, anchor,
                         label.is_bold ? R"( font-weight="bold")" : ""));
  }
  svg.end_group();
  return svg.finish();
}

Picture light_map_picture(const std::vector<MappedLight>& lights, const LightMapOptions& options) {
  const Scene scene = scene_of(lights, options);
  Picture shapes(scene.width, scene.height);
  std::fill(shapes.rgb.begin(), shapes.rgb.end(), std::uint8_t{255});
  for (const Ring& ring : scene.rings) draw_ring(shapes, ring);
  Canvas canvas(scene.width, scene.height, kWhite);
  canvas.paste(shapes, 0, 0);
  for (const Label& label : scene.labels) {
    TextStyle style;
    style.size_px = label.size_px;
    style.align_x = label.align;
    style.weight = label.is_bold ? FontWeight::kBold : FontWeight::kRegular;
    canvas.text(static_cast<int>(std::lround(label.x)), static_cast<int>(std::lround(label.y)), label.text,
                style);
  }
  return canvas.picture();
}

}  // namespace brdfit::render
