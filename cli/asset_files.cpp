// Textures of an asset, each by its own writer or reader.
#include "cli/asset_files.h"

#include <fmt/format.h>

#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "brdf/kernel/realis.h"
#include "io/image_reader.h"
#include "io/material_json.h"
#include "io/png_rows.h"

namespace brdfit::cli {
namespace {

const std::vector<std::string> kSurfaceChannels = {"albedo.R", "albedo.G", "albedo.B",
                                                   "normal.X", "normal.Y", "normal.Z"};
const std::vector<std::string> kChromaChannels = {"R", "G", "B"};

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(255.0F * std::clamp(share, 0.0F, 1.0F) + 0.5F);
}

// sRGB codes of floats, as io::srgb8_from_linear has them: a table of where codes begin, and one of guesses.
class SrgbCodes {
 public:
  SrgbCodes() {
    for (int code = 1; code < 256; ++code) begin_[static_cast<std::size_t>(code)] = beginning_of(code);
    begin_[256] = 2.0F;
    std::uint8_t code = 0;
    for (std::size_t k = 0; k < kGuesses; ++k) {
      const float value = static_cast<float>(k) / static_cast<float>(kGuesses - 1);
      while (begin_[code + 1U] <= value) ++code;
      guess_[k] = code;
    }
  }

  std::uint8_t operator()(float linear) const {
    const float value = std::clamp(linear, 0.0F, 1.0F);
    std::uint8_t code = guess_[static_cast<std::size_t>(value * static_cast<float>(kGuesses - 1))];
    while (begin_[code + 1U] <= value) ++code;
    while (begin_[code] > value) --code;
    return code;
  }

 private:
  static constexpr std::size_t kGuesses = 4096;

  // The least float of a code. Positive floats are ordered as their bits are.
  static float beginning_of(int code) {
    std::uint32_t low = 0;
    std::uint32_t high = std::bit_cast<std::uint32_t>(1.0F);
    while (low < high) {
      const std::uint32_t middle = low + (high - low) / 2;
      const bool reached = io::srgb8_from_linear(static_cast<double>(std::bit_cast<float>(middle))) >= code;
      (reached ? high : low) = reached ? middle : middle + 1;
    }
    return std::bit_cast<float>(low);
  }

  std::array<float, 257> begin_{};
  std::array<std::uint8_t, kGuesses> guess_{};
};

// [channel][texel] to interleaved bytes.
template <class Encode>
std::vector<std::uint8_t> interleaved(std::span<const float> planes, std::size_t channels,
                                      const Encode& encode) {
  const std::size_t count = planes.size() / channels;
  std::vector<std::uint8_t> bytes(planes.size());
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t k = 0; k < count; ++k) bytes[k * channels + c] = encode(planes[c * count + k]);
  }
  return bytes;
}

}  // namespace

bake::PackLayout layout_of(const RealisAsset& asset) {
  bake::PackLayout layout{static_cast<int>(asset.lobes.size()),
                          asset.colour == RealisColour::kRgb ? 3 : 1,
                          asset.packing.bits,
                          asset.packing.dominant,
                          {}};
  for (const RealisRange& range : asset.packing.ranges) layout.zeros.push_back(range.zero);
  return layout;
}

void name_asset_files(RealisAsset& asset) {
  RealisFiles files;
  const bool has_lobes = !asset.lobes.empty();
  if (has_lobes) {
    files.amplitudes = asset.name + ".amplitudes.exr";
    for (int k = 0; k < layout_of(asset).textures(); ++k)
      files.packed.push_back(fmt::format("{}.codes{}.png", asset.name, k));
    if (layout_of(asset).mask_channels() > 0) files.dominant = asset.name + ".dominant.png";
    if (asset.colour == RealisColour::kScaledChroma) files.chroma = asset.name + ".chroma.exr";
  }
  files.surface = asset.name + ".surface.exr";
  files.albedo = asset.name + ".albedo.png";
  files.normals = asset.name + ".normals.png";
  files.confidence = asset.name + ".confidence.png";
  asset.files = std::move(files);
}

std::vector<std::filesystem::path> asset_paths(const RealisAsset& asset,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  const RealisFiles& f = asset.files;
  for (const std::string& name :
       {f.amplitudes, f.dominant, f.chroma, f.surface, f.albedo, f.normals, f.confidence}) {
    if (!name.empty()) paths.push_back(folder / name);
  }
  for (const std::string& name : f.packed) paths.push_back(folder / name);
  return paths;
}

