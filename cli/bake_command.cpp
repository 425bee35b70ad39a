// brdfit bake: Realis textures from a light stack.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "bake/capture_warnings.h"
#include "bake/compress_block.h"
#include "cli/asset_files.h"
#include "cli/bake_evidence.h"
#include "cli/bake_options.h"
#include "cli/bake_pictures.h"
#include "cli/bake_stack.h"
#include "cli/progress.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "io/realis_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

// Texels spread evenly over the picture: all of them where there are few.
std::vector<std::uint32_t> sample_of(const StackInfo& info, std::size_t count) {
  const std::size_t texels = info.texel_count();
  std::vector<std::uint32_t> sample(std::min(texels, count));
  for (std::size_t k = 0; k < sample.size(); ++k) {
    sample[k] = static_cast<std::uint32_t>((2 * k + 1) * texels / (2 * sample.size()));
  }
  return sample;
}

// One bake from beginning to end.
class Bake {
 public:
  Bake(const BakeArguments& a, std::string command_line)
      : a_(a), settings_(bake_settings_of(a)), command_line_(std::move(command_line)), stack_(a) {
    asset_.name = a.name.empty() ? stack_.info().name : a.name;
    json_file_ = std::filesystem::path(a.output) / (asset_.name + ".realis.json");
    prepare_output(json_file_, a.common.force);
    pictures_.emplace(a, stack_.info(), settings_, asset_.name);
    if (!pictures_->is_wanted()) pictures_.reset();
  }

  int run() {
    decide();
    if (!a_.no_evidence) weigh();
    if (pictures_) prepare_pictures();
    write();
    finish();
    return kDone;
  }

 private:
  void decide() {
    say(a_.common, fmt::format("{}: {} lights, {} x {} texels", asset_.name, stack_.info().lights.size(),
                               stack_.info().width, stack_.info().height));
    Stopwatch reading;
    sample_ = stack_.read_texels(sample_of(stack_.info(), static_cast<std::size_t>(a_.sample_texels)));
    seconds_["decode_sample"] = reading.seconds();
    plan_ = bake::plan_bake(stack_.info(), sample_, bake::all_lights(stack_.info()), settings_);
    warn_of_capture();
    seconds_["plan_base"] = plan_.timings.base_seconds;
    seconds_["plan_lobes"] = plan_.timings.lobes_seconds;
  }

  // What is wrong with the capture comes first: it may explain the rest.
  void warn_of_capture() {
    std::vector<bake::SolveWarning> found = bake::capture_warnings(stack_.info(), sample_, settings_.gains);
    plan_.warnings.insert(plan_.warnings.begin(), found.begin(), found.end());
  }

  void weigh() {
    Stopwatch watch;
    bake::EvidenceOptions options;
    options.folds = a_.folds;
    options.dither = !a_.no_dither;
    const int folds = bake::fold_count(stack_.info().lights.size(), a_.folds);
    Progress progress(static_cast<std::size_t>(folds), a_.common.quiet || a_.common.json);
    options.progress = [&](double) {
      progress.step("held-out lights");
      if (interrupted()) throw std::runtime_error("interrupted; nothing is written");
    };
    if (pictures_) {
      options.on_fold = [&](int fold, bake::FoldPlans plans) { pictures_->keep(fold, std::move(plans)); };
    }
    evidence_ = bake::evaluate(stack_.info(), sample_, plan_, settings_, options);
    seconds_["evidence"] = watch.seconds();
  }

  void prepare_pictures() {
    Stopwatch watch;
    pictures_->prepare(sample_, a_.no_evidence ? nullptr : &evidence_);
    seconds_["pictures"] = watch.seconds();
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
    if (plan_.system) asset_.lobes = plan_.system->lobes();
    asset_.packing.bits = a_.bits;
    asset_.packing.dominant = dominant_of(a_, static_cast<int>(asset_.lobes.size()));
    asset_.packing.ranges = ranges();
    name_asset_files(asset_);
  }

