// Pieces of HTML that the parts of the report share.
#ifndef BRDFIT_RENDER_REPORT_HTML_H_
#define BRDFIT_RENDER_REPORT_HTML_H_

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brdfit::render {

// RFC 4648, with padding.
std::string base64(std::span<const unsigned char> bytes);

// Text for a reader: three significant digits or whole numbers; "not finite" for NaN and
// infinity.
std::string shown(double value);

// The shortest text that reads back as the same number; empty if it is not finite. For data-value.
std::string exact(double value);

// A name, escaped, that may be broken behind its underscores.
std::string breakable(const std::string& name);

// "m3": the id of a material's section; "m3-f2": of a fit in it. Both count from 0.
std::string section_id(std::size_t material);
std::string fit_id(std::size_t material, std::size_t fit);

// A list of warnings, or nothing where there are none.
std::string warning_list(const std::vector<std::string>& warnings);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_HTML_H_
