// A stack of photographs read from its files, strip by strip.
#ifndef BRDFIT_IO_IMAGE_STACK_FILE_H_
#define BRDFIT_IO_IMAGE_STACK_FILE_H_

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/stack_source.h"
#include "measured/image_stack.h"

namespace brdfit::io {

struct FileStackOptions {
  std::optional<Transfer> transfer;  // in place of what the manifest or the pictures say
  // What the strips that strip_rows() proposes may take, with their conversion.
  std::size_t memory_bytes = std::size_t{64} << 20;
  // Keeps decoded rows aside in a temporary file, so that a second pass decodes nothing. Pictures whose
  // decoder would hold them whole (progressive JPEG, interlaced PNG) are kept aside in any case.
  bool spill = false;
  std::filesystem::path spill_folder;  // empty: that of temporary files
};

// How the pictures encode light. Depth and transfer are those of the first picture.
struct StackEncoding {
  SampleType depth = SampleType::kUint8;
  bool is_mixed = false;  // others have another depth or transfer
  std::string format;
  int channels = 0;
  Transfer transfer;
  std::string transfer_origin;  // "asked for", "the manifest", "the pictures", "the usual for 8 bit"
};

// Of the rows that were read so far; a row counts once. Pixels are those of all pictures.
struct PixelCounts {
  std::size_t pixels = 0;
  std::size_t saturated = 0;   // at the top of an integer encoding in some channel
  std::size_t non_finite = 0;  // their values are 0
  std::size_t masked_texels = 0;
  std::size_t bad_texels = 0;  // without a normal, or black in the flat frame

  PixelCounts& operator+=(const PixelCounts& more) {
    pixels += more.pixels;
    saturated += more.saturated;
    non_finite += more.non_finite;
    masked_texels += more.masked_texels;
    bad_texels += more.bad_texels;
    return *this;
  }
  // Of what was counted since.
  friend PixelCounts operator-(PixelCounts now, const PixelCounts& before) {
    now.pixels -= before.pixels;
    now.saturated -= before.saturated;
    now.non_finite -= before.non_finite;
    now.masked_texels -= before.masked_texels;
    now.bad_texels -= before.bad_texels;
    return now;
  }
  friend PixelCounts operator+(PixelCounts a, const PixelCounts& b) { return a += b; }
};

// Values of a texel have weight 0 where they are saturated or not finite, or where the texel is masked;
// elsewhere that of their picture's weight map, or 1.
// Pictures are decoded in parallel, each from top to bottom, with all files open; read from top to bottom,
// every picture is decoded once in a pass. Values are linear Rec.709 divided by exposure: dark frame off,
// flat frame (scaled to mean 1 in each channel) divided out, then the colour matrix.
//
// Normal maps of integer samples hold n / 2 + 1/2. Albedo is taken by its own file's metadata, else as srgb
// for 8 bit and linear for all else. A mask's texel counts where its first channel is at least half its
// range.
class FileStack : public ImageStack {
 public:
  // Opens all files. Throws IoError (kInput): a file that is no image, or of another size than the first
  // picture.
  explicit FileStack(StackSource source, FileStackOptions options = {});
  ~FileStack() override;

  const StackInfo& info() const override;
  TexelBlock read_rows(int first_row, int rows) override;
  TexelBlock read_luminance(int first_row, int rows) override;
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override;
  void give_back(TexelBlock block) override;

  // Rows of a strip that fit into options.memory_bytes; at least 1.
  int strip_rows() const;
  const StackSource& source() const;
  const StackEncoding& encoding() const;
  const PixelCounts& counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_IMAGE_STACK_FILE_H_