struct AssetWriter::State {
  RealisAsset asset;
  SrgbCodes srgb;
  std::optional<io::ExrRowWriter> amplitudes;
  std::optional<io::ExrRowWriter> chroma;
  std::vector<std::unique_ptr<io::PngRowWriter>> packed;
  std::optional<io::PngRowWriter> dominant;
  std::optional<io::ExrRowWriter> surface;
  std::optional<io::PngRowWriter> albedo;
  std::optional<io::PngRowWriter> normals;
  std::optional<io::PngRowWriter> confidence;
};

AssetWriter::AssetWriter(const RealisAsset& asset, const std::filesystem::path& folder, io::ExrDepth depth,
                         bool zip)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.asset = asset;
  const RealisFiles& files = asset.files;
  const int width = asset.width;
  const int height = asset.height;
  const io::ExrCompression compression = zip ? io::ExrCompression::kZip : io::ExrCompression::kNone;
  // Codes are nearly noise: compressing them takes half as long as solving, and saves two bytes of five.
  const io::PngCompression of_codes = zip ? io::PngCompression::kQuick : io::PngCompression::kNone;
  if (!files.amplitudes.empty()) {
    s.amplitudes.emplace(folder / files.amplitudes, width, height, realis_channel_names(asset), depth,
                         io::ImageMetadata(), compression);
  }
  if (!files.chroma.empty())
    s.chroma.emplace(folder / files.chroma, width, height, kChromaChannels, io::ExrDepth::kHalf,
                     io::ImageMetadata(), compression);
  for (const std::string& name : files.packed) {
    s.packed.push_back(std::make_unique<io::PngRowWriter>(folder / name, width, height, 4, of_codes));
  }
  if (!files.dominant.empty())
    s.dominant.emplace(folder / files.dominant, width, height, layout_of(asset).mask_channels(), of_codes);
  s.surface.emplace(folder / files.surface, width, height, kSurfaceChannels, io::ExrDepth::kFloat,
                    io::ImageMetadata(), compression);
  s.albedo.emplace(folder / files.albedo, width, height, 3);
  s.normals.emplace(folder / files.normals, width, height, 3);
  s.confidence.emplace(folder / files.confidence, width, height, 1);
}

AssetWriter::~AssetWriter() = default;

void AssetWriter::write(const AssetRows& rows, int count, CpuMeter& cpu) {
  State& s = *state_;
  const bake::Surface& surface = rows.surface;
  tbb::task_group files;
  const auto begin = [&](const auto& work) { files.run([&cpu, work] { cpu.measure(work); }); };
  if (s.amplitudes) begin([&] { s.amplitudes->write(rows.amplitudes, count); });
  if (s.chroma) begin([&] { s.chroma->write(rows.chroma, count); });
  for (std::size_t k = 0; k < s.packed.size(); ++k) {
    begin([&s, &rows, count, k] { s.packed[k]->write(rows.packed.textures[k], count); });
  }
  if (s.dominant) begin([&] { s.dominant->write(rows.packed.mask, count); });
  begin([&] {
    std::vector<float> planes = surface.albedo;
    planes.insert(planes.end(), surface.normals.begin(), surface.normals.end());
    s.surface->write(planes, count);
  });
  begin([&] { s.albedo->write(interleaved(surface.albedo, 3, s.srgb), count); });
  begin([&] {
    const auto code = [](float n) { return byte_of(0.5F * n + 0.5F); };
    s.normals->write(interleaved(surface.normals, 3, code), count);
  });
  begin([&] { s.confidence->write(interleaved(rows.confidence, 1, byte_of), count); });
  files.wait();
}

void AssetWriter::commit() {
  State& s = *state_;
  // Beside each other, as each waits for the disk.
  tbb::task_group files;
  const auto begin = [&](auto& file) { files.run([&file] { file.commit(); }); };
  if (s.amplitudes) begin(*s.amplitudes);
  if (s.chroma) begin(*s.chroma);
  for (const auto& texture : s.packed) begin(*texture);
  if (s.dominant) begin(*s.dominant);
  begin(*s.surface);
  begin(*s.albedo);
  begin(*s.normals);
  begin(*s.confidence);
  files.wait();
}

std::size_t AssetWriter::cut_values() const {
  return state_->amplitudes ? state_->amplitudes->cut_values() : 0;
}

struct AssetReader::State {
  RealisAsset asset;
  bool packed = false;
  std::optional<io::ExrRowReader> amplitudes;
  std::optional<io::ExrRowReader> chroma;
  std::optional<io::ExrRowReader> surface;
  std::vector<io::ImageReader> codes;
  std::optional<io::ImageReader> dominant;
  bake::PackedTexels bytes;  // of the rows read last

