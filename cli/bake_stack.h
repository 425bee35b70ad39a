// The stack that `brdfit bake` reads: photographs with every weight that was asked for.
#ifndef BRDFIT_CLI_BAKE_STACK_H_
#define BRDFIT_CLI_BAKE_STACK_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/shrunk_stack.h"
#include "bake/weighted_stack.h"
#include "bake/weights.h"
#include "cli/bake_options.h"
#include "cli/contour_pass.h"
#include "io/image_stack_file.h"
#include "io/json.h"

namespace brdfit::cli {

// What the stack takes of --memory beside the strips that are asked of it.
std::size_t memory_beside_strips(const BakeArguments& a);

class BakeStack : public ImageStack {
 public:
  // Opens the files, and with --contours reads them once. several_passes: whether they will be read more than
  // once, for --spill auto. Throws UsageError, io::IoError, and std::runtime_error when interrupted.
  BakeStack(const BakeArguments& a, bool several_passes);

  const StackInfo& info() const override { return top().info(); }
  TexelBlock read_rows(int first_row, int rows) override { return top().read_rows(first_row, rows); }
  TexelBlock read_luminance(int first_row, int rows) override {
    return top().read_luminance(first_row, rows);
  }
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override { return top().read_texels(texels); }
  void give_back(TexelBlock block) override { top().give_back(std::move(block)); }

  int strip_rows() const { return files_.strip_rows(); }
  const io::StackSource& source() const { return files_.source(); }
  const io::PixelCounts& counts() const { return files_.counts(); }

  // What weights there are, for the asset's description; null where there are none.
  io::Json weights_json() const;
  // The same as lines of text; empty where there are none.
  std::string weights_text() const;

 private:
  void weigh_by_noise(const BakeArguments& a);
  void weigh_by_contours(const BakeArguments& a);

  ImageStack& top() { return shrunk_ ? static_cast<ImageStack&>(*shrunk_) : weighted_; }
  const ImageStack& top() const { return shrunk_ ? static_cast<const ImageStack&>(*shrunk_) : weighted_; }

  io::FileStack files_;
  bake::WeightedStack weighted_;
  std::optional<bake::ShrunkStack> shrunk_;
  std::optional<bake::SensorNoise> noise_;
  std::unique_ptr<ContourPass> contours_;
};

// The texels on which choices are made: spread evenly over the picture, all of them where there are few.
std::vector<std::uint32_t> even_sample(const StackInfo& info, std::size_t at_most);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_BAKE_STACK_H_
