// Realis JSON: what is written is read back, and what does not agree is refused in one line.
#include "io/realis_json.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

RealisAsset asset_of(RealisColour colour) {
  RealisAsset asset;
  asset.name = "lion";
  asset.width = 64;
  asset.height = 43;
  asset.colour = colour;
  asset.lobes = {{{0.0, 0.0, 1.0}, 4.25, -1.0}, {{0.6, 0.0, 0.8}, 1.0 / 3.0, 0.1}};
  asset.base = Material(Model::kCallisto);
  asset.packing = {4, 1, std::vector<RealisRange>(asset.plane_count(), {0.7 / 15.0, 11})};
  asset.files.amplitudes = "lion.amplitudes.exr";
  asset.files.packed = {"lion.packed0.png"};
  return asset;
}

TEST(RealisJson, RoundTrips) {
  for (const RealisColour colour :
       {RealisColour::kLuminance, RealisColour::kScaledChroma, RealisColour::kRgb}) {
    const RealisAsset asset = asset_of(colour);
    const Json json = realis_to_json(asset);
    const RealisAsset read = realis_from_json(json, "here");
    EXPECT_EQ(realis_to_json(read), json);
    EXPECT_EQ(read.lobes, asset.lobes);
    EXPECT_EQ(read.base, asset.base);
    EXPECT_EQ(read.packing.ranges, asset.packing.ranges);
  }
  RealisAsset lambert = asset_of(RealisColour::kRgb);
  lambert.base.reset();
  EXPECT_FALSE(realis_from_json(realis_to_json(lambert), "here").base.has_value());
}

TEST(RealisJson, FilesHoldEvidenceThatReadingSkips) {
  const tests::TempFolder folder;
  const auto file = folder.path() / "a.realis.json";
  write_realis(file, asset_of(RealisColour::kLuminance), {{"lights", 240}});
  EXPECT_EQ(read_realis(file).name, "lion");
  EXPECT_EQ(read_json(file)["bake"]["lights"], 240);
}

TEST(RealisJson, RefusesWhatDoesNotAgree) {
  const Json good = realis_to_json(asset_of(RealisColour::kLuminance));
  const auto expect_refused = [&](auto&& change) {
    Json json = good;
    change(json);
    EXPECT_THROW(realis_from_json(json, "here"), IoError) << json.dump();
  };
  expect_refused([](Json& json) { json["lobe"] = 1; });
  expect_refused([](Json& json) { json.erase("lobes"); });
  expect_refused([](Json& json) { json["lobes"][0]["axis"] = Json::array({0.0, 0.0, 2.0}); });
  expect_refused([](Json& json) { json["lobes"][0]["cos_cut_off"] = 1.0; });
  expect_refused([](Json& json) { json["lobes"][0]["sharpness"] = 1e39; });  // infinite in single precision
  expect_refused([](Json& json) { json["brdfit_realis"] = 1; });
  expect_refused([](Json& json) { json["packing"]["step"].push_back(1.0); });
  expect_refused([](Json& json) { json["packing"]["step"][0] = -1.0; });
  expect_refused([](Json& json) { json["packing"]["zero"][0] = 16; });
  expect_refused([](Json& json) { json["packing"]["zero"][0] = -1; });
  expect_refused([](Json& json) { json["packing"]["zero"][0] = 2.5; });
  expect_refused([](Json& json) { json["packing"]["bits"] = 5; });
  expect_refused([](Json& json) { json["packing"]["dominant"] = 3; });
  expect_refused([](Json& json) { json["colour"] = "yuv"; });
  expect_refused([](Json& json) { json["base"] = "phong"; });
  expect_refused([](Json& json) { json["width"] = 0; });
  expect_refused([](Json& json) { json["fade"]["albedo_range"] = 0.0; });
  expect_refused([](Json& json) { json["view"] = Json::array({0.0, 0.0, 2.0}); });
  expect_refused([](Json& json) {
    json["lobes"] = Json(17, json["lobes"][0]);
    json["packing"]["step"] = Json(17, 0.1);
    json["packing"]["zero"] = Json(17, 0);
  });
  for (const char* name : {"../a.exr", "/a.exr", "..", "a\nb"}) {
    expect_refused([name](Json& json) { json["files"]["amplitudes"] = name; });
    expect_refused([name](Json& json) { json["files"]["packed"][0] = name; });
  }
}

TEST(RealisJson, DoesNotWriteAnAssetThatIsNotValid) {
  RealisAsset asset = asset_of(RealisColour::kRgb);
  asset.packing.ranges.pop_back();
  EXPECT_THROW(realis_to_json(asset), std::invalid_argument);
}

TEST(RealisAsset, CountsTheBytesOfARunTimeTexel) {
  RealisAsset asset = asset_of(RealisColour::kLuminance);
  asset.lobes.assign(8, asset.lobes[0]);
  asset.packing = {8, 8, std::vector<RealisRange>(8)};
  EXPECT_EQ(asset.bytes_per_texel(), 8.0);
  asset.packing = {4, 4, std::vector<RealisRange>(8)};
  EXPECT_EQ(asset.bytes_per_texel(), 3.0);  // four halves of a byte, and the mask
  EXPECT_EQ(realis_channel_names(asset).back(), "lobe07.Y");
}

}  // namespace
}  // namespace brdfit::io
