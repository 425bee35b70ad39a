// Opening a stack, and the weights that its manifest and the command line ask for.
#include "cli/bake_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "cli/progress.h"
#include "io/decode_floor.h"

namespace brdfit::cli {
namespace {

// What a strip needs beside its pixels: render, problem, solution.
constexpr std::size_t kMemoryPerPixelMemory = 5;

std::size_t memory_bytes(const BakeArguments& a) {
  return static_cast<std::size_t>(a.memory_mib) << 20;
}

}  // namespace

std::size_t memory_beside_strips(const BakeArguments& a) {
  return (a.shrink > 1 || a.contours ? 1 : 0) * memory_bytes(a) / 8;
}

namespace {

io::FileStack open_files(const BakeArguments& a, bool several_passes) {
  io::FileStackOptions options;
  if (!a.transfer.empty()) {
    options.transfer = io::transfer_from(a.transfer);
    if (!options.transfer)
      throw UsageError(fmt::format("--transfer {} is not {}", a.transfer, io::kTransferNames));
  }
  options.memory_bytes = memory_bytes(a) / kMemoryPerPixelMemory;
  io::StackSource source = io::read_stack_source(a.stack);
  options.spill = a.spill == "on" || (a.spill == "auto" && several_passes && io::pays_to_spill(source));
  return io::FileStack(std::move(source), options);
}

std::optional<bake::SensorNoise> noise_of(const BakeArguments& a, const io::StackSource& source) {
  bake::SensorNoise noise;
  if (!a.noise.empty()) {
    noise.read_deviation = a.noise[0];
    noise.shot = a.noise[1];
    std::string why;
    if (!noise.is_valid(&why)) throw UsageError("--noise: " + why);
  } else if (source.noise) {
    noise.read_deviation = source.noise->read_deviation;
    noise.shot = source.noise->shot;
  } else {
    return {};
  }
  return noise;
}

}  // namespace

BakeStack::BakeStack(const BakeArguments& a, bool several_passes)
    : files_(open_files(a, several_passes || a.contours)), weighted_(files_) {
  weigh_by_noise(a);
  if (a.contours) weigh_by_contours(a);
  if (a.shrink > 1) shrunk_.emplace(weighted_, a.shrink, memory_beside_strips(a) / 2);
}

void BakeStack::weigh_by_noise(const BakeArguments& a) {
  noise_ = noise_of(a, files_.source());
  if (!noise_) return;
  std::vector<double> exposure;
  for (const io::StackPicture& picture : files_.source().pictures) {
    exposure.push_back(picture.exposure_seconds.value_or(1.0));
  }
  weighted_.add(
      {[noise = *noise_, exposure](TexelBlock& block) { bake::weigh_by_noise(block, noise, exposure); },
       true});
}

void BakeStack::weigh_by_contours(const BakeArguments& a) {
  const io::StackSource& source = files_.source();
  io::PictureMaps shadows(
      source.maps_of(&io::StackPicture::shadow),
      io::FrameSize{info().width, info().height, source.pictures.front().file.filename().string()});
  ContourPassOptions options;
  options.strip_rows = std::max(1, strip_rows());
  options.memory_bytes = memory_bytes(a) / 3;
  options.step = [] {
    if (interrupted()) throw std::runtime_error("interrupted; nothing is written");
  };
  say(a.common, "looking for shadow contours");
  contours_ = std::make_unique<ContourPass>(weighted_, std::move(shadows), options);
  weighted_.add({[this](TexelBlock& block) { contours_->weigh(block); }, false});
}

io::Json BakeStack::weights_json() const {
  io::Json json;
  if (const std::size_t maps = files_.source().count_of(&io::StackPicture::weight); maps > 0)
    json["maps"] = maps;
  if (noise_) json["noise"] = {{"read_deviation", noise_->read_deviation}, {"shot", noise_->shot}};
  if (contours_) {
    json["contours"] = {{"shadow_maps", files_.source().count_of(&io::StackPicture::shadow)},
                        {"lowered_values", contours_->lowered()}};
  }
  return json;
}

std::string BakeStack::weights_text() const {
  std::string text;
  if (const std::size_t maps = files_.source().count_of(&io::StackPicture::weight); maps > 0) {
    text += fmt::format("weights: maps of {} of {} pictures\n", maps, info().lights.size());
  }
  if (noise_) text += fmt::format("weights: noise {:g}, {:g}\n", noise_->read_deviation, noise_->shot);
  if (contours_) {
    text += fmt::format("weights: {} values lie between shadow contours; {} pictures have a shadow map\n",
                        contours_->lowered(), files_.source().count_of(&io::StackPicture::shadow));
  }
  return text;
}

std::vector<std::uint32_t> even_sample(const StackInfo& info, std::size_t at_most) {
  const std::size_t texels = info.texel_count();
  std::vector<std::uint32_t> sample(std::min(texels, at_most));
  for (std::size_t k = 0; k < sample.size(); ++k) {
    sample[k] = static_cast<std::uint32_t>((2 * k + 1) * texels / (2 * sample.size()));
  }
  return sample;
}

}  // namespace brdfit::cli
