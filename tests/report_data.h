// A report with everything in it, for tests: odd names, missing values, pictures and plots.
#ifndef BRDFIT_TESTS_REPORT_DATA_H_
#define BRDFIT_TESTS_REPORT_DATA_H_

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "data/synthetic/counter_random.h"
#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "io/image_file.h"
#include "render/lobes.h"
#include "render/report.h"

namespace brdfit::testing_support {

inline constexpr const char* kHostileName = R"(<script>alert("1")</script> & 'co')";

// A picture that is easy to recognise: a gradient with a chequered part.
inline render::ReportPicture gradient_picture(int width, int height) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool is_dark = x < width / 4 && (x / 16 + y / 16) % 2 == 0;
      rgb.push_back(static_cast<std::uint8_t>(is_dark ? 20 : 255 * x / width));
      rgb.push_back(static_cast<std::uint8_t>(is_dark ? 20 : 255 * y / height));
      rgb.push_back(128);
    }
  }
  render::ReportPicture picture;
  picture.caption = "Slice at phi_d = 90°, exposure 0";
  picture.alt = "Reference and three models side by side";
  picture.png = io::encode_png({width, height, 3, rgb});
  picture.width_px = width;
  picture.height_px = height;
  return picture;
}

inline render::ReportPicture plot_picture(const Material& material) {
  synthetic::Recipe recipe;
  recipe.name = "test";
  recipe.material = material;
  recipe.grid = {30, 30, 60, CellAnchor::kLowerEdge};
  const MeasuredTable table = synthetic::generate_table(recipe);
  Material other = material;
  other.set("roughness", 0.5);
  render::LobeOptions options;
  options.theta_d_deg = {0.0, 60.0};
  render::ReportPicture picture;
  picture.caption = "Lobes";
  picture.alt = "f over theta_h";
  picture.svg = render::lobe_plots(&table, {{"the same", material}, {"rougher", other}}, options);
  return picture;
}

// A small square. All are the same, encoded once: there are many of them.
inline render::ReportPicture tile(const std::string& alt) {
  static const render::ReportPicture kSquare = gradient_picture(128, 128);
  render::ReportPicture picture = kSquare;
  picture.alt = alt;
  return picture;
}

// Effects come one by one, one goes again.
inline render::ReportLadder sample_ladder(int rungs) {
  constexpr const char* kNames[] = {"diffuse_fresnel", "diffuse_fresnel_tangent_falloff", "retroreflection",
                                    "smooth_terminator"};
  render::ReportLadder ladder;
  for (int k = 0; k < rungs; ++k) {
    render::ReportRung rung;
    if (k > 0) rung.groups = {kNames[k % 4], kNames[(k + 1) % 4]};
    rung.is_removal = k == rungs - 1;
    rung.held_out_pct = 20.0 + 18.0 / (1.0 + k) + (rung.is_removal ? 0.1 : 0.0);
    if (k > 0) rung.standard_error_pct = 0.8 / k;
    rung.free_parameters = 6 + 3 * k - (rung.is_removal ? 5 : 0);
    rung.evaluation_ns = 8.0 + k;
    rung.slice = tile("slice of rung " + std::to_string(k));
    rung.difference = tile("log-ratio of rung " + std::to_string(k));
    ladder.rungs.push_back(rung);
  }
  ladder.held_out_all_pct = 22.5;
  ladder.free_parameters_all = 29;
  ladder.measured = tile("measured slice");
  ladder.colour_bar = tile("colours");
  return ladder;
}

