// Describing a stack: one pass for what every pixel says, one over a sample for where the lights are.
#include "cli/stack_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "bake/light_check.h"
#include "bake/lobes.h"
#include "cli/picture_file.h"
#include "io/image_stack_file.h"
#include "render/light_map.h"

namespace brdfit::cli {
namespace {

constexpr std::size_t kCheckedTriples = 3000;
constexpr float kLitShare = 0.05F;  // of a texel's largest value
constexpr std::array<int, 2> kLobeCounts = {4, 8};
constexpr bake::Cap kHemisphere = {{0.0, 0.0, 1.0}, std::numbers::pi / 2.0};

// How many lights reach a texel, from the pictures themselves, so that cast shadows count.
struct Coverage {
  std::vector<std::size_t> texels_with;  // [number of lights]
  std::size_t black = 0;                 // no light reaches them, or no value can be used

  void add(const TexelBlock& block) {
    texels_with.resize(block.lights + 1);
    for (std::size_t k = 0; k < block.count(); ++k) {
      float largest = 0.0F;
      for (std::size_t l = 0; l < block.lights; ++l) largest = std::max(largest, block.plane(l, 0)[k]);
      std::size_t lit = 0;
      for (std::size_t l = 0; l < block.lights; ++l) {
        // Saturated values are lit too.
        if (largest > 0.0F && block.plane(l, 0)[k] > kLitShare * largest) ++lit;
      }
      ++texels_with[lit];
      if (lit == 0) ++black;
    }
  }
  std::size_t texels() const {
    std::size_t sum = 0;
    for (const std::size_t count : texels_with) sum += count;
    return sum;
  }
  // Lights that at least that share of the texels have.
  std::size_t reached_by(double share) const {
    double left = static_cast<double>(texels());
    const double wanted = share * left;
    std::size_t lights = 0;
    for (std::size_t n = 0; n + 1 < texels_with.size(); ++n) {
      left -= static_cast<double>(texels_with[n]);
      if (left < wanted) break;
      lights = n + 1;
    }
    return lights;
  }
  std::size_t with_fewer_than(std::size_t lights) const {
    std::size_t sum = 0;
    for (std::size_t n = 0; n < std::min(lights, texels_with.size()); ++n) sum += texels_with[n];
    return sum;
  }
};

struct Description {
  Coverage coverage;
  bake::LightCheck check;
  std::vector<Vec3> directions;
  double lowest_deg = 90.0;  // of the lights above the horizon
  double highest_deg = 0.0;
};

Description examine(io::FileStack& stack) {
  Description result;
  const StackInfo& info = stack.info();
  const int strip = stack.strip_rows();
  for (int first = 0; first < info.height; first += strip) {
    TexelBlock block = stack.read_luminance(first, std::min(strip, info.height - first));
    result.coverage.add(block);
    stack.give_back(std::move(block));
  }
  const TexelBlock sample = stack.read_texels(bake::light_check_texels(info, kCheckedTriples));
  result.check = bake::check_lights(info, sample);
  result.directions = directions_of(info);
  for (const StackLight& light : info.lights) {
    const double height = std::asin(std::clamp(light.direction.z, -1.0, 1.0)) * 180.0 / std::numbers::pi;
    result.lowest_deg = std::min(result.lowest_deg, height);
    result.highest_deg = std::max(result.highest_deg, height);
  }
  return result;
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<std::string> frames_of(const io::StackSource& source) {
  std::vector<std::string> frames;
  if (source.dark) frames.emplace_back("dark");
  if (source.flat) frames.emplace_back("flat");
  if (source.mask) frames.emplace_back("mask");
  if (source.normals) frames.emplace_back("normals");
  if (source.albedo) frames.emplace_back("albedo");
  if (source.count_of(&io::StackPicture::weight) > 0) frames.emplace_back("weights");
  if (source.count_of(&io::StackPicture::shadow) > 0) frames.emplace_back("shadows");
  return frames;
}

io::Json coverage_json(const Coverage& coverage) {
  return {{"texels", coverage.texels()},
          {"lights_of_half", coverage.reached_by(0.5)},
          {"lights_of_95_pct", coverage.reached_by(0.95)},
          {"fewer_than_4_pct", percent(coverage.with_fewer_than(4), coverage.texels())},
          {"fewer_than_8_pct", percent(coverage.with_fewer_than(8), coverage.texels())},
          {"black", coverage.black}};
}

io::Json suspicions_json(const bake::LightCheck& check, const StackInfo& info) {
  io::Json list = io::Json::array();
  for (const bake::LightSuspicion& suspicion : check.suspicions) {
    io::Json names = io::Json::array();
    for (const std::size_t light : suspicion.lights) names.push_back(info.lights[light].name);
    list.push_back({{"kind", suspicion.kind}, {"text", suspicion.text}, {"lights", names}});
  }
  return list;
}

void print_json(const io::FileStack& stack, const Description& found) {
  const StackInfo& info = stack.info();
  const io::StackEncoding& encoding = stack.encoding();
  const io::PixelCounts& counts = stack.counts();
  io::Json conditions = io::Json::object();
  for (const int lobes : kLobeCounts) {
    const auto condition = lobe_condition(lobes, found.directions);
    conditions[std::to_string(lobes)] = condition ? io::Json(*condition) : io::Json(nullptr);
  }
  io::Json json = {{"kind", "stack"},
                   {"name", info.name},
                   {"width", info.width},
                   {"height", info.height},
                   {"lights", info.lights.size()},
                   {"near_lights", has_near_lights(info)},
                   {"light_height_deg", {found.lowest_deg, found.highest_deg}},
                   {"format", encoding.format},
                   {"channels", encoding.channels},
                   {"depth", io::name_of(encoding.depth)},
                   {"transfer", io::name_of(encoding.transfer)},
                   {"transfer_from", encoding.transfer_origin},
                   {"mixed_encodings", encoding.is_mixed},
                   {"frames", frames_of(stack.source())},
                   {"saturated_pct", percent(counts.saturated, counts.pixels)},
                   {"non_finite_pixels", counts.non_finite},
                   {"masked_texels", counts.masked_texels},
                   {"bad_texels", counts.bad_texels},
                   {"coverage", coverage_json(found.coverage)},
                   {"lobe_condition", conditions},
                   {"lambert_residual_pct", 100.0 * found.check.lambert_residual},
                   {"suspicions", suspicions_json(found.check, info)}};
  if (stack.source().chart_rms) json["chart_rms"] = *stack.source().chart_rms;
  fmt::print("{}\n", json.dump(2));
}

void print_text(const io::FileStack& stack, const Description& found) {
  const StackInfo& info = stack.info();
  const io::StackEncoding& encoding = stack.encoding();
  const io::PixelCounts& counts = stack.counts();
  fmt::print("stack of {} pictures, {} x {} pixels, {}, {} channel{}, {}{}\n", info.lights.size(), info.width,
             info.height, encoding.format, encoding.channels, encoding.channels == 1 ? "" : "s",
             io::name_of(encoding.depth), encoding.is_mixed ? " (the first; others differ)" : "");
  fmt::print("transfer: {} ({})\n", io::name_of(encoding.transfer), encoding.transfer_origin);
  const std::vector<std::string> frames = frames_of(stack.source());
  if (!frames.empty()) fmt::print("beside them: {}\n", fmt::join(frames, ", "));
  if (stack.source().chart_rms)
    fmt::print("colour matrix from the chart, rms {:.4f}\n", *stack.source().chart_rms);
  fmt::print("lights: {}, {:.1f} to {:.1f} deg above the horizon\n",
             has_near_lights(info) ? "near" : "directional", found.lowest_deg, found.highest_deg);
  fmt::print("saturated: {:.3f}% of pixels; not finite: {}; masked texels: {}; without normal or flat: {}\n",
             percent(counts.saturated, counts.pixels), counts.non_finite, counts.masked_texels,
             counts.bad_texels);
  const Coverage& coverage = found.coverage;
  fmt::print(
      "coverage: half of the texels are lit by {} lights or more, 95% by {} or more; by fewer than 8: "
      "{:.1f}%; black: {}\n",
      coverage.reached_by(0.5), coverage.reached_by(0.95),
      percent(coverage.with_fewer_than(8), coverage.texels()), coverage.black);
  for (const int lobes : kLobeCounts) {
    const auto condition = lobe_condition(lobes, found.directions);
    fmt::print("condition of {} uniform lobes under these lights: {}\n", lobes,
               condition ? fmt::format("{:.3g}", *condition) : "none, they cannot be told apart");
  }
  if (found.check.texels > 0) {
    fmt::print("Lambert's law leaves {:.1f}% of the pictures ({} texels)\n",
               100.0 * found.check.lambert_residual, found.check.texels);
  }
  if (found.check.suspicions.empty()) fmt::print("lights: nothing suspicious\n");
  for (const bake::LightSuspicion& suspicion : found.check.suspicions)
    fmt::print("suspicious: {}\n", suspicion.text);
}

void draw_lights(const std::filesystem::path& file, const io::FileStack& stack, const Description& found) {
  const StackInfo& info = stack.info();
  std::set<std::size_t> suspects;
  for (const auto& suspicion : found.check.suspicions)
    suspects.insert(suspicion.lights.begin(), suspicion.lights.end());
  std::vector<render::MappedLight> lights;
  for (std::size_t l = 0; l < info.lights.size(); ++l) {
    const StackLight& light = info.lights[l];
    lights.push_back(
        {light.direction, base_name(light.name), light.position.has_value(), suspects.contains(l)});
  }
  const render::LightMapOptions options = {
      fmt::format("{}: {} lights", info.name, info.lights.size()),
      suspects.empty() ? "seen from above; the rim is the horizon"
                       : "seen from above; the rim is the horizon; orange: suspicious"};
  if (file.extension() == ".svg") {
    io::write_text(file, render::light_map_svg(lights, options));
  } else {
    write_picture(file, render::light_map_picture(lights, options), {});
  }
}

}  // namespace

bool is_stack_file(const std::filesystem::path& file) {
  if (file.extension() == ".lp") return true;
  if (file.extension() != ".json") return false;
  const io::Json json = io::read_json(file);
  return json.is_object() && json.contains("images");
}

std::optional<double> lobe_condition(int lobes, std::span<const Vec3> directions) {
  if (directions.size() < static_cast<std::size_t>(lobes)) return {};
  LobeSet set;
  for (int k = 0; k < lobes; ++k) {
    // A lobe's share of the hemisphere is a cap of height 1 / lobes, at whose rim it is half as high.
    set.push_back({bake::cap_point(kHemisphere, k, lobes), std::numbers::ln2 * lobes, -1.0});
  }
  const Eigen::MatrixXd values = bake::lobe_values(set, directions);
  const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(values).singularValues();
  const double ratio = singular[0] / singular[singular.size() - 1];
  constexpr double kLargest = 1e7;  // its square is what doubles can tell from a singular matrix
  if (!(ratio < kLargest)) return {};
  return ratio * ratio;
}

int describe_stack(const StackInfoRequest& request, const CommonOptions& common) {
  const bool has_picture = !request.lights.empty();
  if (has_picture && request.lights.extension() != ".svg" && request.lights.extension() != ".png") {
    throw UsageError(request.lights.string() + ": the picture of the lights must end in .svg or .png");
  }
  if (has_picture) prepare_output(request.lights, common.force);
  io::FileStackOptions options;
  options.transfer = request.transfer;
  io::FileStack stack(io::read_stack_source(request.file), options);
  const Description found = examine(stack);
  if (has_picture) draw_lights(request.lights, stack, found);
  if (common.json) {
    print_json(stack, found);
  } else {
    print_text(stack, found);
  }
  return kDone;
}

}  // namespace brdfit::cli
