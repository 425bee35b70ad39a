// What is drawn on a canvas stays inside it, and text is the text that was asked for.
#include "render/canvas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/font.h"
#include "tests/picture_tools.h"

namespace brdfit::render {
namespace {

using tests::Box;
using tests::cut;
using tests::ink_box;
using tests::picture_of_text;
using tests::pixel_at;
using tests::Place;
using tests::Rgb8;

constexpr Colour8 kPaper = {255, 255, 255};
constexpr Colour8 kRed = {200, 10, 20};
constexpr Rgb8 kRedPixel = {200, 10, 20};
constexpr int kWidth = 13;
constexpr int kHeight = 9;

Picture test_picture(int width, int height) {
  Picture picture(width, height);
  for (std::size_t k = 0; k < picture.rgb.size(); ++k)
    picture.rgb[k] = static_cast<std::uint8_t>(7 * k % 251);
  return picture;
}

bool is_in(int x, int y, int left, int top, int width, int height) {
  return x >= left && x < left + width && y >= top && y < top + height;
}

// Rectangles inside, across every border, around the canvas and beside it.
const std::vector<std::array<int, 4>> kRectangles = {
    {2, 3, 4, 5},  {-3, 2, 6, 3}, {10, 2, 30, 3}, {2, -4, 3, 6}, {2, 7, 3, 50},   {-5, -5, 60, 60},
    {-9, 0, 4, 4}, {13, 0, 4, 4}, {0, 9, 4, 4},   {0, -4, 4, 4}, {-100, 4, 9, 1}, {0, 0, kWidth, kHeight},
    {12, 8, 1, 1}, {0, 0, 1, 1},  {3, 3, 0, 4},   {3, 3, 4, 0},  {3, 3, -2, 4},
};

TEST(Canvas, StartsAsItsBackground) {
  const Canvas canvas(kWidth, kHeight, kRed);
  EXPECT_EQ(canvas.picture().rgb.size(), std::size_t{3 * kWidth * kHeight});
  EXPECT_TRUE(ink_box(canvas.picture(), kRedPixel).is_empty());
  EXPECT_THROW(Canvas(0, 1, kRed), std::invalid_argument);
  EXPECT_THROW(Canvas(1, -1, kRed), std::invalid_argument);
}

TEST(Canvas, FillsWhatIsInsideAndNothingElse) {
  for (const auto& [x, y, width, height] : kRectangles) {
    Canvas canvas(kWidth, kHeight, kPaper);
    canvas.fill(x, y, width, height, kRed);
    for (int py = 0; py < kHeight; ++py) {
      for (int px = 0; px < kWidth; ++px) {
        ASSERT_EQ(pixel_at(canvas.picture(), px, py) == kRedPixel, is_in(px, py, x, y, width, height));
      }
    }
  }
}

TEST(Canvas, FramesAreThePixelsAlongTheInsideOfARectangle) {
  for (const auto& [x, y, width, height] : kRectangles) {
    if (width < 1 || height < 1) continue;
    Canvas canvas(kWidth, kHeight, kPaper);
    canvas.frame(x, y, width, height, kRed);
    for (int py = 0; py < kHeight; ++py) {
      for (int px = 0; px < kWidth; ++px) {
        ASSERT_EQ(pixel_at(canvas.picture(), px, py) == kRedPixel,
                  is_in(px, py, x, y, width, height) && !is_in(px, py, x + 1, y + 1, width - 2, height - 2));
      }
    }
  }
}

TEST(Canvas, LinesHaveBothEndsInEitherOrder) {
  for (const bool swapped : {false, true}) {
    Canvas canvas(kWidth, kHeight, kPaper);
    if (swapped) {
      canvas.line(9, 4, 2, 4, kRed);
    } else {
      canvas.line(2, 4, 9, 4, kRed);
    }
    const Box box = ink_box(canvas.picture());
    EXPECT_EQ(box.begin, (Place{2, 4}));
    EXPECT_EQ(box.end, (Place{10, 5}));
  }
  Canvas canvas(kWidth, kHeight, kPaper);
  canvas.line(5, -100, 5, 100, kRed);
  EXPECT_EQ(ink_box(canvas.picture()).begin, (Place{5, 0}));
  EXPECT_EQ(ink_box(canvas.picture()).end, (Place{6, kHeight}));
  EXPECT_THROW(canvas.line(0, 0, 1, 1, kRed), std::invalid_argument);
}

TEST(Canvas, PastesWhatIsInsideAndNothingElse) {
  const Picture picture = test_picture(6, 5);
  const Canvas blank(kWidth, kHeight, kPaper);
  for (int y = -7; y <= kHeight + 2; ++y) {
    for (int x = -8; x <= kWidth + 2; ++x) {
      Canvas canvas = blank;
      canvas.paste(picture, x, y);
      for (int py = 0; py < kHeight; ++py) {
        for (int px = 0; px < kWidth; ++px) {
          const bool pasted = is_in(px, py, x, y, picture.width, picture.height);
          ASSERT_EQ(pixel_at(canvas.picture(), px, py),
                    pasted ? pixel_at(picture, px - x, py - y) : tests::kWhite);
        }
      }
    }
  }
}

const std::vector<std::string> kTexts = {"measured",
                                         "Callisto, 12 effects",
                                         "fjgQ|_",
                                         "exposure +1.5 stops",
                                         "φd = 90°, f cos θi (sr⁻¹)",
                                         "−0.25 × 2^−3",
                                         "ΔE 1.3"};
constexpr FontWeight kWeights[] = {FontWeight::kRegular, FontWeight::kBold};

TEST(CanvasText, LeavesInkInsideTheMeasuredBoxAndNowhereElse) {
  for (const std::string& text : kTexts) {
    for (const FontWeight weight : kWeights) {
      for (const int size_px : {8, 16, 31}) {
        const int width = text_width(text, size_px, weight);
        Canvas canvas(width + 40, 3 * size_px, kPaper);
        canvas.text(20, 2 * size_px, text, {.size_px = size_px, .weight = weight});
        const Box box = ink_box(canvas.picture());
        ASSERT_FALSE(box.is_empty()) << text;
        // A letter may reach over its own advance by its rounded edge, the long f and j by a tenth.
        EXPECT_GE(box.begin.x, 20 - 1 - size_px / 10) << text;
        EXPECT_LE(box.end.x, 20 + width + 1 + size_px / 10) << text;
        EXPECT_GE(box.begin.y, size_px) << text;
        EXPECT_LE(box.end.y, 2 * size_px + 1 + size_px / 4) << text;
        // And the box is about as long as the ink.
        EXPECT_GE(box.end.x - box.begin.x, width - size_px / 2) << text;
      }
    }
  }
}

TEST(CanvasText, IsCutOffAtTheBorders) {
  const TextStyle style{.size_px = 20, .align_x = AlignX::kCentre, .align_y = AlignY::kCentre};
  constexpr int kMargin = 60;
  for (const Place& place : {Place{0, 0}, Place{40, 0}, Place{0, 24}, Place{40, 24}, Place{-30, 10}}) {
    for (const bool upwards : {false, true}) {
      TextStyle turned = style;
      turned.upwards = upwards;
      Canvas small(40, 24, kPaper);
      small.text(place.x, place.y, "Fresnel", turned);
      Canvas large(40 + 2 * kMargin, 24 + 2 * kMargin, kPaper);
      large.text(place.x + kMargin, place.y + kMargin, "Fresnel", turned);
      EXPECT_EQ(small.picture().rgb,
                cut(large.picture(), {{kMargin, kMargin}, {kMargin + 40, kMargin + 24}}).rgb);
    }
  }
}

// A text function may lose what is outside ASCII without an error: a degree sign is then a zero.
TEST(CanvasText, DrawsCharactersOutsideAsciiAsThemselves) {
  for (const FontWeight weight : kWeights) {
    const TextStyle style{.size_px = 24, .weight = weight};
    std::vector<Picture> seen;
    for (const char* text : {"θ", "φ", "°", "−", "⁻", "¹", "Δ", "²", "×", "≤", "\uFFFD", "0", "-", "8",
                             "1", "9", "4", "p", "b", "o", "f", "q", "?", "A", "2",      "x", "_"}) {
      seen.push_back(picture_of_text(text, style));
    }
    for (std::size_t a = 0; a < seen.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        EXPECT_FALSE(seen[a].width == seen[b].width && seen[a].rgb == seen[b].rgb) << a << " " << b;
      }
    }
    EXPECT_NE(picture_of_text("90°", style).rgb, picture_of_text("900", style).rgb);
    // The degree sign is a small ring high up.
    EXPECT_LT(picture_of_text("°", style).height, picture_of_text("0", style).height * 2 / 3);
  }
}

TEST(CanvasText, DrawsOnePixelOfInkTheColourOfTheStyle) {
  Canvas canvas(80, 60, kPaper);
  canvas.text(5, 50, "I", {.size_px = 48, .colour = kRed, .weight = FontWeight::kBold});
  const Box box = ink_box(canvas.picture());
  EXPECT_EQ(pixel_at(canvas.picture(), (box.begin.x + box.end.x) / 2, (box.begin.y + box.end.y) / 2),
            kRedPixel);
}

TEST(CanvasText, IsAlignedAlongTheLine) {
  const std::string text = "φd = 90°";
  const int width = text_width(text, 18, FontWeight::kRegular);
  const auto drawn = [&](int x, AlignX align) {
    Canvas canvas(300, 40, kPaper);
    canvas.text(x, 30, text, {.size_px = 18, .align_x = align});
    return canvas.picture().rgb;
  };
  EXPECT_EQ(drawn(200, AlignX::kRight), drawn(200 - width, AlignX::kLeft));
  EXPECT_EQ(drawn(150, AlignX::kCentre), drawn(150 - width / 2, AlignX::kLeft));
}

TEST(CanvasText, IsAlignedAcrossTheLineWhateverItsLetters) {
  for (const int size_px : {10, 16, 40}) {
    const auto box_of = [&](const char* text, AlignY align) {
      Canvas canvas(300, 200, kPaper);
      canvas.text(20, 100, text, {.size_px = size_px, .align_y = align});
      return ink_box(canvas.picture());
    };
    EXPECT_EQ(box_of("H", AlignY::kBaseline).end.y, 100);
    for (const char* text : {"Hg", "dpl"}) {
      EXPECT_GE(box_of(text, AlignY::kTop).begin.y, 100 - 1);
      EXPECT_LE(box_of(text, AlignY::kTop).begin.y, 100 + 1 + size_px / 8);
      EXPECT_LE(box_of(text, AlignY::kBottom).end.y, 100 + 1);
      EXPECT_GE(box_of(text, AlignY::kBottom).end.y, 100 - 1 - size_px / 8);
    }
    const Box middle = box_of("H", AlignY::kCentre);
    EXPECT_NEAR(middle.begin.y + middle.end.y, 200, 2);
    for (const AlignY align : {AlignY::kTop, AlignY::kCentre, AlignY::kBottom}) {
      EXPECT_EQ(box_of("H", align).end.y,
                box_of("Hg", align).end.y - box_of("Hg", AlignY::kBaseline).end.y + 100);
    }
  }
}

TEST(CanvasText, UpwardsIsTheSameTextTurned) {
  constexpr int kSide = 160;
  for (const AlignX align_x : {AlignX::kLeft, AlignX::kCentre, AlignX::kRight}) {
    for (const AlignY align_y : {AlignY::kTop, AlignY::kCentre, AlignY::kBaseline, AlignY::kBottom}) {
      TextStyle style{.size_px = 18, .align_x = align_x, .align_y = align_y};
      Canvas upright(kSide, kSide, kPaper);
      upright.text(70, 90, "θd, 45°", style);
      style.upwards = true;
      Canvas turned(kSide, kSide, kPaper);
      turned.text(90, kSide - 70, "θd, 45°", style);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          ASSERT_EQ(pixel_at(turned.picture(), y, kSide - 1 - x), pixel_at(upright.picture(), x, y));
        }
      }
    }
  }
}

