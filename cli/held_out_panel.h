// Pictures of what a bake does under lights that took no part in it, drawn for eyes.
#ifndef BRDFIT_CLI_HELD_OUT_PANEL_H_
#define BRDFIT_CLI_HELD_OUT_PANEL_H_

#include <cstdint>
#include <string>
#include <vector>

#include "bake/evidence.h"
#include "io/json.h"
#include "measured/image_stack.h"
#include "render/difference.h"
#include "render/image.h"

namespace brdfit::cli {

// Every step-th texel of every step-th row of a stack, from the upper left one.
struct TexelGrid {
  TexelGrid(int stack_width, int stack_height);
  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

  int step = 1;  // the least with which the grid has at most 384 x 480 texels
  int width = 0;
  int height = 0;
  int enlargement = 1;  // texels of small grids are drawn as that many pixels squared
};

// One held-out light, seen on a grid.
struct HeldOutPanel {
  std::string asset;
  StackLight light;
  std::vector<std::string> words;  // "worst", "median", "best"
  std::string model;               // title of the base model
  int fold = 0;
  int folds = 0;
  std::size_t held_out = 0;  // lights of the fold
  int lobes = 0;
  std::vector<bake::RealisKind> kinds;  // of `others`

  render::Image capture, model_picture, realis_picture;
  // Prediction - capture, of luminance in 1/255. kUnmeasured where the capture has no weight.
  render::Difference model_error, realis_error;
  std::vector<render::Difference> others;
};

// Root of the mean square over pixels with a value; 0 where there are none.
double rmse_of(const render::Difference& difference);

struct DrawnPanel {
  render::Picture picture;
  io::Json facts;  // exposure, range of the colour bar, tiles with their places and errors
};
DrawnPanel draw_held_out_panel(const HeldOutPanel& panel, const TexelGrid& grid);

// What Realis does to the error of each texel over lights that took no part, each redone without its fold.
struct BenefitMap {
  explicit BenefitMap(const TexelGrid& grid);

  std::size_t lights = 0;                  // that were held out
  std::vector<double> without;             // [texel]: sum of squared errors of luminance, base model alone
  std::vector<double> with;                // and with Realis
  std::vector<std::uint32_t> seen;         // [texel]: lights under which the texel has weight
  std::vector<std::uint8_t> is_corrected;  // [texel]: whether any fold corrects it
};
DrawnPanel draw_benefit(const BenefitMap& map, const std::string& asset, std::size_t stack_lights,
                        const TexelGrid& grid);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_HELD_OUT_PANEL_H_
