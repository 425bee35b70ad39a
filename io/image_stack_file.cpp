// Strips of many pictures at once: every picture is read and converted by one thread, a few rows at a time,
// so that what is decoded is still in the cache when it is converted.
#include "io/image_stack_file.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/error.h"
#include "io/picture_maps.h"
#include "io/pixel_converter.h"
#include "io/row_source.h"
#include "io/spill_file.h"
#include "io/stack_frames.h"

namespace brdfit::io {
namespace {

using Side = IoError::Side;

constexpr int kRowsAtOnce = 16;  // those of a JPEG's blocks

// All pictures stay open; beside them the program has few files.
void allow_files(std::size_t pictures, const std::string& name) {
  const auto wanted = static_cast<rlim_t>(pictures + 64);
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  if (setrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur >= wanted) return;
  throw IoError(
      Side::kInput, name,
      fmt::format("{} pictures and maps, and the system allows {} open files", pictures, limit.rlim_max),
      "as many as there are of them, and 64", "raise the limit (ulimit -n)");
}

// A picture with its conversion.
struct Picture {
  RowSource rows;
  std::optional<PixelConverter> converter;
};

struct ChosenTransfer {
  Transfer transfer;
  std::string origin;
};

ChosenTransfer transfer_of(const RowSource& rows, const std::optional<Transfer>& asked,
                           const std::optional<Transfer>& manifest) {
  if (asked) return {*asked, "asked for"};
  if (manifest) return {*manifest, "the manifest"};
  if (const auto own = transfer_in_file(rows.name(), rows.header())) return {*own, "the pictures"};
  const SampleType type = rows.header().type;
  return {usual_transfer(type), "the usual for " + name_of(type)};
}

}  // namespace

class FileStack::Impl {
 public:
  Impl(StackSource source, FileStackOptions options)
      : source_(std::move(source)), options_(std::move(options)) {
    allow_files(source_.pictures.size() + source_.count_of(&StackPicture::weight) +
                    source_.count_of(&StackPicture::shadow),
                source_.file.string());
    open_pictures();
    describe();
    frames_.emplace(source_, options_.transfer ? options_.transfer : source_.transfer, info_.width,
                    info_.height);
    weights_.emplace(source_.maps_of(&StackPicture::weight),
                     FrameSize{info_.width, info_.height, source_.pictures.front().file.filename().string()});
    info_.has_normals = frames_->has_normals();
    info_.has_albedo = frames_->has_albedo();
    choose_transfers();
    prepare_spill();
    counted_.assign(static_cast<std::size_t>(info_.height), false);
  }

  TexelBlock read_strip(int first, int rows, PixelConverter::Output output) {
    if (first < 0 || rows < 0 || rows > info_.height - first) {
      throw std::invalid_argument("FileStack: rows outside the picture");
    }
    const auto width = static_cast<std::size_t>(info_.width);
    TexelBlock block = empty_block(static_cast<std::size_t>(rows) * width, output);
    std::iota(block.texels.begin(), block.texels.end(),
              static_cast<std::uint32_t>(static_cast<std::size_t>(first) * width));
    const PixelChoice choice = {first, rows, {}};
    FrameValues frames = frames_->read_correction(choice);
    std::vector<Unusable> unusable;
    tbb::parallel_invoke([&] { frames_->read_surface(frames, choice); },
                         [&] { unusable = read_pictures(block, frames, output, first, rows); });
    finish(block, frames, unusable);
    weights_->weigh(block, choice);
    if (rows > 0) count(first, rows, frames, unusable);
    return block;
  }

  TexelBlock read_texels(std::span<const std::uint32_t> texels) {
    const bool is_ascending =
        std::adjacent_find(texels.begin(), texels.end(), std::greater_equal<>()) == texels.end();
    if (!is_ascending || (!texels.empty() && texels.back() >= info_.texel_count())) {
      throw std::invalid_argument("FileStack: texels must ascend and lie in the picture");
    }
    const auto output = PixelConverter::Output::kRgb;
    TexelBlock block = empty_block(texels.size(), output);
    block.texels.assign(texels.begin(), texels.end());
    if (texels.empty()) return block;
    const PixelChoice choice = {0, 0, texels};
    FrameValues frames = frames_->read(choice);
    std::vector<Unusable> unusable(pictures_.size());
    tbb::parallel_for(std::size_t{0}, pictures_.size(), [&](std::size_t light) {
      Picture& picture = pictures_[light];
      const std::vector<std::byte> samples = samples_of(picture.rows, choice);
      picture.converter->convert(samples, texels.size(), {frames.dark, frames.gain}, output,
                                 block.plane(light, 0).data(), texels.size(), 0, unusable[light]);
    });
    finish(block, frames, unusable);
    weights_->weigh(block, choice);
    return block;
  }

