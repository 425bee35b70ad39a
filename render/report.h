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
  // Of each value, or none at all; nothing where the samples do not say.
  std::vector<std::optional<double>> standard_errors = {};
  std::string reason = {};  // why it is unidentifiable, in words
};

// Two numbers whose estimates move together.
struct ReportCorrelation {
  std::string first;
  std::string second;
  double correlation = 0.0;
};

// A loss that was tried.
struct ReportLoss {
  std::string name;
  double sphere_delta_e = 0.0;
  bool is_kept = false;
};

// A measure in the table. Both may be missing.
struct ReportMeasure {
  std::string name;  // "log-ratio %"
  std::optional<double> slice;
  std::optional<double> table;
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

// A set of effects that a choice of effects came to, on its way.
struct ReportRung {
  std::vector<std::string> groups;  // that were added or removed; for the first rung what it begins with
  bool is_removal = false;
  double held_out_pct = 0.0;                 // log-ratio
  std::optional<double> standard_error_pct;  // of the difference to the rung before
  int free_parameters = 0;
  std::optional<double> evaluation_ns;
  ReportPicture slice;       // small, of the material with these effects
  ReportPicture difference;  // of that to the measured slice; both may be empty
};

struct ReportLadder {
  std::vector<ReportRung> rungs;
  std::optional<double> held_out_all_pct;  // with all effects on
  std::optional<int> free_parameters_all;
  ReportPicture measured;    // the measured slice
  ReportPicture colour_bar;  // of the differences; both may be empty
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
  std::optional<ReportLadder> ladder;         // where effects were chosen
  std::vector<ReportLoss> losses;             // where the loss was chosen
  std::vector<ReportCorrelation> correlated;  // of its numbers
  // By phase. The table shows the one called "fit" or "total", or the sum where there is neither.
  std::vector<std::pair<std::string, double>> timings_seconds;
  std::vector<std::pair<std::string, std::string>> provenance;  // input, SHA-256, version, command, options
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