  void require_size(int width, int height, const std::string& file) const {
    if (width == asset.width && height == asset.height) return;
    throw io::IoError(io::IoError::Side::kInput, file, fmt::format("is {} x {} pixels", width, height),
                      fmt::format("{} x {}, as {}.realis.json says", asset.width, asset.height, asset.name));
  }
  io::ImageReader open_bytes(const std::filesystem::path& file, int channels) const {
    io::ImageReader reader(file);
    require_size(reader.header().width, reader.header().height, file.string());
    if (reader.header().channels != channels || reader.header().type != io::SampleType::kUint8) {
      throw io::IoError(
          io::IoError::Side::kInput, file.string(),
          fmt::format("has {} channels of {}", reader.header().channels, name_of(reader.header().type)),
          fmt::format("{} channels of 8 bit", channels));
    }
    return reader;
  }
  std::vector<float> read_amplitudes(int first_row, int rows);
};

namespace {

std::vector<std::uint8_t> bytes_of_rows(io::ImageReader& reader, int first_row, int rows) {
  std::vector<std::uint8_t> bytes(reader.header().row_bytes() * static_cast<std::size_t>(rows));
  reader.read_native(first_row, rows, std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

}  // namespace

std::vector<float> AssetReader::State::read_amplitudes(int first_row, int rows) {
  if (asset.lobes.empty()) return {};
  if (!packed) return amplitudes->read(first_row, rows);
  bytes.textures.clear();
  for (io::ImageReader& reader : codes) bytes.textures.push_back(bytes_of_rows(reader, first_row, rows));
  if (dominant) bytes.mask = bytes_of_rows(*dominant, first_row, rows);
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(asset.width);
  const std::vector<int> whole = bake::unpack(layout_of(asset), bytes, count);
  std::vector<float> out(whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const RealisRange& range = asset.packing.ranges[k / count];
    out[k] = static_cast<float>(kernel::realis_amplitude(static_cast<double>(whole[k] + range.zero),
                                                         static_cast<double>(range.zero), range.step));
  }
  return out;
}

AssetReader::AssetReader(RealisAsset asset, std::filesystem::path folder, bool packed)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.asset = std::move(asset);
  s.packed = packed;
  const RealisFiles& files = s.asset.files;
  const auto open = [&](std::optional<io::ExrRowReader>& reader, const std::string& name,
                        const std::vector<std::string>& channels) {
    reader.emplace(folder / name, channels);
    s.require_size(reader->width(), reader->height(), (folder / name).string());
  };
  open(s.surface, files.surface, kSurfaceChannels);
  if (s.asset.lobes.empty()) return;
  if (s.asset.colour == RealisColour::kScaledChroma) open(s.chroma, files.chroma, kChromaChannels);
  if (!packed) {
    open(s.amplitudes, files.amplitudes, realis_channel_names(s.asset));
    return;
  }
  const bake::PackLayout layout = layout_of(s.asset);
  if (files.packed.size() != static_cast<std::size_t>(layout.textures())) {
    throw io::IoError(io::IoError::Side::kInput, (folder / (s.asset.name + ".realis.json")).string(),
                      fmt::format("names {} packed textures", files.packed.size()),
                      std::to_string(layout.textures()));
  }
  for (const std::string& name : files.packed) s.codes.push_back(s.open_bytes(folder / name, 4));
  if (layout.mask_channels() > 0)
    s.dominant.emplace(s.open_bytes(folder / files.dominant, layout.mask_channels()));
}

AssetReader::~AssetReader() = default;

const bake::PackedTexels& AssetReader::packed_bytes() const {
  return state_->bytes;
}

bake::RunTimeTexels AssetReader::read(int first_row, int rows) {
  State& s = *state_;
  const std::vector<float> surface = s.surface->read(first_row, rows);
  const std::size_t count = surface.size() / 6;
  bake::RunTimeTexels out;
  const auto middle = surface.begin() + static_cast<std::ptrdiff_t>(3 * count);
  out.surface.albedo.assign(surface.begin(), middle);
  out.surface.normals.assign(middle, surface.end());
  out.surface.state.assign(count, bake::TexelState::kOk);
  out.baked = out.surface;
  out.amplitudes = s.read_amplitudes(first_row, rows);
  if (s.chroma) out.chroma = s.chroma->read(first_row, rows);
  return out;
}

}  // namespace brdfit::cli