  int strip_rows() const {
    constexpr std::size_t kFramePlanes = 3 * 4;
    const std::size_t values = info_.lights.size() * 4 + kFramePlanes;
    const std::size_t row_bytes = values * sizeof(float) * static_cast<std::size_t>(info_.width);
    const std::size_t rows = std::max<std::size_t>(1, options_.memory_bytes / row_bytes);
    return static_cast<int>(std::min(rows, static_cast<std::size_t>(info_.height)));
  }

  void give_back(TexelBlock block) { given_back_ = std::move(block); }

  const StackInfo& info() const { return info_; }
  const StackSource& source() const { return source_; }
  const StackEncoding& encoding() const { return encoding_; }
  const PixelCounts& counts() const { return counts_; }

 private:
  void open_pictures() {
    std::vector<std::optional<RowSource>> opened(source_.pictures.size());
    tbb::parallel_for(std::size_t{0}, opened.size(),
                      [&](std::size_t k) { opened[k].emplace(source_.pictures[k].file); });
    const std::string as_what = source_.pictures.front().file.filename().string();
    const ImageHeader& first = opened.front()->header();
    for (auto& rows : opened) {
      require_size(*rows, first.width, first.height, as_what);
      pictures_.push_back({std::move(*rows), {}});
    }
  }

  void describe() {
    const ImageHeader& header = pictures_.front().rows.header();
    info_.name = source_.name;
    info_.width = header.width;
    info_.height = header.height;
    info_.view = source_.view;
    info_.plane = source_.plane;
    const std::uint64_t texels =
        std::uint64_t{static_cast<std::uint32_t>(header.width)} * static_cast<std::uint32_t>(header.height);
    if (texels > std::numeric_limits<std::uint32_t>::max()) {
      throw IoError(Side::kInput, source_.file.string(), fmt::format("the pictures have {} pixels", texels),
                    "fewer than 2^32");
    }
    for (const StackPicture& picture : source_.pictures) info_.lights.push_back(picture.light);
    for (StackLight& light : info_.lights) {
      if (light.position) light.direction = seen_from_centre(*light.position);
    }
  }

  Vec3 seen_from_centre(const Vec3& position) const {
    const ImagePlane& plane = info_.plane;
    const Vec3 towards = {position.x - plane.origin.x - 0.5 * (info_.width - 1) * plane.pixel_size,
                          position.y - plane.origin.y + 0.5 * (info_.height - 1) * plane.pixel_size,
                          position.z - plane.origin.z};
    const double length = std::hypot(towards.x, towards.y, towards.z);
    return {towards.x / length, towards.y / length, towards.z / length};
  }

  // Pictures share a table of codes as far as they share an encoding.
  void choose_transfers() {
    std::map<std::pair<SampleType, std::string>, std::shared_ptr<const CodeTable>> tables;
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      const ImageHeader& header = pictures_[k].rows.header();
      const ChosenTransfer chosen = transfer_of(pictures_[k].rows, options_.transfer, source_.transfer);
      if (k == 0) {
        encoding_ = {header.type, false, header.format, header.channels, chosen.transfer, chosen.origin};
      }
      encoding_.is_mixed =
          encoding_.is_mixed || header.type != encoding_.depth || !(chosen.transfer == encoding_.transfer);
      auto& table = tables[{header.type, name_of(chosen.transfer)}];
      if (!table) table = std::make_shared<const CodeTable>(header.type, chosen.transfer);
      const double scale = 1.0 / source_.pictures[k].exposure_seconds.value_or(1.0);
      pictures_[k].converter.emplace(table, header.channels, scale, source_.color_matrix);
    }
  }

  void prepare_spill() {
    for (Picture& picture : pictures_) {
      if (options_.spill || picture.rows.needs_whole_image()) picture.rows.use_spill(spill());
    }
    weights_->use_spill(options_.spill, [this]() -> SpillFile& { return spill(); });
  }

  SpillFile& spill() {
    if (!spill_) {
      spill_ = std::make_unique<SpillFile>(
          options_.spill_folder.empty() ? std::filesystem::temp_directory_path() : options_.spill_folder);
    }
    return *spill_;
  }

  TexelBlock empty_block(std::size_t texels, PixelConverter::Output output) {
    TexelBlock block = std::move(given_back_);
    given_back_ = {};
    block.weight.clear();
    block.texels.resize(texels);
    block.lights = pictures_.size();
    block.channels = output == PixelConverter::Output::kLuminance ? 1 : 3;
    block.rgb.resize(block.lights * block.channels * texels);
    return block;
  }

