// Pieces of HTML.
#include "render/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/svg.h"

namespace brdfit::render {

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) bits = (bits << 8) | (b < count ? bytes[k + b] : 0U);
    for (std::size_t digit = 0; digit < 4; ++digit) {
      text += digit <= count ? kDigits[(bits >> (18 - 6 * digit)) & 63U] : '=';
    }
  }
  return text;
}

std::string shown(double value) {
  if (!std::isfinite(value)) return "not finite";
  const double size = std::abs(value);
  if (size < 1e6 && size == std::floor(size)) return fmt::format("{:.0f}", value);
  if (size < 1e-4 || size >= 1e6) return fmt::format("{:.3g}", value);
  // Trailing zeros are kept, so that neighbours in a column look alike.
  int decimals = 2;
  for (double limit = 10.0; size >= limit && decimals > 0; limit *= 10.0) --decimals;
  for (double scale = 1.0; size * scale < 1.0; scale *= 10.0) ++decimals;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string exact(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string breakable(const std::string& name) {
  std::string html;
  for (const char c : xml_escaped(name)) {
    html += c;
    if (c == '_') html += "<wbr>";
  }
  return html;
}

std::string section_id(std::size_t material) {
  return fmt::format("m{}", material);
}

std::string fit_id(std::size_t material, std::size_t fit) {
  return fmt::format("m{}-f{}", material, fit);
}

std::string warning_list(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string html = "<ul class=\"warnings\">\n";
  for (const std::string& warning : warnings) {
    html += fmt::format("<li><b>Warning:</b> {}</li>\n", xml_escaped(warning));
  }
  return html + "</ul>\n";
}

}  // namespace brdfit::render
