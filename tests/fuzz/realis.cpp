// Baked assets: their JSON, and the textures that it names in a folder that has some.
#include "io/realis_json.h"

#include <algorithm>
#include <cmath>

#include "cli/asset_files.h"
#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 3;
constexpr int kHeight = 2;

void write_planes(const fs::path& file, int width, const std::vector<std::string>& channels) {
  io::ExrRowWriter writer(file, width, kHeight, channels, io::ExrDepth::kFloat);
  writer.write(std::vector<float>(channels.size() * static_cast<std::size_t>(width * kHeight), 0.5F),
               kHeight);
  writer.commit();
}

// The textures of a small asset with two lobes, in every kind of colour, and some that fit nothing.
class AssetFolder {
 public:
  AssetFolder() {
    const std::vector<std::string> surface = {"albedo.R", "albedo.G", "albedo.B",
                                              "normal.X", "normal.Y", "normal.Z"};
    write_planes(folder_ / "a.surface.exr", kWidth, surface);
    write_planes(folder_ / "wide.exr", kWidth + 1, surface);
    write_planes(folder_ / "a.chroma.exr", kWidth, {"R", "G", "B"});
    RealisAsset asset;
    asset.lobes.resize(2);
    write_planes(folder_ / "a.amplitudes.exr", kWidth, realis_channel_names(asset));
    asset.colour = RealisColour::kRgb;
    write_planes(folder_ / "rgb.exr", kWidth, realis_channel_names(asset));
    tests::write_text(folder_ / "no.exr", "no picture");
  }
  const fs::path& path() const { return folder_.path(); }

 private:
  tests::TempFolder folder_;
};

void check(const RealisAsset& asset) {
  std::string why;
  require(asset.is_valid(&why), "an asset that is read is valid: " + why);
  require(std::abs(std::hypot(asset.view.x, asset.view.y, asset.view.z) - 1.0) < 1e-6, "the view is unit");
  require(std::isfinite(asset.bytes_per_texel()), "the bytes of a texel are finite");
  const std::vector<std::string> channels = realis_channel_names(asset);
  const auto is_word = [](const std::string& name) {
    return std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 0x7f; });
  };
  require(std::all_of(channels.begin(), channels.end(), is_word), "channels have plain names");
  require(cli::layout_of(asset).textures() >= 0, "textures are counted");
}

void read_textures(const RealisAsset& asset, const fs::path& folder) {
  read_unless_refused([&] {
    cli::AssetReader reader(asset, folder, false);
    const bake::RunTimeTexels texels = reader.read(0, asset.height);
    const auto is_sound = [](const std::vector<float>& values) {
      return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
    };
    require(is_sound(texels.amplitudes) && is_sound(texels.chroma) && is_sound(texels.baked.albedo),
            "what textures hold is finite");
    require(texels.amplitudes.size() == asset.plane_count() * asset.texel_count(), "every plane is read");
    return true;
  });
}

}  // namespace

bool run_realis(Bytes input) {
  static const AssetFolder folder;
  const fs::path file = folder.path() / "input.realis.json";
  write_input(file, input);
  const auto asset = read_unless_refused([&] { return io::read_realis(file); });
  if (!asset) return false;
  check(*asset);
  const fs::path again = folder.path() / "again.realis.json";
  io::write_realis(again, *asset);
  require(io::realis_to_json(io::read_realis(again)) == io::realis_to_json(*asset),
          "an asset comes back unchanged");
  read_textures(*asset, folder.path());
  return true;
}

}  // namespace brdfit::fuzz