TEST(CanvasText, OfNothingIsNothing) {
  EXPECT_EQ(text_width("", 16, FontWeight::kRegular), 0);
  Canvas canvas(20, 20, kPaper);
  canvas.text(10, 10, "", {});
  canvas.text(5, 15, " \t\n", {.size_px = 10});
  EXPECT_TRUE(ink_box(canvas.picture()).is_empty());
  EXPECT_THROW(canvas.text(0, 0, "a", {.size_px = 0}), std::invalid_argument);
  EXPECT_THROW(text_width("a", -1, FontWeight::kRegular), std::invalid_argument);
}

TEST(TextWidth, GrowsWithTheTextAndItsSize) {
  for (const FontWeight weight : kWeights) {
    for (const std::string& text : kTexts) {
      std::string longer;
      for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = next_character(text, begin);
        const int before = text_width(longer, 16, weight);
        longer.append(text, begin, end - begin);
        EXPECT_GT(text_width(longer, 16, weight), before) << longer;
        begin = end;
      }
      for (const int size_px : {10, 20, 40}) {
        EXPECT_GT(text_width(text, 2 * size_px, weight), text_width(text, size_px, weight));
        // Advances are rounded to pixels, one letter at a time.
        const double scaled = text_width(text, 400, weight) * (size_px / 400.0);
        EXPECT_NEAR(text_width(text, size_px, weight), scaled, 0.51 * static_cast<double>(text.size()));
      }
    }
  }
}

