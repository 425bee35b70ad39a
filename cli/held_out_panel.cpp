// Captions, tiles and maps of held-out lights.
#include "cli/held_out_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "render/caption.h"
#include "render/tile_panel.h"
#include "render/view.h"

namespace brdfit::cli {
namespace {

constexpr int kMostColumns = 384;
constexpr int kMostRows = 480;
constexpr int kSmallTile = 256;  // pixels; smaller tiles are enlarged as long as they stay below
constexpr int kMap = 512;        // the same of the map
constexpr double kExposureQuantile = 0.995;
constexpr double kMostStops = 20.0;
constexpr double kNoticed = 0.1;  // change of RMSE, in 1/255
constexpr std::array<std::uint8_t, 3> kUncorrected = {150, 150, 150};

int divided_up(int a, int b) {
  return (a + b - 1) / b;
}

// So that all but the brightest pixels of the capture stay below white; in tenths of stops.
double exposure_of(const render::Image& capture) {
  std::vector<float> values;
  for (std::size_t k = 0; k < capture.pixel_count(); ++k) {
    if (capture.state[k] != render::PixelState::kValue) continue;
    values.push_back(std::max({capture.rgb[3 * k], capture.rgb[3 * k + 1], capture.rgb[3 * k + 2]}));
  }
  if (values.empty()) return 0.0;
  const auto place = static_cast<std::ptrdiff_t>(kExposureQuantile * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  const auto bright = static_cast<double>(values[static_cast<std::size_t>(place)]);
  if (!(bright > 0.0)) return 0.0;
  return std::clamp(std::floor(-10.0 * std::log2(bright)) / 10.0, -kMostStops, kMostStops);
}

double share(std::size_t part, std::size_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

// "12.3%", and what is there is not 0.
std::string percent(double of_all) {
  return of_all > 0.0 && of_all < 0.001 ? "< 0.1%" : fmt::format("{:.1f}%", 100.0 * of_all);
}

std::string in_255(double rmse) {
  return fmt::format("{:.2f}", rmse);
}

std::string title_of(const bake::RealisKind& kind) {
  const bool is_part = kind.options.dominant != kind.lobes;
  if (is_part && kind.options.bits > 0) {
    return fmt::format("error, {} of {}, {} bit", kind.options.dominant, kind.lobes, kind.options.bits);
  }
  if (is_part) return fmt::format("error, {} of {} lobes", kind.options.dominant, kind.lobes);
  if (kind.options.bits > 0) return fmt::format("error, {} bit", kind.options.bits);
  return fmt::format("error, {} lobes", kind.lobes);
}

std::string words_of_step(const TexelGrid& grid) {
  return grid.step > 1 ? fmt::format(" One texel of every {0} × {0}.", grid.step) : std::string();
}

// Of the pixels with a value, those where a's error is less than b's and where it is more.
std::string better_and_worse(const render::Difference& a, const render::Difference& b) {
  std::size_t better = 0;
  std::size_t worse = 0;
  std::size_t all = 0;
  for (std::size_t k = 0; k < a.value.size(); ++k) {
    if (a.state[k] != render::PixelState::kValue) continue;
    ++all;
    better += std::abs(a.value[k]) < std::abs(b.value[k]) ? 1 : 0;
    worse += std::abs(a.value[k]) > std::abs(b.value[k]) ? 1 : 0;
  }
  return fmt::format("better, worse\t{:.0f}, {:.0f}%", 100.0 * share(better, all), 100.0 * share(worse, all));
}

// A tile of a panel and what the record says of it.
struct NamedTile {
  std::string name;  // as in the evidence
  render::Tile tile;
  std::optional<double> rmse;
};

class PanelDrawing {
 public:
  PanelDrawing(const HeldOutPanel& panel, const TexelGrid& grid) : panel_(panel), grid_(grid) {
    view_.exposure_stops = exposure_of(panel.capture);
    std::vector<render::Difference> errors = panel.others;
    errors.push_back(panel.model_error);
    errors.push_back(panel.realis_error);
    range_ = render::difference_range(errors);
    beyond_ = render::share_beyond(errors, range_);
  }

  DrawnPanel draw() const {
    const std::vector<std::vector<NamedTile>> rows = {main_row(), other_row()};
    render::TilePanel tiles;
    tiles.title = title();
    tiles.description = description();
    tiles.range = range_;
    tiles.unit = "1/255";
    for (const auto& row : rows) {
      if (row.empty()) continue;
      std::vector<render::Tile>& to = tiles.rows.emplace_back();
      for (const NamedTile& tile : row) to.push_back(tile.tile);
    }
    render::DrawnTiles drawn = render::draw_tile_panel(tiles);
    return {std::move(drawn.picture), facts(rows, drawn)};
  }

 private:
  std::string title() const {
    std::string words;
    for (const std::string& word : panel_.words) words += (words.empty() ? "" : ", ") + word;
    return fmt::format("{}: light {}, held out{}", panel_.asset, panel_.light.name,
                       words.empty() ? "" : " (" + words + " of all lights)");
  }

  std::vector<std::string> description() const {
    const std::string others =
        panel_.held_out > 1 ? fmt::format(" and {} others", panel_.held_out - 1) : std::string();
    return {
        fmt::format("Fold {} of {}: everything was redone without this light{}: normals, albedo, base model, "
                    "lobes, amplitudes.",
                    panel_.fold + 1, panel_.folds, others),
        fmt::format(
            "Pictures: {}. Errors: luminance, prediction − capture, in 1/255 of linear light; {} beyond "
            "the bar.{}",
            render::describe_view(view_), percent(beyond_), words_of_step(grid_))};
  }

  render::Picture shown(const render::Image& image) const {
    return render::enlarged(render::to_picture(image, view_), grid_.enlargement);
  }
  render::Picture shown(const render::Difference& error) const {
    return render::enlarged(render::difference_picture(error, render::DifferenceKind::kSigned, range_),
                            grid_.enlargement);
  }

  std::vector<std::string> lines_of_light() const {
    const Vec3& d = panel_.light.direction;
    const double degrees = 180.0 / std::numbers::pi;
    const double azimuth = std::atan2(d.y, d.x) * degrees;
    std::vector<std::string> lines = {
        fmt::format("light's height\t{:.0f}°", std::asin(std::clamp(d.z, -1.0, 1.0)) * degrees),
        fmt::format("azimuth\t{:.0f}°", azimuth < 0.0 ? azimuth + 360.0 : azimuth)};
    const auto without = static_cast<std::size_t>(std::count(
        panel_.model_error.state.begin(), panel_.model_error.state.end(), render::PixelState::kUnmeasured));
    if (without > 0)
      lines.push_back(fmt::format("{} texels masked or saturated (hatched in the errors)", without));
    return lines;
  }

  std::vector<NamedTile> main_row() const {
    const double model = rmse_of(panel_.model_error);
    const double realis = rmse_of(panel_.realis_error);
    const std::string lobes = panel_.lobes > 0 ? fmt::format("lobes\t{}", panel_.lobes) : "no lobes help";
    return {{"capture", {"capture", shown(panel_.capture), lines_of_light()}, {}},
            {"model",
             {"model: " + panel_.model, shown(panel_.model_picture), {"RMSE, 1/255\t" + in_255(model)}},
             model},
            {"realis",
             {"model + Realis", shown(panel_.realis_picture), {"RMSE, 1/255\t" + in_255(realis), lobes}},
             realis},
            {"model-error",
             {"error of the model", shown(panel_.model_error), {"RMSE, 1/255\t" + in_255(model)}},
             model},
            {"realis-error",
             {"error of Realis",
              shown(panel_.realis_error),
              {"RMSE, 1/255\t" + in_255(realis), better_and_worse(panel_.realis_error, panel_.model_error)}},
             realis}};
  }

  std::vector<NamedTile> other_row() const {
    std::vector<NamedTile> row;
    for (std::size_t k = 0; k < panel_.others.size(); ++k) {
      const double rmse = rmse_of(panel_.others[k]);
      row.push_back({panel_.kinds[k].name,
                     {title_of(panel_.kinds[k]),
                      shown(panel_.others[k]),
                      {"RMSE, 1/255\t" + in_255(rmse),
                       fmt::format("bytes per texel\t{:.3g}", panel_.kinds[k].bytes_per_texel())}},
                     rmse});
    }
    return row;
  }

  io::Json facts(const std::vector<std::vector<NamedTile>>& rows, const render::DrawnTiles& drawn) const {
    io::Json tiles = io::Json::array();
    for (std::size_t r = 0; r < drawn.places.size(); ++r) {
      for (std::size_t c = 0; c < drawn.places[r].size(); ++c) {
        const render::TilePlace& at = drawn.places[r][c];
        io::Json tile = {{"name", rows[r][c].name}, {"x", at.x}, {"y", at.y}};
        if (rows[r][c].rmse) tile["rmse_255"] = *rows[r][c].rmse;
        tiles.push_back(std::move(tile));
      }
    }
    return {{"exposure_stops", view_.exposure_stops}, {"range_255", range_}, {"tiles", std::move(tiles)}};
  }

  const HeldOutPanel& panel_;
  const TexelGrid& grid_;
  render::ViewOptions view_;
  double range_ = 1.0;
  double beyond_ = 0.0;
};

// The change of each texel's RMSE in 1/255; below 0 where Realis helps.
render::Difference change_of(const BenefitMap& map, const TexelGrid& grid) {
  render::Difference change;
  change.width = grid.width;
  change.height = grid.height;
  change.value.assign(grid.count(), 0.0F);
  change.state.assign(grid.count(), render::PixelState::kUnmeasured);
  for (std::size_t k = 0; k < grid.count(); ++k) {
    if (map.seen[k] == 0) continue;
    const double count = map.seen[k];
    change.value[k] =
        static_cast<float>(255.0 * (std::sqrt(map.with[k] / count) - std::sqrt(map.without[k] / count)));
    change.state[k] = render::PixelState::kValue;
  }
  return change;
}

// What a map comes to over all its texels that were seen.
struct BenefitSums {
  std::size_t helps = 0, same = 0, harms = 0, uncorrected = 0, all = 0;
  double without = 0.0, with = 0.0, values = 0.0;

  double rmse(double sum) const { return values > 0.0 ? 255.0 * std::sqrt(sum / values) : 0.0; }
};

BenefitSums sums_of(const BenefitMap& map, const render::Difference& change) {
  BenefitSums sums;
  for (std::size_t k = 0; k < map.seen.size(); ++k) {
    if (map.seen[k] == 0) continue;
    ++sums.all;
    sums.without += map.without[k];
    sums.with += map.with[k];
    sums.values += map.seen[k];
    if (map.is_corrected[k] == 0) {
      ++sums.uncorrected;
    } else if (std::abs(static_cast<double>(change.value[k])) < kNoticed) {
      ++sums.same;
    } else {
      ++(change.value[k] < 0.0F ? sums.helps : sums.harms);
    }
  }
  return sums;
}

render::Picture picture_of(const BenefitMap& map, const render::Difference& change, double range) {
  render::Picture picture = render::difference_picture(change, render::DifferenceKind::kSigned, range);
  for (std::size_t k = 0; k < map.seen.size(); ++k) {
    if (map.seen[k] == 0 || map.is_corrected[k] != 0) continue;
    std::copy(kUncorrected.begin(), kUncorrected.end(),
              picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * k));
  }
  return render::enlarged(picture, std::max(1, kMap / std::max(change.width, change.height)));
}

std::vector<std::string> legend_of(const BenefitSums& sums) {
  const auto line = [&](const std::string& words, std::size_t part) {
    return words + "\t" + percent(share(part, sums.all));
  };
  return {line("blue: helps", sums.helps),
          line(fmt::format("white: less than {} either way", kNoticed), sums.same),
          line("red: does harm", sums.harms), line("grey: not corrected", sums.uncorrected),
          fmt::format("RMSE without, with\t{}, {}", in_255(sums.rmse(sums.without)),
                      in_255(sums.rmse(sums.with)))};
}

}  // namespace

TexelGrid::TexelGrid(int stack_width, int stack_height)
    : step(std::max(divided_up(stack_width, kMostColumns), divided_up(stack_height, kMostRows))),
      width(divided_up(stack_width, step)),
      height(divided_up(stack_height, step)),
      enlargement(std::max(1, kSmallTile / std::max(width, height))) {}

BenefitMap::BenefitMap(const TexelGrid& grid)
    : without(grid.count()), with(grid.count()), seen(grid.count()), is_corrected(grid.count()) {}

double rmse_of(const render::Difference& difference) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < difference.value.size(); ++k) {
    if (difference.state[k] != render::PixelState::kValue) continue;
    sum += std::pow(static_cast<double>(difference.value[k]), 2);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

DrawnPanel draw_held_out_panel(const HeldOutPanel& panel, const TexelGrid& grid) {
  return PanelDrawing(panel, grid).draw();
}

DrawnPanel draw_benefit(const BenefitMap& map, const std::string& asset, std::size_t stack_lights,
                        const TexelGrid& grid) {
  const render::Difference change = change_of(map, grid);
  const BenefitSums sums = sums_of(map, change);
  const std::string lights = map.lights == stack_lights
                                 ? fmt::format("all {} lights", map.lights)
                                 : fmt::format("{} of {} lights", map.lights, stack_lights);
  render::TilePanel tiles;
  tiles.title = asset + ": where Realis helps";
  tiles.description = {
      fmt::format("Change of each texel's RMSE under {}, each held out of everything with its fold.{}",
                  lights, words_of_step(grid))};
  tiles.range = std::max(render::difference_range(std::span(&change, 1)), kNoticed);
  tiles.unit = "1/255, luminance";
  tiles.rows = {{{"", picture_of(map, change, tiles.range), legend_of(sums)}}};
  render::DrawnTiles drawn = render::draw_tile_panel(tiles);
  return {std::move(drawn.picture),
          {{"lights", map.lights},
           {"rmse_255_without", sums.rmse(sums.without)},
           {"rmse_255_with", sums.rmse(sums.with)},
           {"helps", share(sums.helps, sums.all)},
           {"same", share(sums.same, sums.all)},
           {"harms", share(sums.harms, sums.all)},
           {"not_corrected", share(sums.uncorrected, sums.all)}}};
}

}  // namespace brdfit::cli
