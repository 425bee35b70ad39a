// SVG files are well-formed, whatever text goes into them.
#include "render/svg.h"

#include <gmock/gmock.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/xml_reader.h"

namespace brdfit::render {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using tests::XmlReader;

constexpr const char* kReplacement = "\xEF\xBF\xBD";

TEST(XmlEscaped, EveryMarkupCharacterBecomesAnEntity) {
  EXPECT_EQ(xml_escaped(R"(a<b>&"c"'d')"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;");
}

TEST(XmlEscaped, WhatIsUtf8Stays) {
  const std::string text = "θ_h 90° f (sr⁻¹) ▲ 漢 \xF0\x9F\x94\xB5\ttab\nline";
  EXPECT_EQ(xml_escaped(text), text);
}

TEST(XmlEscaped, ControlCharactersAreReplaced) {
  EXPECT_EQ(xml_escaped(std::string("a\0b\x1B\x7F", 5)),
            std::string("a") + kReplacement + "b" + kReplacement + "\x7F");
  EXPECT_EQ(xml_escaped("\xC2\x85"), std::string(kReplacement) + kReplacement);
}

TEST(XmlEscaped, BytesThatAreNotUtf8AreReplaced) {
  for (const char* bad : {"\xFF", "\x80", "\xC0\xAF", "\xE2\x82", "\xED\xA0\x80", "\xF4\x90\x80\x80",
                          "\xEF\xBF\xBE", "\xE0\x80\x80", "\xF0\x80\x80\x80"}) {
    const std::string escaped = xml_escaped(std::string("a") + bad + "z");
    EXPECT_THAT(escaped, StartsWith(std::string("a") + kReplacement));
    EXPECT_THAT(escaped, testing::EndsWith("z"));
    EXPECT_EQ(xml_escaped(escaped), escaped) << "not valid UTF-8 after all";
  }
}

// Every pair of bytes, so that no path through the decoder reads past the end or lets something through.
TEST(XmlEscaped, EveryPairOfBytesGivesTextThatXmlAllows) {
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      const std::string text = {static_cast<char>(first), static_cast<char>(second)};
      const std::string file = "<a>" + xml_escaped(text) + "</a>";
      EXPECT_NO_THROW(XmlReader{file}) << first << " " << second;
    }
  }
}

Svg everything() {
  Svg svg(640.0, 480.5, "a < b & \"c\"", "who's there?");
  svg.begin_group(R"(fill="none")");
  svg.line({0.0, 1.0}, {2.123456, -3.0}, R"(stroke="#ddd")");
  svg.polyline(std::vector<SvgPoint>{{0.0, 0.0}, {1.5, 2.25}}, "");
  svg.rect({1.0, 2.0}, 3.0, 4.0, R"(fill="#fff")");
  svg.circle({5.0, 6.0}, 2.0, "", "<tip> & more");
  svg.text({7.0, 8.0}, "<script>", R"(class="t")");
  svg.symbols({7.0, 8.0}, "θ_h < φ_d", R"(class="s")");
  svg.end_group();
  return svg;
}

TEST(Svg, IsWellFormedWithAndWithoutAHeader) {
  EXPECT_THAT(everything().finish(true), StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg "));
  EXPECT_THAT(everything().finish(false), StartsWith("<svg "));
  for (const bool with_header : {true, false}) {
    const std::string file = everything().finish(with_header);
    const XmlReader read(file);
    const auto& root = read.elements()[0];
    EXPECT_EQ(root.attributes.at("xmlns"), "http://www.w3.org/2000/svg");
    EXPECT_EQ(root.attributes.at("width"), "640");
    EXPECT_EQ(root.attributes.at("viewBox"), "0 0 640 480.5");
    EXPECT_EQ(root.attributes.at("aria-label"), "a < b & \"c\"");
  }
}

TEST(Svg, TextComesBackAsGiven) {
  const std::string file = everything().finish();
  const XmlReader read(file);
  std::vector<std::string> texts;
  for (const auto& element : read.elements()) {
    if (element.name == "text" || element.name == "title" || element.name == "desc")
      texts.push_back(element.text);
  }
  EXPECT_THAT(texts,
              testing::ElementsAre("a < b & \"c\"", "who's there?", "<tip> & more", "<script>", "θh < φd"));
}

TEST(Svg, NumbersAreRoundedAndNeverMinusZero) {
  Svg svg(10.0, 10.0, "t", "d");
  svg.line({-0.001, 1.004999}, {2.5, 100.0}, "");
  EXPECT_THAT(svg.finish(), HasSubstr(R"(<line x1="0" y1="1" x2="2.5" y2="100"/>)"));
}

TEST(Svg, SubscriptsEndAtTheBaseline) {
  for (const char* text : {"θ_h", "θ_h_d = 3", "a_", "_x", "no subscript", "_", ""}) {
    Svg svg(10.0, 10.0, "t", "d");
    svg.symbols({0.0, 0.0}, std::string(text) + " end", "");
    const std::string file = svg.finish();
    const XmlReader read(file);
    double offset = 0.0;
    for (const auto& element : read.elements()) {
      if (element.name == "tspan") offset += element.number("dy");
    }
    EXPECT_EQ(offset, 0.0) << text;
  }
}

TEST(Svg, RefusesCoordinatesThatAreNotFinite) {
  Svg svg(10.0, 10.0, "t", "d");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(svg.line({0.0, bad}, {1.0, 1.0}, ""), std::invalid_argument);
    EXPECT_THROW(svg.circle({0.0, 0.0}, bad, ""), std::invalid_argument);
    EXPECT_THROW(svg.polyline(std::vector<SvgPoint>{{bad, 0.0}}, ""), std::invalid_argument);
    EXPECT_THROW(Svg(bad, 1.0, "t", "d"), std::invalid_argument);
  }
}

TEST(Svg, GroupsMustBeClosed) {
  Svg svg(10.0, 10.0, "t", "d");
  EXPECT_THROW(svg.end_group(), std::logic_error);
  svg.begin_group("");
  EXPECT_THROW(svg.finish(), std::logic_error);
  svg.end_group();
  EXPECT_THAT(svg.finish(), HasSubstr("<g>\n</g>"));
}

}  // namespace
}  // namespace brdfit::render
