// brdfit info: what a file holds, and whether it is sound.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "brdf/albedo.h"
#include "cli/common.h"
#include "cli/result_text.h"
#include "cli/stack_info.h"
#include "cli/subject_input.h"
#include "cli/table_input.h"
#include "cli/threads.h"
#include "io/material_json.h"
#include "io/sha256.h"
#include "measured/symmetry.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  std::string file;
  bool lenient = false;
  std::string transfer;  // of a stack; empty: as the files say
  std::string lights;    // of a stack: the picture of its lights
};

int describe_table(const Arguments& a) {
  io::MerlReadOptions options;
  options.lenient = a.lenient;
  const LoadedTable loaded = load_table(a.file, options, a.common);
  const Grid& grid = loaded.table.grid();
  std::array<double, 3> least;
  least.fill(std::numeric_limits<double>::infinity());
  std::array<double, 3> largest = {0.0, 0.0, 0.0};
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    if (!loaded.table.is_valid(cell)) continue;
    const Rgb f = loaded.table.value(cell);
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], f[c]);
      largest[c] = std::max(largest[c], f[c]);
    }
  }
  const double valid_pct =
      100.0 * static_cast<double>(loaded.table.valid_count()) / static_cast<double>(grid.cell_count());
  const double asymmetry_pct = mirror_asymmetry_pct(loaded.table);
  const std::string sha256 = io::sha256_of_file(a.file);
  if (a.common.json) {
    const io::Json json = {
        {"kind", "merl"},
        {"grid", {{"theta_h", grid.n_theta_h}, {"theta_d", grid.n_theta_d}, {"phi_d", grid.n_phi_d}}},
        {"file_bytes", loaded.report.file_bytes},
        {"cells", grid.cell_count()},
        {"valid_cells", loaded.table.valid_count()},
        {"non_finite_values", loaded.report.non_finite_values},
        {"least", least},
        {"largest", largest},
        {"mirror_asymmetry_pct", asymmetry_pct},
        {"sha256", sha256}};
    fmt::print("{}\n", json.dump(2));
    return kDone;
  }
  fmt::print("MERL-format table, {} x {} x {} cells (theta_h, theta_d, phi_d), {} bytes\n", grid.n_theta_h,
             grid.n_theta_d, grid.n_phi_d, loaded.report.file_bytes);
  fmt::print("measured: {} of {} cells ({:.1f}%); values that are not finite: {}\n",
             loaded.table.valid_count(), grid.cell_count(), valid_pct, loaded.report.non_finite_values);
  fmt::print("f in sr^-1 from {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} (red, green, blue)\n", least[0],
             least[1], least[2], largest[0], largest[1], largest[2]);
  fmt::print(
      "cells at phi_d and 180 - phi_d, which are one in an isotropic material, differ by {:.2f}% (mean "
      "log-ratio); "
      "spheres show it as a seam\n",
      asymmetry_pct);
  for (const std::string& warning : cell_warnings(loaded.table)) fmt::print("{}\n", warning);
  fmt::print("sha256 {}\n", sha256);
  return kDone;
}

int describe_material(const Arguments& a) {
  const Material material = io::read_material(a.file);
  const double albedo = largest_directional_albedo(material);
  if (a.common.json) {
    io::Json json = io::material_to_json(material);
    json["kind"] = "material";
    json["largest_directional_albedo"] = albedo;
    fmt::print("{}\n", json.dump(2));
    return kDone;
  }
  std::string effects;
  for (const Effect effect : all_effects()) {
    if (material.effects().has(effect))
      effects += (effects.empty() ? "" : ", ") + std::string(effect_name(effect));
  }
  fmt::print("{} material; effects: {}\n", title_of(material.model()), effects.empty() ? "none" : effects);
  std::vector<std::vector<std::string>> rows;
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!material.effects().has(info.effect)) continue;
    rows.push_back({std::string(info.name), value_text(material, info), srgb_text(material, info),
                    std::string(name_of(info.tier)), std::string(info.help)});
  }
  fmt::print("{}", format_table({"parameter", "value", "8-bit sRGB", "tier", "meaning"}, rows));
  fmt::print("largest directional albedo: {:.3f}{}\n", albedo,
             albedo > 1.0 ? " (the material gives back more light than it gets)" : "");
  return kDone;
}

StackInfoRequest stack_request(const Arguments& a) {
  StackInfoRequest request = {a.file, {}, a.lights};
  if (!a.transfer.empty()) {
    request.transfer = io::transfer_from(a.transfer);
    if (!request.transfer) {
      throw UsageError(fmt::format("--transfer {}: it is one of {}", a.transfer, io::kTransferNames));
    }
  }
  return request;
}

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  if (is_stack_file(a.file)) return describe_stack(stack_request(a), a.common);
  if (!a.transfer.empty() || !a.lights.empty()) {
    throw UsageError("--transfer and --lights are for stacks (olat.json, .lp)");
  }
  if (std::filesystem::path(a.file).extension() == ".json") return describe_material(a);
  return describe_table(a);
}

}  // namespace

Command add_info_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("info", "what a file holds, and whether it is sound");
  app->footer(
      "Example: brdfit info blue-fabric.binary\n     or: brdfit info lion.lp --transfer linear --lights "
      "lights.png");
  app->add_option("file", a->file, "MERL-format .binary file, a material .json, or a stack: olat.json or .lp")
      ->required();
  app->add_flag("--lenient", a->lenient, "take NaN and infinities as unmeasured, and say how many");
  app->add_option("--transfer", a->transfer,
                  fmt::format("how a stack's pictures encode light: {}; as the files say unless given",
                              io::kTransferNames));
  app->add_option("--lights", a->lights,
                  "writes a picture of a stack's lights on the hemisphere (.svg, .png)");
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
