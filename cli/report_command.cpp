// brdfit report: one HTML file about a folder of fitted materials.
#include <fmt/format.h>

#include "cli/report_data.h"
#include "cli/threads.h"
#include "io/image_file.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  PictureArguments picture{320};
  SliceArguments slice;
  TableReading reading;
  std::string folder;
  std::vector<std::string> measured;
  std::string output;
};

int run(const Arguments& a, const std::string& command_line) {
  const std::filesystem::path output =
      a.output.empty() ? std::filesystem::path(a.folder) / "report.html" : std::filesystem::path(a.output);
  prepare_output(output, a.common.force);
  const ThreadLimit threads(a.common.threads);
  ReportOptions options;
  options.measured = a.measured;
  options.reading = a.reading;
  options.comparison.slice_size = a.picture.size;
  options.comparison.sphere_size = std::max(16, a.picture.size / 2);
  options.comparison.view = view_options_of(a.picture);
  options.comparison.slice = a.slice;
  const render::Report report = make_report(a.folder, options, command_line, a.common);
  const std::string html = render::report_html(report);
  io::write_text(output, html);
  std::vector<std::string> warnings = report.warnings;
  for (const render::ReportMaterial& material : report.materials) {
    for (const std::string& warning : material.warnings) warnings.push_back(material.name + ": " + warning);
  }
  if (a.common.json) {
    fmt::print("{}\n", io::Json{{"report", output.string()},
                                {"bytes", html.size()},
                                {"materials", report.materials.size()},
                                {"warnings", warnings}}
                           .dump(2));
  } else {
    for (const std::string& warning : warnings) fmt::print(stderr, "brdfit report: {}\n", warning);
    say(a.common, fmt::format("wrote {}: {} materials, {:.1f} MB", output.string(), report.materials.size(),
                              static_cast<double>(html.size()) / 1e6));
  }
  return report.warnings.empty() ? kDone : kNotAllDone;
}

}  // namespace

Command add_report_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("report", "one HTML file about a folder of fitted materials");
  app->footer(
      "Example: brdfit report fits --measured merl/\n"
      "writes fits/report.html: errors, pictures, parameters, timings and provenance; needs no network.");
  app->add_option("folder", a->folder, "folder that `brdfit fit` wrote to")
      ->required()
      ->check(CLI::ExistingDirectory);
  app->add_option(
      "--measured", a->measured,
      "files or folders with the measured tables, where they are not where they were when fitted");
  app->add_option("-o,--output", a->output, "file to write; report.html in the folder if not given")
      ->take_last();
  add_picture_arguments(*app, a->picture);
  add_slice_arguments(*app, a->slice);
  add_table_reading(*app, a->reading);
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string& command_line) { return run(*a, command_line); }};
}

}  // namespace brdfit::cli