TEST(DecodeUtf8, GivesTheCodePoints) {
  EXPECT_EQ(decode_utf8("90°"), U"90°");
  EXPECT_EQ(decode_utf8("θ−⁻\U0001F600"), U"θ−⁻\U0001F600");
  EXPECT_EQ(decode_utf8("\u0080\u07FF\u0800\uFFFF\U00010000\U0010FFFF"),
            U"\u0080\u07FF\u0800\uFFFF\U00010000\U0010FFFF");
  EXPECT_EQ(decode_utf8("a\tb\x7F"), U"a b ");
}

TEST(DecodeUtf8, ShowsWhatIsNotUtf8AsReplacement) {
  const std::vector<std::string> broken = {
      "\x80",              // goes on with nothing
      "\xC3",              // ends early
      "\xE2\x82",          //
      "\xF0\x9F\x98",      //
      "\xC0\xAF",          // longer than it need be
      "\xE0\x80\x80",      //
      "\xF0\x80\x80\x80",  //
      "\xED\xA0\x80",      // half of a surrogate pair
      "\xF4\x90\x80\x80",  // beyond the last plane
      "\xFF",              // in no text
      "\xF8\x88\x80\x80\x80",
  };
  for (const std::string& bytes : broken) {
    const std::u32string points = decode_utf8("a" + bytes + "b");
    EXPECT_EQ(points.front(), U'a');
    EXPECT_EQ(points.back(), U'b');
    for (const char32_t c : points.substr(1, points.size() - 2)) EXPECT_EQ(c, U'\uFFFD');
    Canvas canvas(100, 30, kPaper);
    canvas.text(5, 20, bytes, {});
    EXPECT_FALSE(ink_box(canvas.picture()).is_empty());
  }
}

TEST(DecodeUtf8, TakesAnyBytes) {
  for (unsigned bits = 0; bits < 65536; ++bits) {
    const std::string bytes = {static_cast<char>(bits >> 8), static_cast<char>(bits & 0xFF), 'x'};
    const std::u32string points = decode_utf8(bytes);
    ASSERT_LE(points.size(), bytes.size());
    ASSERT_GE(points.size(), 1U);
  }
}

}  // namespace
}  // namespace brdfit::render
