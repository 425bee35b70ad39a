// A small writer of SVG.
#include "render/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace brdfit::render {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

// The length of the UTF-8 character that text begins with, 0 if it does not begin with one that XML allows.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
    code = (code << 6) | (byte(k) & 0x3FU);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  // C1 controls are allowed in XML, but HTML does not want them, and nothing shows them.
  const bool is_allowed =
      code >= 0xA0 && !is_surrogate && code != 0xFFFE && code != 0xFFFF && code <= 0x10FFFF;
  return code >= kSmallest[length] && is_allowed ? length : 0;
}

std::string number(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("SVG: a coordinate is not finite");
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

// Attributes with a space before them, if there are any.
std::string spaced(std::string_view style) {
  return style.empty() ? std::string() : fmt::format(" {}", style);
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) {
      result += kReplacement;
    } else if (text[0] == '&') {
      result += "&amp;";
    } else if (text[0] == '<') {
      result += "&lt;";
    } else if (text[0] == '>') {
      result += "&gt;";
    } else if (text[0] == '"') {
      result += "&quot;";
    } else if (text[0] == '\'') {
      result += "&#39;";
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return result;
}

Svg::Svg(double width, double height, std::string_view title, std::string_view description,
         std::string_view role)
    : head_(fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" )"
                        R"(viewBox="0 0 {0} {1}" role="{4}" aria-label="{2}">)"
                        "\n<title>{2}</title>\n<desc>{3}</desc>\n",
                        number(width), number(height), xml_escaped(title), xml_escaped(description), role)) {}

void Svg::line(SvgPoint from, SvgPoint to, std::string_view style) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", number(from.first),
                       number(from.second), number(to.first), number(to.second), spaced(style));
}

void Svg::polyline(std::span<const SvgPoint> points, std::string_view style) {
  body_ += "<polyline points=\"";
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k > 0) body_ += ' ';
    body_ += number(points[k].first) + "," + number(points[k].second);
  }
  body_ += fmt::format("\"{}/>\n", spaced(style));
}

void Svg::rect(SvgPoint corner, double width, double height, std::string_view style) {
  body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", number(corner.first),
                       number(corner.second), number(width), number(height), spaced(style));
}

void Svg::circle(SvgPoint centre, double radius, std::string_view style, std::string_view tooltip) {
  body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}", number(centre.first), number(centre.second),
                       number(radius), spaced(style));
  body_ += tooltip.empty() ? "/>\n" : fmt::format("><title>{}</title></circle>\n", xml_escaped(tooltip));
}

void Svg::text(SvgPoint at, std::string_view text, std::string_view style) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", number(at.first), number(at.second),
                       spaced(style), xml_escaped(text));
}

void Svg::symbols(SvgPoint at, std::string_view text, std::string_view style) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>", number(at.first), number(at.second), spaced(style));
  bool is_lowered = false;
  while (!text.empty()) {
    if (text[0] == '_' && text.size() > 1) {
      // Moved by dy: browsers do not agree about baseline-shift.
      body_ += fmt::format("<tspan dy=\"{}\" font-size=\"75%\">{}</tspan>", is_lowered ? 0 : 3,
                           xml_escaped(text.substr(1, 1)));
      is_lowered = true;
      text.remove_prefix(2);
      continue;
    }
    const std::string plain = xml_escaped(text.substr(0, text.find('_', 1)));
    body_ += is_lowered ? fmt::format("<tspan dy=\"-3\">{}</tspan>", plain) : plain;
    is_lowered = false;
    text.remove_prefix(std::min(text.size(), text.find('_', 1)));
  }
  body_ += "</text>\n";
}

void Svg::begin_group(std::string_view style, std::string_view tooltip) {
  body_ += fmt::format("<g{}>\n", spaced(style));
  if (!tooltip.empty()) body_ += fmt::format("<title>{}</title>\n", xml_escaped(tooltip));
  ++open_groups_;
}

void Svg::end_group() {
  if (open_groups_ == 0) throw std::logic_error("SVG: no group is open");
  body_ += "</g>\n";
  --open_groups_;
}

std::string Svg::finish(bool with_header) const {
  if (open_groups_ != 0) throw std::logic_error("SVG: a group is still open");
  return (with_header ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" : "") + head_ + body_ + "</svg>\n";
}

}  // namespace brdfit::render
