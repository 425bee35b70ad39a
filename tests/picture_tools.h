// Looking things up in 8-bit pictures.
#ifndef BRDFIT_TESTS_PICTURE_TOOLS_H_
#define BRDFIT_TESTS_PICTURE_TOOLS_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string_view>
#include <vector>

#include "render/canvas.h"
#include "render/image.h"

namespace brdfit::tests {

using Rgb8 = std::array<std::uint8_t, 3>;

inline constexpr Rgb8 kWhite = {255, 255, 255};

struct Place {
  int x = 0;
  int y = 0;
  friend bool operator==(const Place&, const Place&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Place& place) {
    return out << "(" << place.x << ", " << place.y << ")";
  }
};

// From begin to before end; empty if end <= begin.
struct Box {
  Place begin;
  Place end;
  bool is_empty() const { return end.x <= begin.x || end.y <= begin.y; }
};

inline const std::uint8_t* bytes_at(const render::Picture& picture, int x, int y) {
  return picture.rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                   static_cast<std::size_t>(x));
}

inline Rgb8 pixel_at(const render::Picture& picture, int x, int y) {
  const std::uint8_t* p = bytes_at(picture, x, y);
  return {p[0], p[1], p[2]};
}

inline render::Picture cut(const render::Picture& picture, const Box& box) {
  render::Picture part(box.end.x - box.begin.x, box.end.y - box.begin.y);
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(bytes_at(picture, box.begin.x, box.begin.y + y), 3 * static_cast<std::size_t>(part.width),
                part.rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width));
  }
  return part;
}

// What is around all pixels of another colour than the background.
inline Box ink_box(const render::Picture& picture, const Rgb8& background = kWhite) {
  Box box{{picture.width, picture.height}, {0, 0}};
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (pixel_at(picture, x, y) == background) continue;
      box.begin = {std::min(box.begin.x, x), std::min(box.begin.y, y)};
      box.end = {std::max(box.end.x, x + 1), std::max(box.end.y, y + 1)};
    }
  }
  return box;
}

inline bool is_at(const render::Picture& part, const render::Picture& whole, const Place& place) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(part.width);
  for (int y = 0; y < part.height; ++y) {
    const std::uint8_t* expected = part.rgb.data() + static_cast<std::size_t>(y) * row_bytes;
    if (!std::equal(expected, expected + row_bytes, bytes_at(whole, place.x, place.y + y))) return false;
  }
  return true;
}

// Wherever all pixels of the part are in the whole, from top to bottom, then from left to right.
inline std::vector<Place> places_of(const render::Picture& part, const render::Picture& whole) {
  std::vector<Place> places;
  for (int y = 0; y + part.height <= whole.height; ++y) {
    for (int x = 0; x + part.width <= whole.width; ++x) {
      if (is_at(part, whole, {x, y})) places.push_back({x, y});
    }
  }
  return places;
}

// Text on white paper, cut to its ink.
inline render::Picture picture_of_text(std::string_view text, render::TextStyle style) {
  const int length = render::text_width(text, style.size_px, style.weight) + 2 * style.size_px;
  const int thickness = 4 * style.size_px;
  style.align_x = render::AlignX::kCentre;
  style.align_y = render::AlignY::kCentre;
  render::Canvas canvas(style.upwards ? thickness : length, style.upwards ? length : thickness,
                        {255, 255, 255});
  canvas.text(canvas.width() / 2, canvas.height() / 2, text, style);
  return cut(canvas.picture(), ink_box(canvas.picture()));
}

// Whether text of that style stands somewhere in a picture, on one line.
inline bool shows_text(const render::Picture& picture, std::string_view text,
                       const render::TextStyle& style = {}) {
  return !places_of(picture_of_text(text, style), picture).empty();
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_PICTURE_TOOLS_H_
