// Pictures in the page.
#include "render/report/picture.h"

#include <fmt/format.h>

#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

// A size that the picture's maker left open is in the PNG's own header (IHDR).
int png_size(const std::vector<unsigned char>& png, std::size_t offset) {
  if (png.size() < offset + 4) return 0;
  int size = 0;
  for (std::size_t k = 0; k < 4; ++k) size = (size << 8) | png[offset + k];
  return size;
}

// A plot speaks for itself by its own title; what the caller says of it comes first.
std::string plot_html(const ReportPicture& picture) {
  const std::size_t start = picture.svg.find("<svg");
  if (start == std::string::npos) return "";
  return fmt::format("<span role=\"img\" aria-label=\"{}\">{}</span>", xml_escaped(picture.alt),
                     picture.svg.substr(start));
}

}  // namespace

std::string image_html(const ReportPicture& picture) {
  const int width = picture.width_px > 0 ? picture.width_px : png_size(picture.png, 16);
  const int height = picture.height_px > 0 ? picture.height_px : png_size(picture.png, 20);
  return fmt::format(
      "<img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{}\" height=\"{}\" "
      "loading=\"lazy\" decoding=\"async\">",
      base64(picture.png), xml_escaped(picture.alt), width, height);
}

std::string figure_html(const ReportPicture& picture) {
  const std::string content = picture.png.empty() ? plot_html(picture) : image_html(picture);
  const std::string caption = xml_escaped(picture.caption);
  if (content.empty()) {
    return fmt::format("<figure><p class=\"missing\">no picture</p><figcaption>{}</figcaption></figure>\n",
                       caption);
  }
  const int width = picture.width_px > 0 ? picture.width_px : png_size(picture.png, 16);
  const int height = picture.height_px > 0 ? picture.height_px : png_size(picture.png, 20);
  const char* wide = 10 * width > 16 * height ? " class=\"wide\"" : "";
  return fmt::format(
      "<figure{}><button type=\"button\" class=\"zoom\" title=\"Full size\">{}</button>"
      "<figcaption>{}</figcaption></figure>\n",
      wide, content, caption);
}

}  // namespace brdfit::render
