// brdfit compare: a measured table and materials side by side.
#include <fmt/format.h>

#include <algorithm>

#include "cli/comparison.h"
#include "cli/picture_file.h"
#include "cli/subject_input.h"
#include "cli/threads.h"
#include "cli/version.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  PictureArguments picture{320};
  SliceArguments slice;
  TableReading reading;
  std::string reference;
  std::vector<std::string> candidates;
  std::string output = ".";
  std::vector<std::string> pictures;
  std::string difference;
  double range = 0.0;
  int sphere_size = 160;
};

ComparisonOptions options_of(const Arguments& a) {
  ComparisonOptions options;
  options.pictures = a.pictures;
  options.slice_size = a.picture.size;
  options.sphere_size = a.sphere_size;
  options.view = view_options_of(a.picture);
  options.slice = a.slice;
  if (!a.difference.empty()) options.difference = render::difference_kind_by_name(a.difference);
  options.range = a.range;
  slice_options_of(a.slice, a.picture.size);  // wrong ones are found before anything is read
  return options;
}

bool is_plot(const std::string& picture) {
  return picture == "lobes" || picture == "polar";
}

std::filesystem::path path_of(const Arguments& a, const std::string& picture) {
  return std::filesystem::path(a.output) /
         fmt::format("{}.{}.{}", base_name(a.reference), picture, is_plot(picture) ? "svg" : "png");
}

// "Callisto" for a material, or its file's name where two have the same model.
std::string title_of_candidate(const LoadedSubject& subject, const std::vector<LoadedSubject>& all) {
  if (!subject.material) return subject.name;
  const auto same = std::ranges::count_if(all, [&](const LoadedSubject& other) {
    return other.material && other.material->model() == subject.material->model();
  });
  return same > 1 ? subject.name : std::string(title_of(subject.material->model()));
}

void write(const Arguments& a, const ComparisonPicture& drawn) {
  const std::filesystem::path file = path_of(a, drawn.name);
  if (!drawn.svg.empty()) {
    io::write_text(file, drawn.svg);
    return;
  }
  write_picture(file, drawn.picture,
                {{"ImageDescription", drawn.alt},
                 {"brdfit:version", kVersion},
                 {"brdfit:exposure_stops", fmt::format("{:g}", a.picture.exposure_stops)},
                 {"brdfit:view", a.picture.view}});
}

int run(const Arguments& a) {
  const ComparisonOptions options = options_of(a);
  std::vector<std::string> names;
  for (const char* name : kComparisonPictures) {
    if (options.has(name)) names.emplace_back(name);
  }
  for (const std::string& name : names) prepare_output(path_of(a, name), a.common.force);
  const ThreadLimit threads(a.common.threads);
  const LoadedSubject reference = load_subject(a.reference, a.reading, a.common);
  std::vector<LoadedSubject> candidates;
  for (const std::string& file : a.candidates) candidates.push_back(load_subject(file, a.reading, a.common));
  const MeasuredTable* table = reference.subject().table();
  std::vector<render::Column> columns = {
      {table != nullptr ? "measured" : reference.name, reference.subject(), {}}};
  columns[0].lines = table != nullptr ? reference_lines(*table) : material_lines(*reference.material);
  for (const LoadedSubject& candidate : candidates) {
    columns.push_back({title_of_candidate(candidate, candidates), candidate.subject(),
                       candidate_lines(candidate.subject(), table)});
  }
  io::Json files = io::Json::object();
  for (const ComparisonPicture& drawn : draw_comparison(reference.name, columns, options)) {
    write(a, drawn);
    files[drawn.name] = path_of(a, drawn.name).string();
    if (!a.common.json) say(a.common, "wrote " + path_of(a, drawn.name).string());
  }
  if (a.common.json) fmt::print("{}\n", io::Json{{"pictures", files}}.dump(2));
  return kDone;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("compare", "a measured table and materials side by side");
  app->footer(
      "Example: brdfit compare blue-fabric.binary fits/blue-fabric.*.json -o pictures\n"
      "writes blue-fabric.slices.png, .spheres.png, .patches.png, .environments.png, .lobes.svg and "
      ".polar.svg.");
  app->add_option("reference", a->reference,
                  "what the others are held against: a MERL-format table (or a material)")
      ->required();
  app->add_option("candidates", a->candidates, "materials or tables")->required();
  app->add_option("-o,--output", a->output, "folder for the pictures")->capture_default_str()->take_last();
  app->add_option("--pictures", a->pictures,
                  "which of them: slices, spheres, patches, environments, lobes, polar; all "
                  "if not given")
      ->delimiter(',')
      ->check(
          CLI::IsMember(std::vector<std::string>(kComparisonPictures.begin(), kComparisonPictures.end())));
  app->add_option("--difference", a->difference,
                  "what stands below the pictures; log-ratio for slices and signed for spheres if not given")
      ->check(CLI::IsMember({"signed", "absolute", "log-ratio"}));
  app->add_option("--range", a->range, "difference at the end of the colour bar; 0: from the pictures")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app->add_option("--sphere-size", a->sphere_size, "pixels along the side of spheres and patches")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  add_picture_arguments(*app, a->picture);
  add_slice_arguments(*app, a->slice);
  add_table_reading(*app, a->reading);
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
