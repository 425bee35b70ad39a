// brdfit bake: Realis textures from a light stack.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "bake/capture_warnings.h"
#include "cli/asset_files.h"
#include "cli/asset_rows.h"
#include "cli/bake_evidence.h"
#include "cli/bake_key.h"
#include "cli/bake_options.h"
#include "cli/bake_pictures.h"
#include "cli/bake_restart.h"
#include "cli/bake_stack.h"
#include "cli/bake_timings.h"
#include "cli/left_files.h"
#include "cli/progress.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "cli/write_behind.h"
#include "io/image_reader.h"
#include "io/realis_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

// Strips, with all that is made of them, take this share of --memory; libraries and decoders take 100 to 140
// MiB.
constexpr double kStripShare = 0.36;
// JPEG is decoded by so many rows.
constexpr int kRowGroup = 16;
constexpr const char* kStrip = "strip";
// Codes at the ends of their range; where ranges are of the asset itself they are few.
constexpr double kManyCutCodes = 0.05;

// Each strip needs the memory of the one before: given back to the system and asked for again, its pages cost
// more than the work on them.
void keep_freed_pages() {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

// One bake from beginning to end.
class Bake {
 public:
  Bake(const BakeArguments& a, const CLI::App& parser, std::string command_line)
      : Bake(a, parser, std::move(command_line), io::read_stack_source(a.stack)) {}

  int run() {
    if (a_.timings) timings_.measure_decoding(stack_.source());
    const BothClocks after_opening;
    decide();
    if (!a_.no_evidence) weigh();
    if (pictures_) prepare_pictures();
    write();
    timings_.set_total(opening_ + after_opening.taken());
    if (a_.timings) timings_.measure_decoding(stack_.source());
    finish();
    return kDone;
  }

 private:
  Bake(const BakeArguments& a, const CLI::App& parser, std::string command_line,
       const io::StackSource& source)
      : a_(a),
        settings_(bake_settings_of(a)),
        ranges_(given_ranges(a, settings_)),
        command_line_(std::move(command_line)),
        needs_sample_(!a.no_evidence || !a.panels.empty() || ranges_.empty() || !bake::is_decided(settings_)),
        json_file_(std::filesystem::path(a.output) / (name_of(a, source) + ".realis.json")),
        restart_(std::filesystem::path(a.output) / (name_of(a, source) + ".realis.part"),
                 bake_key(parser, a, source), a.fresh),
        reads_sample_(needs_sample_ && !is_past_sample()),
        stack_(a, reads_sample_),
        opening_(since_beginning_.taken()),
        maker_(stack_.info(), plan_, settings_, asset_, !a.no_dither) {
    timings_.add("open", opening_);
    asset_.name = name_of(a, source);
    settings_.check = [this] { stop_if_interrupted(); };
    a_.common.force = a.common.force || restart_.has_outputs_begun();
    prepare_output(json_file_, a_.common.force);
    pictures_.emplace(a_, stack_.info(), settings_, asset_.name);
    if (!pictures_->is_wanted()) pictures_.reset();
    const std::string found =
        restart_.found(stack_.info().height, bake::fold_count(stack_.info().lights.size(), a.folds));
    if (!found.empty()) say(a_.common, found);
  }

  static std::string name_of(const BakeArguments& a, const io::StackSource& source) {
    return a.name.empty() ? source.name : a.name;
  }

  // Whether an interrupted bake has left all that the sample is read for.
  bool is_past_sample() const {
    const bool has_pictures = !a_.panels.empty() || (!a_.no_panels && !a_.no_evidence);
    return restart_.plan() && !has_pictures && (a_.no_evidence || restart_.evidence()) &&
           (!ranges_.empty() || restart_.ranges());
  }

  void stop_if_interrupted() const {
    if (interrupted()) throw std::runtime_error("interrupted; " + restart_.how_to_go_on());
  }

  // What is still being written is kept first.
  void stop_if_interrupted(WriteBehind& behind) const {
    if (!interrupted()) return;
    behind.wait();
    stop_if_interrupted();
  }

  // A phase is done, and kept.
  void reached(const std::string& phase) const {
    if (a_.stop_after == phase) std::raise(SIGINT);
    stop_if_interrupted();
  }

  std::vector<std::uint32_t> sample_texels() const {
    return even_sample(stack_.info(), static_cast<std::size_t>(a_.sample_texels));
  }

  void decide() {
    say(a_.common, fmt::format("{}: {} lights, {} x {} texels", asset_.name, stack_.info().lights.size(),
                               stack_.info().width, stack_.info().height));
    if (!needs_sample_) {
      plan_ = bake::decided_plan(stack_.info(), settings_);
      return;
    }
    if (reads_sample_) {
      sample_ = timings_.timed("decode sample", [&] { return stack_.read_texels(sample_texels()); });
    }
    stop_if_interrupted();
    if (restart_.plan()) {
      plan_ = *restart_.plan();
      return;
    }
    plan_ = timings_.timed("plan", [&] {
      return bake::plan_bake(stack_.info(), sample_, bake::all_lights(stack_.info()),
                             a_.no_evidence ? settings_ : bake::with_compared_lobes(settings_, {}));
    });
    warn_of_capture();
    restart_.keep_plan(plan_);
    reached("plan");
  }

  // What is wrong with the capture comes first: it may explain the rest.
  void warn_of_capture() {
    std::vector<bake::SolveWarning> found = bake::capture_warnings(stack_.info(), sample_, settings_.gains);
    plan_.warnings.insert(plan_.warnings.begin(), found.begin(), found.end());
  }

  void weigh() {
    const int folds = bake::fold_count(stack_.info().lights.size(), a_.folds);
    if (restart_.evidence() && take_over_folds(folds)) {
      evidence_ = *restart_.evidence();
      return;
    }
    bake::EvidenceOptions options;
    options.folds = a_.folds;
    options.dither = !a_.no_dither;
    options.check = settings_.check;
    options.fold_of = [&](int fold, const std::function<bake::FoldEvidence()>& make) {
      const bool is_kept = restart_.has_fold(fold);
      bake::FoldEvidence evidence = restart_.fold_of(fold, make);
      if (!is_kept) reached("fold");
      return evidence;
    };
    Progress progress(static_cast<std::size_t>(folds), a_.common.quiet || a_.common.json);
    options.progress = [&](double) {
      progress.step("held-out lights");
      stop_if_interrupted();
    };
    if (pictures_) {
      options.on_fold = [&](int fold, bake::FoldPlans plans) { pictures_->keep(fold, std::move(plans)); };
    }
    evidence_ = timings_.timed(
        "evidence", [&] { return bake::evaluate(stack_.info(), sample_, plan_, settings_, options); });
    restart_.keep_evidence(evidence_);
    reached("evidence");
  }

  // Plans of folds as the pictures need them; false where one is missing.
  bool take_over_folds(int folds) {
    for (int fold = 0; pictures_ && fold < folds; ++fold) {
      std::optional<bake::FoldEvidence> kept = restart_.fold(fold);
      if (!kept) return false;
      pictures_->keep(fold, bake::fold_plans(std::move(kept->plan)));
    }
    return true;
  }

  void prepare_pictures() {
    timings_.timed("pictures", [&] { pictures_->prepare(sample_, a_.no_evidence ? nullptr : &evidence_); });
  }

  void describe_asset() {
    const StackInfo& info = stack_.info();
    asset_.width = info.width;
    asset_.height = info.height;
    asset_.colour = settings_.colour;
    asset_.albedo_in_modulation = settings_.albedo_in_modulation;
    asset_.base = plan_.base.material;
    asset_.view = info.view;
    asset_.fade = {a_.fade_albedo, a_.fade_normal_deg};
    if (plan_.system) {
      asset_.lobes = plan_.system->lobes();
      asset_.penalty = plan_.system->penalty();
    }
    asset_.packing.bits = a_.bits;
    asset_.packing.dominant = dominant_of(a_, static_cast<int>(asset_.lobes.size()));
    asset_.packing.ranges = ranges_of_codes();
    if (ranges_.empty() && !restart_.ranges()) restart_.keep_ranges(asset_.packing.ranges);
    name_asset_files(asset_);
  }

  // That came with the lobes, were kept, or are found.
  std::vector<RealisRange> ranges_of_codes() const {
    if (plan_.system && !ranges_.empty()) return ranges_;
    if (plan_.system && restart_.ranges()) return *restart_.ranges();
    return maker_.ranges(sample_);
  }

  // Rows of a strip that fit into memory with what is made of them.
  int strip_rows(bool luminance) const {
    const StackInfo& info = stack_.info();
    const double bytes = kStripShare * static_cast<double>(static_cast<std::size_t>(a_.memory_mib) << 20) -
                         static_cast<double>(memory_beside_strips(a_));
    const int rows = static_cast<int>(bytes / static_cast<double>(maker_.texel_bytes(luminance)) /
                                      static_cast<double>(info.width));
    return std::clamp(rows > kRowGroup ? rows / kRowGroup * kRowGroup : rows, 1, info.height);
  }

  void write() {
    describe_asset();
    for (const std::filesystem::path& file : asset_paths(asset_, a_.output))
      prepare_output(file, a_.common.force);
    AssetWriter writer(asset_, a_.output, a_.half ? io::ExrDepth::kHalf : io::ExrDepth::kFloat, a_.zip);
    WriteBehind behind;
    const bool luminance = !pictures_ && maker_.needs_luminance_alone();
    const int strip = strip_rows(luminance);
    const std::vector<Strip> strips = strips_of(strip);
    Progress progress(strips.size(), a_.common.quiet || a_.common.json);
    for (const Strip& next : strips) {
      stop_if_interrupted(behind);
      if (next.is_kept) {
        timings_.timed("write", [&] { behind.wait(); });
        take_over(next, strip, writer);
      } else {
        make(next, luminance, writer, behind);
        if (a_.stop_after == kStrip) std::raise(SIGINT);
        stop_if_interrupted(behind);
      }
      progress.step("rows");
    }
    timings_.timed("write", [&] {
      behind.wait();
      restart_.keep_outputs_begun();
      writer.commit();
    });
    reached("textures");
    cut_values_ = writer.cut_values();
    warn_of_cut_codes();
    if (pictures_) {
      timings_.timed("pictures",
                     [&] { pictures_->finish(stack_, strip, [this] { stop_if_interrupted(); }); });
    }
  }

  struct Strip {
    int first = 0;
    int rows = 0;
    bool is_kept = false;  // by a bake that was interrupted
  };

  // From top to bottom: those that are kept, and between them as many rows as fit.
  std::vector<Strip> strips_of(int most_rows) const {
    std::vector<Strip> strips;
    const int height = stack_.info().height;
    for (int row = 0; row < height; row += strips.back().rows) {
      const int kept = restart_.rows_at(row);
      const int room = std::min(most_rows, restart_.next_kept(row, height) - row);
      strips.push_back({row, kept > 0 ? kept : room, kept > 0});
    }
    return strips;
  }

  // What is made of a strip is written and kept while the next is read.
  void make(const Strip& strip, bool luminance, AssetWriter& writer, WriteBehind& behind) {
    const io::PixelCounts before = stack_.counts();
    TexelBlock block = timings_.timed("decode", [&] {
      return luminance ? stack_.read_luminance(strip.first, strip.rows)
                       : stack_.read_rows(strip.first, strip.rows);
    });
    const auto made = std::make_shared<KeptStrip>();
    AssetRowsMaker::Made rows = timings_.timed("solve", [&] { return maker_.rows_of(block); });
    made->rows = std::move(rows.rows);
    made->cut_codes = rows.cut_codes;
    cut_codes_ += rows.cut_codes;
    if (pictures_) timings_.timed("pictures", [&] { pictures_->add(block); });
    stack_.give_back(std::move(block));
    made->pixels = stack_.counts() - before;
    CpuMeter& writing = timings_.beside("write");
    CpuMeter& keeping = timings_.beside("keep");
    timings_.timed("write", [&] {
      behind.begin([this, &writer, &writing, &keeping, strip, made] {
        writer.write(made->rows, strip.rows, writing);
        keeping.measure([&] { restart_.keep_strip(strip.first, strip.rows, *made); });
      });
    });
  }

  // Pictures are drawn anew, for which the stack is read all the same.
  void take_over(const Strip& strip, int most_rows, AssetWriter& writer) {
    const int end = strip.first + strip.rows;
    for (int row = strip.first; pictures_ && row < end; row += most_rows) {
      TexelBlock block =
          timings_.timed("decode", [&] { return stack_.read_rows(row, std::min(most_rows, end - row)); });
      timings_.timed("pictures", [&] { pictures_->add(block); });
      stack_.give_back(std::move(block));
    }
    timings_.timed("write", [&] {
      const KeptStrip kept = restart_.strip(strip.first);
      writer.write(kept.rows, strip.rows, timings_.beside("write"));
      cut_codes_ += kept.cut_codes;
      if (!pictures_) pixels_taken_over_ += kept.pixels;
    });
  }

  // Ranges of another asset may be too small for this one.
  void warn_of_cut_codes() {
    const double share =
        static_cast<double>(cut_codes_) /
        static_cast<double>(std::max<std::size_t>(asset_.plane_count(), 1) * asset_.texel_count());
    if (ranges_.empty() || share < kManyCutCodes) return;
    plan_.warnings.push_back(
        {"ranges-too-small",
         fmt::format("{:.1f}% of the codes are at the end of the range that came with the lobe "
                     "set: --lobes-only finds ranges for this stack",
                     100.0 * share)});
  }

  void finish() {
    io::Json bake;
    bake["version"] = kVersion;
    bake["command"] = command_line_;
    bake["input"] = {{"file", std::filesystem::path(a_.stack).filename().string()},
                     {"sha256", io::sha256_of_file(a_.stack)}};
    bake["seed"] = a_.seed;
    if (needs_sample_) bake["sample_texels"] = sample_texels().size();
    bake["plan"] = plan_json(plan_, stack_.info());
    const io::PixelCounts counts = stack_.counts() + pixels_taken_over_;
    bake["pixels"] = {{"saturated", counts.saturated}, {"non_finite", counts.non_finite}};
    if (io::Json weights = stack_.weights_json(); !weights.is_null()) bake["weights"] = std::move(weights);
    if (cut_values_ > 0) bake["values_cut_to_half"] = cut_values_;
    if (!a_.no_evidence) {
      bake["folds"] = evidence_.folds;
      bake["evidence"] = evidence_json(evidence_);
    }
    if (pictures_) bake["pictures"] = pictures_->json();
    bake["timings_seconds"] = timings_.seconds_json();
    if (a_.timings) bake["timings"] = timings_.units_json();
    const std::vector<std::filesystem::path> before = files_named_by(json_file_);
    io::write_realis(json_file_, asset_, bake);
    remove_left_files(json_file_, before);
    restart_.remove();
    if (a_.common.json) {
      bake["file"] = json_file_.string();
      bake["lobes"] = asset_.lobes.size();
      bake["bytes_per_texel"] = asset_.bytes_per_texel();
      fmt::print("{}\n", bake.dump(2));
    } else if (!a_.common.quiet) {
      fmt::print("{}{}{}", stack_.weights_text(), plan_text(plan_, stack_.info()),
                 a_.no_evidence ? "" : evidence_text(evidence_, stack_.info()));
      if (a_.timings) fmt::print("{}", timings_.text());
      fmt::print("{}: {:.1f} bytes per texel at run time\n", json_file_.string(), asset_.bytes_per_texel());
    }
  }

  BothClocks since_beginning_;
  BakeArguments a_;
  bake::BakeSettings settings_;
  std::vector<RealisRange> ranges_;  // that came with the lobes
  std::string command_line_;
  bool needs_sample_;
  std::filesystem::path json_file_;
  BakeRestart restart_;
  bool reads_sample_;
  BakeStack stack_;
  TimeTaken opening_;
  RealisAsset asset_;
  TexelBlock sample_;
  bake::BakePlan plan_;
  AssetRowsMaker maker_;
  bake::Evidence evidence_;
  std::optional<BakePictures> pictures_;
  std::size_t cut_values_ = 0;
  std::size_t cut_codes_ = 0;
  io::PixelCounts pixels_taken_over_;
  BakeTimings timings_;
};

}  // namespace

Command add_bake_command(CLI::App& program) {
  auto a = std::make_shared<BakeArguments>();
  CLI::App* app = program.add_subcommand("bake", "Realis textures from a light stack");
  app->footer(
      "Example: brdfit bake lion/dirs.lp --transfer linear --lobes 8 -o baked\n"
      "writes baked/dirs.realis.json and its textures, and prints what the correction is worth under lights "
      "that it\n"
      "has not seen.");
  add_bake_options(*app, *a);
  return {app, [a, app](const std::string& command_line) {
            const ThreadLimit threads(a->common.threads);
            keep_freed_pages();
            io::load_image_module();
            return Bake(*a, *app, command_line).run();
          }};
}

}  // namespace brdfit::cli
