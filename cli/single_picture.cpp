// One picture to a file.
#include "cli/single_picture.h"

#include <fmt/format.h>

#include "cli/picture_file.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "render/canvas.h"
#include "render/figure.h"

namespace brdfit::cli {
namespace {

constexpr std::array<const char*, render::kPixelStateCount> kStateNames = {
    "value", "outside", "below_horizon", "unmeasured", "not_finite", "negative"};

io::ImageMetadata metadata_of(const SinglePicture& a, const Drawing& drawing) {
  io::ImageMetadata metadata = {{"ImageDescription", drawing.what + " of " + base_name(a.file)},
                                {"brdfit:version", kVersion},
                                {"brdfit:input", std::filesystem::path(a.file).filename().string()},
                                {"brdfit:what", drawing.what},
                                {"brdfit:units", drawing.units}};
  if (!a.minus.empty()) {
    metadata.emplace_back("brdfit:minus", std::filesystem::path(a.minus).filename().string());
    metadata.emplace_back("brdfit:difference", a.difference);
  }
  for (const auto& [name, value] : drawing.facts.items()) {
    metadata.emplace_back("brdfit:" + name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return metadata;
}

// EXR files hold values before exposure and view transform, and say so.
io::ImageMetadata exr_metadata(const SinglePicture& a, const Drawing& drawing) {
  io::ImageMetadata metadata = metadata_of(a, drawing);
  metadata.emplace_back("brdfit:exposure_stops", "0");
  metadata.emplace_back("brdfit:encoding", "linear Rec.709; A is 1 where there is a value");
  return metadata;
}

io::ImageMetadata png_metadata(const SinglePicture& a, const Drawing& drawing) {
  io::ImageMetadata metadata = metadata_of(a, drawing);
  metadata.emplace_back("brdfit:exposure_stops", fmt::format("{:g}", a.picture.exposure_stops));
  metadata.emplace_back("brdfit:view", a.picture.view);
  metadata.emplace_back("brdfit:channel", a.picture.channel);
  return metadata;
}

void write_difference_values(const std::filesystem::path& file, const render::Difference& difference,
                             const io::ImageMetadata& metadata) {
  std::vector<float> samples;
  for (std::size_t k = 0; k < difference.value.size(); ++k) {
    samples.push_back(difference.value[k]);
    samples.push_back(difference.state[k] == render::PixelState::kValue ? 1.0F : 0.0F);
  }
  io::write_bytes(file, io::encode_exr({difference.width, difference.height, {"Y", "A"}, samples}, metadata));
}

// What a difference shows, in the order in which it was taken.
std::string difference_words(const SinglePicture& a, render::DifferenceKind kind) {
  const std::string first = base_name(a.file);
  const std::string second = base_name(a.minus);
  if (kind == render::DifferenceKind::kLogRatio) return fmt::format("ln of {} / {}", first, second);
  const std::string text = fmt::format("{} − {}", first, second);
  return kind == render::DifferenceKind::kAbsolute ? "|" + text + "|" : text;
}

// A difference with a title above and its colour bar on the right.
render::Picture difference_figure(const SinglePicture& a, const Drawing& drawing,
                                  const render::Difference& difference, render::DifferenceKind kind,
                                  double range) {
  const int text_px = std::max(13, difference.height / 28);
  const bool is_ratio = kind == render::DifferenceKind::kLogRatio;
  const render::Picture bar =
      render::colour_bar(kind, range, is_ratio ? "" : drawing.units, difference.height, text_px);
  const std::string title = difference_words(a, kind);
  const int gap = text_px;
  const int top = 4 * text_px;
  const auto width_of = [text_px](const std::string& text, render::FontWeight weight) {
    return render::text_width(text, text_px, weight);
  };
  const int text_width = std::max(width_of(title, render::FontWeight::kBold),
                                  width_of(drawing.what, render::FontWeight::kRegular));
  render::Canvas canvas(2 * gap + std::max(difference.width + gap + bar.width, text_width),
                        std::max(difference.height, bar.height) + top + gap, {255, 255, 255});
  canvas.text(gap, gap, title,
              {.size_px = text_px, .align_y = render::AlignY::kTop, .weight = render::FontWeight::kBold});
  canvas.text(gap, gap + 3 * text_px / 2, drawing.what,
              {.size_px = text_px, .align_y = render::AlignY::kTop});
  canvas.paste(render::difference_picture(difference, kind, range), gap, top);
  canvas.paste(bar, difference.width + 2 * gap, top);
  return canvas.picture();
}

void write_difference(const SinglePicture& a, const Drawing& drawing, const render::Image& image,
                      const render::Image& reference, const std::filesystem::path& output,
                      PictureFormat format) {
  const render::DifferenceKind kind = render::difference_kind_by_name(a.difference).value();
  render::ViewOptions view = view_options_of(a.picture);
  if (format == PictureFormat::kExr) view.exposure_stops = 0.0;
  const render::Difference difference = render::difference_of(image, reference, kind, view);
  if (format == PictureFormat::kExr) {
    write_difference_values(output, difference, exr_metadata(a, drawing));
    return;
  }
  const double range = a.range > 0.0 ? a.range : render::difference_range({&difference, 1});
  const render::Picture picture = a.plain ? render::difference_picture(difference, kind, range)
                                          : difference_figure(a, drawing, difference, kind, range);
  io::ImageMetadata metadata = png_metadata(a, drawing);
  metadata.emplace_back("brdfit:range", fmt::format("{:g}", range));
  write_picture(output, picture, metadata);
}

}  // namespace

void add_single_picture(CLI::App& app, SinglePicture& a) {
  app.add_option("file", a.file, "MERL-format .binary file, or a material .json")->required();
  app.add_option("-o,--output", a.output, "file to write: .png for eyes, .exr for values before exposure")
      ->take_last();
  app.add_option("--minus", a.minus, "a second table or material: the picture is the difference to it");
  app.add_option("--difference", a.difference, "how --minus compares")
      ->check(CLI::IsMember({"signed", "absolute", "log-ratio"}))
      ->capture_default_str();
  app.add_option("--range", a.range, "difference at the end of the colour bar; 0: from the picture")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--plain", a.plain, "pixels alone, without axes, titles and legends");
  add_picture_arguments(app, a.picture);
  add_table_reading(app, a.reading);
  add_common_options(app, a.common, true);
}

int draw_single(const SinglePicture& a, Drawing& drawing) {
  const std::filesystem::path output =
      a.output.empty() ? base_name(a.file) + "." + drawing.kind + ".png" : a.output;
  const PictureFormat format = picture_format_of(output);
  prepare_output(output, a.common.force);
  const ThreadLimit threads(a.common.threads);
  const LoadedSubject subject = load_subject(a.file, a.reading, a.common);
  const Stopwatch watch;
  const render::Image image = drawing.draw(subject.subject());
  const double draw_seconds = watch.seconds();
  if (!a.minus.empty()) {
    const LoadedSubject reference = load_subject(a.minus, a.reading, a.common);
    write_difference(a, drawing, image, drawing.draw(reference.subject()), output, format);
  } else if (format == PictureFormat::kExr) {
    write_values(output, image, exr_metadata(a, drawing));
  } else {
    const std::string title = drawing.title.empty() ? subject.name : drawing.title;
    write_picture(
        output,
        a.plain ? render::to_picture(image, view_options_of(a.picture)) : drawing.figure(image, title),
        png_metadata(a, drawing));
  }
  if (a.common.json) {
    io::Json pixels;
    const auto counts = image.counts();
    for (std::size_t k = 0; k < counts.size(); ++k) pixels[kStateNames[k]] = counts[k];
    io::Json json = {{"file", output.string()}, {"what", drawing.what},   {"units", drawing.units},
                     {"width", image.width},    {"height", image.height}, {"pixels", pixels}};
    json.update(drawing.facts);
    json["timings_seconds"] = {{"draw", draw_seconds}};
    fmt::print("{}\n", json.dump(2));
    return kDone;
  }
  const std::string missing = render::describe_missing(image);
  say(a.common, fmt::format("wrote {}{}", output.string(), missing.empty() ? "" : ": " + missing));
  return kDone;
}

}  // namespace brdfit::cli
