// Panels of pictures that are there already: rows of tiles of one size, each with a title above and lines
// below, and a colour bar beside every row for those that show differences.
#ifndef BRDFIT_RENDER_TILE_PANEL_H_
#define BRDFIT_RENDER_TILE_PANEL_H_

#include <string>
#include <vector>

#include "render/difference.h"
#include "render/image.h"

namespace brdfit::render {

struct Tile {
  std::string title;  // may be empty
  Picture picture;
  std::vector<std::string> lines;  // what follows a tab is aligned to the right
};

struct TilePanel {
  std::string title;
  std::vector<std::string> description;  // below the title, over the whole width
  std::vector<std::vector<Tile>> rows;
  DifferenceKind kind = DifferenceKind::kSigned;  // of the colour bar
  double range = 1.0;
  std::string unit;  // of the bar, may be empty
};

// Where a tile's picture lies in the panel.
struct TilePlace {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct DrawnTiles {
  Picture picture;
  std::vector<std::vector<TilePlace>> places;  // as TilePanel::rows
};

// Throws std::invalid_argument where there is no tile, sizes differ or the range is not finite and above 0;
// std::runtime_error as Canvas::text.
DrawnTiles draw_tile_panel(const TilePanel& panel);

// Every pixel as factor x factor of them. Throws std::invalid_argument for a factor below 1.
Picture enlarged(const Picture& picture, int factor);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_TILE_PANEL_H_
