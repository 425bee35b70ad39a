// One self-contained HTML file about fitted materials: the table, and per material its pictures, parameters,
// timings and provenance. Needs no network and no server.
#ifndef BRDFIT_RENDER_REPORT_H_
#define BRDFIT_RENDER_REPORT_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace brdfit::render {

// A parameter of a fitted material, on its range.
struct ReportParameter {
  std::string name;
  std::string help;
  std::vector<double> values;  // 1, or 3 (linear red, green, blue)
  double lower = 0.0;
  double upper = 1.0;
  double default_value = 0.0;
  std::string srgb8;   // "(12, 34, 56)" for colours, else empty
  std::string status;  // as in material files; empty if unknown
};

// A measure in the table. Both may be missing.
struct ReportMeasure {
  std::string name;  // "log-ratio %"
  std::optional<double> slice;
  std::optional<double> table;
};

struct ReportFit {
  std::string model;  // "Callisto"
  std::string file;   // base name of the material file
  int free_parameters = 0;
  std::vector<ReportMeasure> measures;
  std::optional<double> sphere_delta_e;
  std::vector<std::string> effects;
  std::vector<ReportParameter> parameters;
  std::vector<std::string> notes;
  // By phase. The table shows the one called "fit" or "total", or the sum where there is neither.
  std::vector<std::pair<std::string, double>> timings_seconds;
  std::vector<std::pair<std::string, std::string>> provenance;  // input, SHA-256, version, command, options
};

// A picture: PNG bytes or SVG text. A size of 0 is taken from the picture itself. SVG stands in the page as
// it is: only what this room draws may be given.
struct ReportPicture {
  std::string caption;
  std::string alt;  // for those who cannot see it
  std::vector<unsigned char> png;
  std::string svg;  // used where png is empty; an XML header is left out
  int width_px = 0;
  int height_px = 0;
};

struct ReportMaterial {
  std::string name;
  std::vector<ReportFit> fits;
  std::vector<ReportPicture> pictures;
  std::vector<std::string> warnings;  // measured table not found, cells that are not finite, ...
};

struct Report {
  std::string title;
  std::string version;
  std::string command;
  std::vector<ReportMaterial> materials;
  std::vector<std::string> warnings;  // files that could not be read
};

// The file's text, UTF-8. All text is escaped. Columns of the table can be sorted by mouse and keyboard.
std::string report_html(const Report& report);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_H_