// Numbers that look like those of fits, different in every fit.
inline render::ReportFit sample_fit(const std::string& model, std::uint64_t seed) {
  const synthetic::CounterRandom random(seed, 0);
  render::ReportFit fit;
  fit.model = model;
  fit.file = "sample." + model + ".json";
  fit.free_parameters = static_cast<int>(5 + random.below(0, 20));
  std::uint64_t counter = 1;
  for (const char* name : {"log-ratio %", "slice %", "relative", "cube root", "sRGB", "cosine L2"}) {
    const double scale = std::string(name).ends_with('%') ? 40.0 : 0.5;
    fit.measures.push_back({name, scale * random.uniform(counter), scale * random.uniform(counter + 1)});
    counter += 2;
  }
  if (seed % 4 != 1) fit.sphere_delta_e = 12.0 * random.uniform(counter++);
  fit.effects = {"diffuse_fresnel", "retroreflection"};
  fit.parameters = {
      {"base_color", "colour at normal incidence", {0.8, 0.25, 0.02}, 0.0, 1.0, 0.18, "(231, 137, 39)", "ok"},
      {"metallic", "0 dielectric, 1 metal", {random.uniform(counter)}, 0.0, 1.0, 0.0, "", "unidentifiable"},
      {"roughness", "alpha = roughness^2", {0.01}, 0.01, 1.0, 0.5, "", "at lower bound"},
      {"diffuse_fresnel_tangent_falloff", "strength of the rim", {24.2737}, 0.0, 100.0, 1.0, "", "fixed"}};
  fit.parameters[0].standard_errors = {0.15, 0.02, std::nullopt};
  fit.parameters[1].standard_errors = {std::nullopt};
  fit.parameters[1].reason = "tied to specular: another combination fits as well";
  fit.parameters.push_back({"roughness_2", "alpha of another", {0.4}, 0.01, 1.0, 0.5, "", "ok", {0.5}, ""});
  if (model == "Callisto") {
    fit.ladder = sample_ladder(8);
    fit.losses = {{"log-ratio", 3.0, false}, {"srgb", 2.0, true}, {"linear", 2.5, false}};
    for (const double correlation : {0.96, -0.98, 0.97, 0.99, -0.999, 0.951}) {
      fit.correlated.push_back({"diffuse_fresnel_tangent_falloff", "base_color.r", correlation});
    }
  }
  fit.notes = {"metallic and specular cannot be told apart: f0 is 0.09 at most"};
  fit.timings_seconds = {{"explore", 0.4}, {"refine", 0.15}, {"fit", 0.55 + random.uniform(counter + 1)}};
  fit.provenance = {
      {"input", "sample.binary"},
      {"SHA-256 of the input", "d87a051fc39ccf7a8e51a8d339212816e369bd49fc72705f7094d7bbfb39e63f"},
      {"brdfit version", "0.1.0"},
      {"command", "brdfit fit sample.binary --model all -o results"},
      {"options", R"({"tier":"full","on":"table","samples":20000,"max_theta_deg":90.0,"loss":"log-ratio"})"}};
  return fit;
}

inline render::Report sample_report(int materials, bool has_pictures = true) {
  render::Report report;
  report.title = "results";
  report.version = "0.1.0";
  report.command = "brdfit report results";
  report.warnings = {"results/broken.json: is not JSON"};
  for (int k = 0; k < materials; ++k) {
    render::ReportMaterial material;
    material.name = k == 1 ? kHostileName : "material-" + std::to_string(k);
    const auto seed = static_cast<std::uint64_t>(10 * k);
    for (const char* model : {"Lambert + GGX", "Burley", "Callisto"}) {
      material.fits.push_back(sample_fit(model, seed + material.fits.size()));
    }
    if (k == 2) {
      material.fits[0].measures[0].table.reset();
      material.fits[1].measures[0].table = std::numeric_limits<double>::quiet_NaN();
      material.warnings = {"the measured table was not found, so nothing is drawn"};
    } else if (has_pictures) {
      material.pictures.push_back(gradient_picture(1280, 420));
      material.pictures.push_back(gradient_picture(400, 400));
      material.pictures.push_back(
          plot_picture(synthetic::random_material(Model::kCallisto, Tier::kBase, {}, {}, seed)));
    }
    report.materials.push_back(material);
  }
  return report;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_REPORT_DATA_H_
