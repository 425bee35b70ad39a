// The pass: pictures aside as luminances, then sums of variation, then weights, all by runs of rows.
#include "cli/contour_pass.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/luminance.h"
#include "bake/photometric_stereo.h"
#include "io/spill_file.h"

namespace brdfit::cli {
namespace {

constexpr int kRowsAtOnce = 64;
// Of a texel in a part of a picture: luminances, what is lit, contours, distances.
constexpr std::size_t kBytesPerTexel = 64;
// Of weights that are read for texels here and there.
constexpr std::size_t kBytesAtOnce = std::size_t{1} << 16;
constexpr std::size_t kSurfacePlanes = 6;

double luminance(double red, double green, double blue) {
  return bake::kLuminance[0] * red + bake::kLuminance[1] * green + bake::kLuminance[2] * blue;
}

// Planes of values over the whole picture, in a temporary file.
template <class Value>
class PlaneFile {
 public:
  PlaneFile(io::SpillFile& file, std::size_t planes, std::size_t texels)
      : file_(&file), texels_(texels), place_(file.reserve(planes * texels * sizeof(Value))) {}

  void write(std::size_t plane, std::size_t first, std::span<const Value> values) {
    file_->write_at(place(plane, first), std::as_bytes(values));
  }
  void read(std::size_t plane, std::size_t first, std::span<Value> values) const {
    file_->read_at(place(plane, first), std::as_writable_bytes(values));
  }

 private:
  std::size_t place(std::size_t plane, std::size_t first) const {
    return place_ + (plane * texels_ + first) * sizeof(Value);
  }
  io::SpillFile* file_;
  std::size_t texels_;
  std::size_t place_;
};

// A run of rows with those about it that its contours depend on.
struct Part {
  int first = 0;   // row of the picture
  int height = 0;  // rows
  bake::Rows inner;
};

Part part_of(int row, int halo, int height) {
  const int first = std::max(row - halo, 0);
  const int end = std::min(row + kRowsAtOnce, height);
  return {first, std::min(end + halo, height) - first, {row - first, end - first}};
}

// A photograph and its render in a part.
struct Pair {
  std::vector<float> seen;
  std::vector<float> shown;
  std::vector<float> unshadowed;
  std::vector<float> facing;
  bake::ShadowPicture reference() const { return {seen, unshadowed, facing}; }
  bake::ShadowPicture render() const { return {shown, unshadowed, facing}; }
};

}  // namespace

class ContourPass::Impl {
 public:
  Impl(ImageStack& stack, io::PictureMaps shadows, const ContourPassOptions& options)
      : info_(stack.info()),
        options_(options),
        file_(options.folder.empty() ? std::filesystem::temp_directory_path() : options.folder),
        luminance_(file_, info_.lights.size(), info_.texel_count()),
        surface_(file_, kSurfacePlanes, info_.texel_count()),
        weights_(file_, info_.lights.size(), info_.texel_count()),
        shadows_(std::move(shadows)),
        lowered_(info_.lights.size()) {
    // Parts overlap, and most formats decode from the top alone.
    shadows_->use_spill(true, [this]() -> io::SpillFile& { return file_; });
    put_aside(stack);
    const int parallel =
        static_cast<int>(std::clamp<std::size_t>(options_.memory_bytes / part_bytes(), 1, 4096));
    tbb::task_arena arena(std::min(parallel, tbb::this_task_arena::max_concurrency()));
    arena.execute([&] {
      sum_variation();
      find_weights();
    });
    shadows_.reset();
  }

  void weigh(TexelBlock& block) const {
    if (lowered() == 0) return;
    if (block.weight.empty()) block.weight.assign(block.lights * block.count(), 1.0F);
    tbb::parallel_for(std::size_t{0}, lowered_.size(), [&](std::size_t light) {
      if (lowered_[light] > 0) weigh(block, light);
    });
  }

  std::size_t lowered() const {
    std::size_t sum = 0;
    for (const std::size_t light : lowered_) sum += light;
    return sum;
  }

 private:
  std::size_t width() const { return static_cast<std::size_t>(info_.width); }

  std::size_t part_bytes() const {
    const int rows = kRowsAtOnce + 2 * bake::contour_halo(options_.contours);
    return static_cast<std::size_t>(rows) * width() * kBytesPerTexel;
  }

  void step() const {
    if (options_.step) options_.step();
  }

  void put_aside(ImageStack& stack) {
    for (int row = 0; row < info_.height; row += options_.strip_rows) {
      step();
      TexelBlock block = stack.read_rows(row, std::min(options_.strip_rows, info_.height - row));
      const std::size_t first = block.texels.front();
      const std::size_t count = block.count();
      tbb::parallel_for(std::size_t{0}, block.lights, [&](std::size_t light) {
        std::vector<float> plane(count);
        for (std::size_t k = 0; k < count; ++k) {
          plane[k] = static_cast<float>(
              luminance(block.plane(light, 0)[k], block.plane(light, 1)[k], block.plane(light, 2)[k]));
        }
        luminance_.write(light, first, plane);
      });
      const bake::Surface surface = bake::photometric_stereo(info_, block, bake::all_lights(info_));
      for (std::size_t c = 0; c < 3; ++c) {
        surface_.write(c, first, std::span(surface.albedo).subspan(c * count, count));
        surface_.write(3 + c, first, std::span(surface.normals).subspan(c * count, count));
      }
      stack.give_back(std::move(block));
    }
  }

