// A small writer of SVG 1.1: shapes and text, with numbers rounded so that files stay small and stable. It
// has no ids and no style sheet, so that many pictures can stand in one HTML file.
#ifndef BRDFIT_RENDER_SVG_H_
#define BRDFIT_RENDER_SVG_H_

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace brdfit::render {

using SvgPoint = std::pair<double, double>;

// &, <, >, " and ' as entities; control characters and bytes that are not UTF-8 become U+FFFD.
std::string xml_escaped(std::string_view text);

// Coordinates are in pixels, y downwards, written to a hundredth. One that is not finite is an error
// (std::invalid_argument).
class Svg {
 public:
  // description: for those who cannot see the picture. role: "img", or "group" where parts of it can be
  // reached by themselves.
  Svg(double width, double height, std::string_view title, std::string_view description,
      std::string_view role = "img");

  // style: attributes as they stand in the file, e.g. R"(stroke="#c33" fill="none")"; may be empty.
  void line(SvgPoint from, SvgPoint to, std::string_view style);
  void polyline(std::span<const SvgPoint> points, std::string_view style);
  void rect(SvgPoint corner, double width, double height, std::string_view style);
  void circle(SvgPoint centre, double radius, std::string_view style, std::string_view tooltip = {});
  void text(SvgPoint at, std::string_view text, std::string_view style);
  // As text, where "_x" is a subscript of one character: "\u03B8_h".
  void symbols(SvgPoint at, std::string_view text, std::string_view style);
  void begin_group(std::string_view style, std::string_view tooltip = {});
  void end_group();

  // The whole file. with_header: an XML declaration before it; without, for use inside HTML. Throws
  // std::logic_error while a group is open.
  std::string finish(bool with_header = true) const;

 private:
  std::string head_;
  std::string body_;
  int open_groups_ = 0;
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_SVG_H_
