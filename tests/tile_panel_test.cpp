// Panels of pictures that are there already.
#include "render/tile_panel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>

#include "tests/picture_tools.h"

namespace brdfit::render {
namespace {

Picture gradient(int width, int height, int shade) {
  Picture picture(width, height);
  for (std::size_t k = 0; k < picture.rgb.size(); ++k) {
    picture.rgb[k] = static_cast<std::uint8_t>((7 * k + static_cast<std::size_t>(shade)) % 251);
  }
  return picture;
}

TilePanel two_rows() {
  TilePanel panel;
  panel.title = "bumps";
  panel.description = {"what it shows"};
  panel.rows = {
      {{"capture", gradient(40, 30, 1), {}}, {"model", gradient(40, 30, 2), {"RMSE\t1.00", "more"}}},
      {{"", gradient(40, 30, 3), {}}}};
  panel.unit = "1/255";
  return panel;
}

TEST(TilePanel, HoldsEveryPictureWhereItSays) {
  const TilePanel panel = two_rows();
  const DrawnTiles drawn = draw_tile_panel(panel);
  ASSERT_EQ(drawn.places.size(), 2U);
  for (std::size_t r = 0; r < 2; ++r) {
    ASSERT_EQ(drawn.places[r].size(), panel.rows[r].size());
    for (std::size_t c = 0; c < panel.rows[r].size(); ++c) {
      const TilePlace& at = drawn.places[r][c];
      const Picture found = tests::cut(drawn.picture, {{at.x, at.y}, {at.x + at.width, at.y + at.height}});
      EXPECT_EQ(found.rgb, panel.rows[r][c].picture.rgb);
    }
  }
}

TEST(TilePanel, KeepsAMarginAroundAllThatIsDrawn) {
  const DrawnTiles drawn = draw_tile_panel(two_rows());
  const tests::Box ink = tests::ink_box(drawn.picture);
  EXPECT_GE(ink.begin.x, 4);
  EXPECT_GE(ink.begin.y, 4);
  EXPECT_LE(ink.end.x, drawn.picture.width - 4);
  EXPECT_LE(ink.end.y, drawn.picture.height - 2);
}

TEST(TilePanel, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(draw_tile_panel(TilePanel{}), std::invalid_argument);
  TilePanel uneven = two_rows();
  uneven.rows[1][0].picture = gradient(40, 31, 3);
  EXPECT_THROW(draw_tile_panel(uneven), std::invalid_argument);
  TilePanel flat = two_rows();
  flat.range = 0.0;
  EXPECT_THROW(draw_tile_panel(flat), std::invalid_argument);
  EXPECT_THROW(enlarged(gradient(4, 4, 0), 0), std::invalid_argument);
}

TEST(TilePanel, EnlargesByRepeatingPixels) {
  const Picture small = gradient(5, 3, 4);
  const Picture large = enlarged(small, 3);
  ASSERT_EQ(large.width, 15);
  ASSERT_EQ(large.height, 9);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      EXPECT_EQ(tests::pixel_at(large, x, y), tests::pixel_at(small, x / 3, y / 3));
    }
  }
}

}  // namespace
}  // namespace brdfit::render
