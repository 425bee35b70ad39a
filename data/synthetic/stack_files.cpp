// Photographs in the encoding asked for, the manifest last.
#include "data/synthetic/stack_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "data/synthetic/stack.h"
#include "io/exr_rows.h"
#include "io/image_file.h"
#include "io/image_reader.h"
#include "io/png_rows.h"
#include "io/realis_json.h"
#include "io/transfer.h"

namespace brdfit::synthetic {
namespace {

namespace fs = std::filesystem;

io::SampleType depth_of(const std::string& format) {
  if (format == "exr") return io::SampleType::kFloat;
  return format == "jpg" || format == "jpeg" ? io::SampleType::kUint8 : io::SampleType::kUint16;
}

std::string manifest_name(const StackRecipe& recipe) {
  return recipe.name + (recipe.files.manifest == "lp" ? ".lp" : ".olat.json");
}

std::vector<std::uint32_t> row_of(const StackInfo& info, int row) {
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(info.width));
  for (std::size_t x = 0; x < texels.size(); ++x) {
    texels[x] = static_cast<std::uint32_t>(static_cast<std::size_t>(row) * texels.size() + x);
  }
  return texels;
}

void write_photograph(const StackRecipe& recipe, const SyntheticStack& stack, std::size_t light,
                      const fs::path& folder) {
  const StackInfo& info = stack.info();
  const io::Transfer transfer = *io::transfer_from(recipe.files.transfer);
  std::vector<std::uint32_t> texels(info.texel_count());
  for (std::size_t k = 0; k < texels.size(); ++k) texels[k] = static_cast<std::uint32_t>(k);
  const std::vector<float> planes = stack.picture(light, texels);
  std::vector<float> samples(planes.size());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < texels.size(); ++k) {
      samples[k * 3 + c] =
          static_cast<float>(io::to_code(transfer, static_cast<double>(planes[c * texels.size() + k])));
    }
  }
  io::write_image(
      folder / info.lights[light].name,
      {info.width, info.height, 3, io::SampleType::kFloat, std::as_bytes(std::span<const float>(samples))},
      {depth_of(recipe.files.format), recipe.files.jpeg_quality, recipe.files.jpeg_subsampling, {}});
}

io::Json manifest_of(const StackRecipe& recipe, const StackInfo& info) {
  io::Json json;
  json["version"] = 1;
  json["images"] = io::Json::array();
  for (const StackLight& light : info.lights) {
    io::Json image = {{"file", light.name}, {"intensity", light.intensity}};
    if (light.position) {
      image["position"] = io::vector_to_json(*light.position);
    } else {
      image["direction"] = io::vector_to_json(light.direction);
    }
    json["images"].push_back(std::move(image));
  }
  json["transfer"] = recipe.files.transfer;
  if (recipe.shape.relief == Relief::kSphere) json["mask"] = recipe.name + ".mask.png";
  if (recipe.files.give_normals) json["normals"] = recipe.name + ".normals.exr";
  if (recipe.files.give_albedo) json["albedo"] = recipe.name + ".albedo.exr";
  if (has_near_lights(info)) {
    json["pixel_size"] = info.plane.pixel_size;
    json["origin"] = io::vector_to_json(info.plane.origin);
    json["units"] = "picture widths";
  }
  return json;
}

std::string light_file_of(const StackInfo& info) {
  std::string text = fmt::format("{}\n", info.lights.size());
  for (const StackLight& light : info.lights) {
    text += fmt::format("{} {} {} {}\n", light.name, light.direction.x, light.direction.y, light.direction.z);
  }
  return text;
}

// Three values of every texel, row by row.
template <class ValueOf>
void write_truth(const fs::path& file, const StackInfo& info, std::vector<std::string> channels,
                 ValueOf&& value_of) {
  const std::size_t planes = channels.size();
  io::ExrRowWriter writer(file, info.width, info.height, std::move(channels), io::ExrDepth::kFloat);
  for (int row = 0; row < info.height; ++row) {
    const std::vector<std::uint32_t> texels = row_of(info, row);
    std::vector<float> values(planes * texels.size());
    for (std::size_t c = 0; c < planes; ++c) {
      for (std::size_t x = 0; x < texels.size(); ++x) {
        values[c * texels.size() + x] = static_cast<float>(value_of(texels[x], c));
      }
    }
    writer.write(values, 1);
  }
  writer.commit();
}

void write_mask(const fs::path& file, const SyntheticStack& stack) {
  const StackInfo& info = stack.info();
  io::PngRowWriter writer(file, info.width, info.height, 1);
  for (int row = 0; row < info.height; ++row) {
    std::vector<std::uint8_t> bytes;
    for (const std::uint32_t texel : row_of(info, row)) bytes.push_back(stack.is_masked(texel) ? 0 : 255);
    writer.write(bytes, 1);
  }
  writer.commit();
}

void write_residual(const StackRecipe& recipe, const SyntheticStack& stack, const fs::path& folder) {
  RealisAsset truth;  // for the names of its channels
  truth.lobes = stack.lobes();
  write_truth(folder / (recipe.name + ".amplitudes.exr"), stack.info(), realis_channel_names(truth),
              [&](std::uint32_t texel, std::size_t lobe) { return stack.amplitude(texel, lobe); });
  io::write_json(folder / (recipe.name + ".truth.json"), {{"lobes", io::lobes_to_json(stack.lobes())}});
}

}  // namespace

std::vector<fs::path> stack_paths(const StackRecipe& recipe, const fs::path& folder) {
  const SyntheticStack stack(recipe);
  std::vector<fs::path> paths;
  for (const StackLight& light : stack.info().lights) paths.push_back(folder / light.name);
  paths.push_back(folder / (recipe.name + ".normals.exr"));
  paths.push_back(folder / (recipe.name + ".albedo.exr"));
  if (recipe.shape.relief == Relief::kSphere) paths.push_back(folder / (recipe.name + ".mask.png"));
  if (recipe.residual.lobes > 0) {
    paths.push_back(folder / (recipe.name + ".amplitudes.exr"));
    paths.push_back(folder / (recipe.name + ".truth.json"));
  }
  paths.push_back(folder / manifest_name(recipe));
  return paths;
}

void write_stack(const StackRecipe& recipe, const fs::path& folder,
                 const std::function<void(std::size_t)>& progress) {
  const SyntheticStack stack(recipe);
  const StackInfo& info = stack.info();
  for (std::size_t light = 0; light < info.lights.size(); ++light) {
    write_photograph(recipe, stack, light, folder);
    if (progress) progress(light + 1);
  }
  write_truth(folder / (recipe.name + ".normals.exr"), info, {"R", "G", "B"},
              [&](std::uint32_t texel, std::size_t c) {
                const Vec3 n = stack.normal(texel);
                return std::array{n.x, n.y, n.z}[c];
              });
  write_truth(folder / (recipe.name + ".albedo.exr"), info, {"R", "G", "B"},
              [&](std::uint32_t texel, std::size_t c) { return stack.albedo(texel)[c]; });
  if (recipe.shape.relief == Relief::kSphere) write_mask(folder / (recipe.name + ".mask.png"), stack);
  if (recipe.residual.lobes > 0) write_residual(recipe, stack, folder);
  const fs::path manifest = folder / manifest_name(recipe);
  if (recipe.files.manifest == "lp") {
    io::write_text(manifest, light_file_of(info));
  } else {
    io::write_json(manifest, manifest_of(recipe, info));
  }
}

}  // namespace brdfit::synthetic