  std::vector<Unusable> read_pictures(TexelBlock& block, const FrameValues& frames,
                                      PixelConverter::Output output, int first, int rows) {
    std::vector<Unusable> unusable(pictures_.size());
    const auto width = static_cast<std::size_t>(info_.width);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pictures_.size(), 1), [&](const auto& range) {
      std::vector<std::byte> samples;
      for (std::size_t light = range.begin(); light < range.end(); ++light) {
        Picture& picture = pictures_[light];
        for (int done = 0; done < rows; done += kRowsAtOnce) {
          const int some = std::min(kRowsAtOnce, rows - done);
          const std::size_t begin = static_cast<std::size_t>(done) * width;
          const std::size_t count = static_cast<std::size_t>(some) * width;
          samples.resize(static_cast<std::size_t>(some) * picture.rows.header().row_bytes());
          picture.rows.read(first + done, some, samples);
          const ChunkOfFrames chunk(frames, block.count(), begin, count);
          picture.converter->convert(samples, count, chunk.planes, output,
                                     block.plane(light, 0).data() + begin, block.count(),
                                     static_cast<std::uint32_t>(begin), unusable[light]);
        }
      }
    });
    return unusable;
  }

  // Dark and gain planes of some pixels of a strip.
  struct ChunkOfFrames {
    ChunkOfFrames(const FrameValues& frames, std::size_t stride, std::size_t begin, std::size_t count) {
      dark = cut(frames.dark, stride, begin, count);
      gain = cut(frames.gain, stride, begin, count);
      planes = {dark, gain};
    }
    static std::vector<float> cut(const std::vector<float>& values, std::size_t stride, std::size_t begin,
                                  std::size_t count) {
      std::vector<float> out;
      if (values.empty()) return out;
      out.resize(3 * count);
      for (std::size_t c = 0; c < 3; ++c) {
        std::copy_n(values.data() + c * stride + begin, count, out.data() + c * count);
      }
      return out;
    }
    std::vector<float> dark, gain;
    CorrectionPlanes planes;
  };

  // Weights, where any value cannot be used, and what the frames say.
  static void finish(TexelBlock& block, FrameValues& frames, const std::vector<Unusable>& unusable) {
    const bool is_blocked =
        std::any_of(frames.blocked.begin(), frames.blocked.end(), [](auto b) { return b != 0; });
    const bool is_any = is_blocked || std::any_of(unusable.begin(), unusable.end(),
                                                  [](const Unusable& u) { return !u.pixels.empty(); });
    if (is_any) block.weight.assign(block.lights * block.count(), 1.0F);
    for (std::size_t light = 0; light < block.lights && is_any; ++light) {
      float* weight = block.weight.data() + light * block.count();
      for (const std::uint32_t pixel : unusable[light].pixels) weight[pixel] = 0.0F;
      for (std::size_t k = 0; k < frames.blocked.size(); ++k) {
        if (frames.blocked[k] != 0) weight[k] = 0.0F;
      }
    }
    block.normals = std::move(frames.normals);
    block.albedo = std::move(frames.albedo);
  }

  // Rows that were read before do not count again; strips that overlap them in part count as a whole, or not.
  void count(int first, int rows, const FrameValues& frames, const std::vector<Unusable>& unusable) {
    const auto begin = counted_.begin() + first;
    if (std::any_of(begin, begin + rows, [](bool is_counted) { return is_counted; })) return;
    std::fill(begin, begin + rows, true);
    counts_.pixels +=
        pictures_.size() * static_cast<std::size_t>(rows) * static_cast<std::size_t>(info_.width);
    counts_.masked_texels += frames.masked_texels;
    counts_.bad_texels += frames.bad_texels;
    for (const Unusable& one : unusable) {
      counts_.saturated += one.saturated;
      counts_.non_finite += one.non_finite;
    }
  }

  StackSource source_;
  FileStackOptions options_;
  StackInfo info_;
  StackEncoding encoding_;
  PixelCounts counts_;
  std::vector<bool> counted_;
  TexelBlock given_back_;
  std::unique_ptr<SpillFile> spill_;
  std::vector<Picture> pictures_;
  std::optional<StackFrames> frames_;
  std::optional<PictureMaps> weights_;
};

FileStack::FileStack(StackSource source, FileStackOptions options)
    : impl_(std::make_unique<Impl>(std::move(source), std::move(options))) {}

FileStack::~FileStack() = default;

const StackInfo& FileStack::info() const {
  return impl_->info();
}

TexelBlock FileStack::read_rows(int first_row, int rows) {
  return impl_->read_strip(first_row, rows, PixelConverter::Output::kRgb);
}

TexelBlock FileStack::read_luminance(int first_row, int rows) {
  return impl_->read_strip(first_row, rows, PixelConverter::Output::kLuminance);
}

TexelBlock FileStack::read_texels(std::span<const std::uint32_t> texels) {
  return impl_->read_texels(texels);
}

void FileStack::give_back(TexelBlock block) {
  impl_->give_back(std::move(block));
}

int FileStack::strip_rows() const {
  return impl_->strip_rows();
}

const StackSource& FileStack::source() const {
  return impl_->source();
}

const StackEncoding& FileStack::encoding() const {
  return impl_->encoding();
}

const PixelCounts& FileStack::counts() const {
  return impl_->counts();
}

}  // namespace brdfit::io