  // Planes of all problems of a block, [lobe][channel][texel].
  static std::vector<float> planes_of(const std::vector<std::vector<float>>& channels, std::size_t lobes,
                                      std::size_t count) {
    std::vector<float> planes;
    planes.reserve(channels.size() * lobes * count);
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      for (const std::vector<float>& channel : channels) {
        const auto from = channel.begin() + static_cast<std::ptrdiff_t>(lobe * count);
        planes.insert(planes.end(), from, from + static_cast<std::ptrdiff_t>(count));
      }
    }
    return planes;
  }

  bake::CompressOptions compress_options() const { return {a_.bits, asset_.packing.dominant, !a_.no_dither}; }

  // Of planes, [lobe][channel].
  std::vector<RealisRange> ranges() const {
    std::vector<RealisRange> planes(asset_.plane_count());
    if (!plan_.system) return planes;
    const bake::BakedBlock baked = bake::bake_block(stack_.info(), sample_, plan_, settings_);
    const std::size_t channels = baked.solved.size();
    for (std::size_t c = 0; c < channels; ++c) {
      const std::vector<RealisRange> lobes =
          bake::code_ranges(*plan_.system, baked.problems[c], baked.solved[c].amplitudes, compress_options());
      for (std::size_t k = 0; k < lobes.size(); ++k) planes[k * channels + c] = lobes[k];
    }
    return planes;
  }

  AssetRows rows_of(const TexelBlock& block) const {
    bake::BakedBlock baked = bake::bake_block(stack_.info(), block, plan_, settings_);
    AssetRows rows;
    rows.confidence.assign(block.count(), 0.0F);
    if (plan_.system) compress(baked, block, rows);
    rows.chroma = std::move(baked.chroma);
    rows.surface = std::move(baked.surface);
    return rows;
  }

  void compress(const bake::BakedBlock& baked, const TexelBlock& block, AssetRows& rows) const {
    const std::size_t lobes = asset_.lobes.size();
    const std::size_t channels = baked.solved.size();
    std::vector<std::vector<float>> amplitudes;
    rows.codes.assign(asset_.plane_count() * block.count(), 0);
    rows.masks.assign(block.count(), 0);
    for (std::size_t c = 0; c < channels; ++c) {
      const bake::SolveResult& solved = baked.solved[c];
      std::vector<RealisRange> ranges;
      for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
        ranges.push_back(asset_.packing.ranges[lobe * channels + c]);
      }
      const bake::Compressed small =
          bake::compress_block(*plan_.system, baked.problems[c], solved.amplitudes, block.texels,
                               asset_.width, ranges, compress_options());
      for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
        std::copy_n(small.codes.begin() + static_cast<std::ptrdiff_t>(lobe * block.count()), block.count(),
                    rows.codes.begin() + static_cast<std::ptrdiff_t>((lobe * channels + c) * block.count()));
      }
      for (std::size_t k = 0; k < block.count(); ++k) {
        rows.masks[k] |= small.masks[k];
        rows.confidence[k] = std::max(rows.confidence[k], solved.confidence[k]);
      }
      amplitudes.push_back(solved.amplitudes);
    }
    rows.amplitudes = planes_of(amplitudes, lobes, block.count());
  }

  void write() {
    describe_asset();
    for (const std::filesystem::path& file : asset_paths(asset_, a_.output))
      prepare_output(file, a_.common.force);
    AssetWriter writer(asset_, a_.output, a_.half ? io::ExrDepth::kHalf : io::ExrDepth::kFloat);
    const int strip = std::max(1, stack_.strip_rows());
    const int height = stack_.info().height;
    Progress progress(static_cast<std::size_t>((height + strip - 1) / strip),
                      a_.common.quiet || a_.common.json);
    double decoding = 0.0;
    double solving = 0.0;
    double drawing = 0.0;
    Stopwatch all;
    for (int row = 0; row < height; row += strip) {
      if (interrupted()) throw std::runtime_error("interrupted; nothing is written");
      const int rows = std::min(strip, height - row);
      Stopwatch watch;
      TexelBlock block = stack_.read_rows(row, rows);
      decoding += watch.seconds();
      watch = Stopwatch();
      const AssetRows out = rows_of(block);
      solving += watch.seconds();
      watch = Stopwatch();
      if (pictures_) pictures_->add(block);
      drawing += watch.seconds();
      stack_.give_back(std::move(block));
      writer.write(out, rows);
      progress.step("rows");
    }
    writer.commit();
    cut_values_ = writer.cut_values();
    seconds_["decode"] = decoding;
    seconds_["solve"] = solving;
    seconds_["write"] = all.seconds() - decoding - solving - drawing;
    if (!pictures_) return;
    Stopwatch watch;
    pictures_->finish(stack_, strip, stop_if_interrupted);
    seconds_["pictures"] += drawing + watch.seconds();
  }

  static void stop_if_interrupted() {
    if (interrupted()) throw std::runtime_error("interrupted; textures are written, not all pictures are");
  }

  void finish() {
    io::Json bake;
    bake["version"] = kVersion;
    bake["command"] = command_line_;
    bake["input"] = {{"file", std::filesystem::path(a_.stack).filename().string()},
                     {"sha256", io::sha256_of_file(a_.stack)}};
    bake["seed"] = a_.seed;
    bake["sample_texels"] = sample_.count();
    bake["plan"] = plan_json(plan_, stack_.info());
    const io::PixelCounts& counts = stack_.counts();
    bake["pixels"] = {{"saturated", counts.saturated}, {"non_finite", counts.non_finite}};
    if (io::Json weights = stack_.weights_json(); !weights.is_null()) bake["weights"] = std::move(weights);
    if (cut_values_ > 0) bake["values_cut_to_half"] = cut_values_;
    if (!a_.no_evidence) {
      bake["folds"] = evidence_.folds;
      bake["evidence"] = evidence_json(evidence_);
    }
    if (pictures_) bake["pictures"] = pictures_->json();
    bake["timings_seconds"] = seconds_;
    io::write_realis(json_file_, asset_, bake);
    if (a_.common.json) {
      bake["file"] = json_file_.string();
      bake["lobes"] = asset_.lobes.size();
      bake["bytes_per_texel"] = asset_.bytes_per_texel();
      fmt::print("{}\n", bake.dump(2));
    } else if (!a_.common.quiet) {
      fmt::print("{}{}{}", stack_.weights_text(), plan_text(plan_, stack_.info()),
                 a_.no_evidence ? "" : evidence_text(evidence_, stack_.info()));
      fmt::print("{}: {:.1f} bytes per texel at run time\n", json_file_.string(), asset_.bytes_per_texel());
    }
  }

  const BakeArguments& a_;
  bake::BakeSettings settings_;
  std::string command_line_;
  BakeStack stack_;
  RealisAsset asset_;
  std::filesystem::path json_file_;
  TexelBlock sample_;
  bake::BakePlan plan_;
  bake::Evidence evidence_;
  std::optional<BakePictures> pictures_;
  std::size_t cut_values_ = 0;
  std::map<std::string, double> seconds_;
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
  return {app, [a](const std::string& command_line) {
            const ThreadLimit threads(a->common.threads);
            return Bake(*a, command_line).run();
          }};
}

}  // namespace brdfit::cli