  std::vector<float> surface_of(const Part& part) const {
    const std::size_t count = static_cast<std::size_t>(part.height) * width();
    std::vector<float> surface(kSurfacePlanes * count);
    for (std::size_t plane = 0; plane < kSurfacePlanes; ++plane) {
      surface_.read(plane, static_cast<std::size_t>(part.first) * width(),
                    std::span(surface).subspan(plane * count, count));
    }
    return surface;
  }

  Pair pair_of(const Part& part, std::span<const float> surface, std::size_t light) {
    const std::size_t count = static_cast<std::size_t>(part.height) * width();
    const std::size_t first = static_cast<std::size_t>(part.first) * width();
    Pair pair;
    pair.seen.resize(count);
    luminance_.read(light, first, pair.seen);
    pair.unshadowed.resize(count);
    pair.facing.resize(count);
    const Rgb& intensity = info_.lights[light].intensity;
    const auto at = [&](std::size_t plane, std::size_t k) {
      return static_cast<double>(surface[plane * count + k]);
    };
    for (std::size_t k = 0; k < count; ++k) {
      const Incidence from = incidence(info_, light, static_cast<std::uint32_t>(first + k));
      const double cos_i =
          from.direction.x * at(3, k) + from.direction.y * at(4, k) + from.direction.z * at(5, k);
      const double white =
          luminance(intensity[0] * at(0, k), intensity[1] * at(1, k), intensity[2] * at(2, k));
      pair.facing[k] = static_cast<float>(cos_i);
      pair.unshadowed[k] = static_cast<float>(white * from.falloff * std::max(cos_i, 0.0));
    }
    pair.shown = pair.unshadowed;
    const std::vector<float> reaches = shadows_->read(light, {part.first, part.height, {}});
    for (std::size_t k = 0; k < reaches.size(); ++k) pair.shown[k] *= reaches[k];
    return pair;
  }

  // Calls use(part, light, photograph and render) for all lights, parts of each light in their order.
  template <class Use>
  void for_parts(int halo, const Use& use) {
    for (int row = 0; row < info_.height; row += kRowsAtOnce) {
      step();
      const Part part = part_of(row, halo, info_.height);
      const std::vector<float> surface = surface_of(part);
      tbb::parallel_for(std::size_t{0}, info_.lights.size(),
                        [&](std::size_t light) { use(part, light, pair_of(part, surface, light)); });
    }
  }

  void sum_variation() {
    seen_.resize(info_.lights.size());
    shown_.resize(info_.lights.size());
    for_parts(1, [&](const Part& part, std::size_t light, const Pair& pair) {
      bake::add_variation(seen_[light], pair.reference(), info_.width, part.height, part.inner);
      bake::add_variation(shown_[light], pair.render(), info_.width, part.height, part.inner);
    });
  }

  void find_weights() {
    const bake::ContourOptions& options = options_.contours;
    for_parts(bake::contour_halo(options), [&](const Part& part, std::size_t light, const Pair& pair) {
      const std::vector<float> weights = bake::contour_weights(
          bake::find_contours(pair.reference(), info_.width, part.height, seen_[light], options),
          bake::find_contours(pair.render(), info_.width, part.height, shown_[light], options), info_.width,
          part.height, options);
      const auto inner =
          std::span(weights).subspan(static_cast<std::size_t>(part.inner.first) * width(),
                                     static_cast<std::size_t>(part.inner.last - part.inner.first) * width());
      std::vector<std::uint8_t> codes(inner.size());
      for (std::size_t k = 0; k < codes.size(); ++k) {
        codes[k] = static_cast<std::uint8_t>(std::lround(255.0F * inner[k]));
        lowered_[light] += codes[k] < 255 ? 1 : 0;
      }
      weights_.write(light, static_cast<std::size_t>(part.first + part.inner.first) * width(), codes);
    });
  }

  void weigh(TexelBlock& block, std::size_t light) const {
    std::vector<std::uint8_t> codes;
    for (std::size_t k = 0; k < block.count();) {
      const std::size_t first = block.texels[k];
      std::size_t end = k;
      while (end < block.count() && block.texels[end] < first + kBytesAtOnce) ++end;
      codes.resize(block.texels[end - 1] - first + 1);
      weights_.read(light, first, codes);
      for (; k < end; ++k) {
        block.weight[light * block.count() + k] *=
            static_cast<float>(codes[block.texels[k] - first]) / 255.0F;
      }
    }
  }

  const StackInfo& info_;
  ContourPassOptions options_;
  io::SpillFile file_;
  PlaneFile<float> luminance_;
  PlaneFile<float> surface_;
  PlaneFile<std::uint8_t> weights_;
  std::optional<io::PictureMaps> shadows_;  // while the pass lasts
  std::vector<bake::VariationSums> seen_;
  std::vector<bake::VariationSums> shown_;
  std::vector<std::size_t> lowered_;  // per light
};

ContourPass::ContourPass(ImageStack& stack, io::PictureMaps shadows, const ContourPassOptions& options)
    : impl_(std::make_unique<Impl>(stack, std::move(shadows), options)) {}

ContourPass::~ContourPass() = default;

void ContourPass::weigh(TexelBlock& block) const {
  impl_->weigh(block);
}

std::size_t ContourPass::lowered() const {
  return impl_->lowered();
}

}  // namespace brdfit::cli
