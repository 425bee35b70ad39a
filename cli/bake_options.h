// What `brdfit bake` is asked for.
#ifndef BRDFIT_CLI_BAKE_OPTIONS_H_
#define BRDFIT_CLI_BAKE_OPTIONS_H_

#include <string>
#include <vector>

#include "bake/evidence.h"
#include "bake/plan.h"
#include "cli/common.h"
#include "io/exr_rows.h"

namespace brdfit::cli {

struct BakeArguments {
  CommonOptions common;
  std::string stack;
  std::string output = ".";
  std::string name;
  std::string transfer;
  std::string lobes = "8";
  std::string lobe_set;
  bool lobes_only = false;
  bool uniform = false;
  std::string colour = "luminance";
  std::string base = "auto";
  std::string model = "callisto";
  double ridge_factor = 1.0;
  int shrink = 1;
  bool gains = false;
  bool albedo_in_modulation = false;
  int bits = 8;
  std::string dominant = "all";
  bool no_dither = false;
  bool half = false;
  bool no_evidence = false;
  int folds = 0;
  std::vector<std::string> panels;  // empty: worst, median and best, where there is evidence
  bool no_panels = false;
  int sample_texels = 4096;
  int memory_mib = 256;
  std::string spill = "auto";
  std::vector<double> noise;  // read deviation and shot; empty: what the stack says
  bool contours = false;
  bool zip = false;
  bool timings = false;
  bool fresh = false;
  std::string stop_after;  // a phase; empty: none
  double fade_albedo = RealisFade{}.albedo_range;
  double fade_normal_deg = RealisFade{}.normal_range_deg;
  std::uint64_t seed = 1;
};

void add_bake_options(CLI::App& app, BakeArguments& a);

// Throw UsageError, or IoError for a lobe set that cannot be read.
bake::BakeSettings bake_settings_of(const BakeArguments& a);

// The ranges of codes that come with a lobe set, where they fit: [lobe] or [lobe][channel]; empty otherwise.
std::vector<RealisRange> given_ranges(const BakeArguments& a, const bake::BakeSettings& settings);
int dominant_of(const BakeArguments& a, int lobes);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_OPTIONS_H_
