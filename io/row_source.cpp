// Decoding rows, and keeping them aside.
#include "io/row_source.h"

#include <algorithm>
#include <vector>

#include "io/image_layout.h"

namespace brdfit::io {
namespace {

constexpr int kRowsAtOnce = 16;  // of a JPEG's blocks

}  // namespace

RowSource::RowSource(const std::filesystem::path& file)
    : name_(file.string()), needs_whole_image_(layout_of(file).needs_whole_image), reader_(file) {
  header_ = reader_->header();
  // Even the decoder of an image that waits for its turn would hold memory.
  if (needs_whole_image_) reader_.reset();
}

void RowSource::use_spill(SpillFile& spill) {
  spill_ = &spill;
  place_ = spill.reserve(header_.row_bytes() * static_cast<std::size_t>(header_.height));
  spilled_rows_ = 0;
}

void RowSource::read(int first, int rows, std::span<std::byte> out) {
  if (spill_ == nullptr) {
    if (!reader_) reader_.emplace(name_);
    return reader_->read_native(first, rows, out);
  }
  const std::size_t row_bytes = header_.row_bytes();
  if (first == spilled_rows_ && !needs_whole_image_ && rows > 0) {
    reader_->read_native(first, rows, out);
    spill_->write_at(place_ + static_cast<std::size_t>(first) * row_bytes, out);
    spilled_rows_ = first + rows;
  } else {
    decode_until(needs_whole_image_ ? header_.height : first + rows);
    spill_->read_at(place_ + static_cast<std::size_t>(first) * row_bytes, out);
  }
  if (spilled_rows_ == header_.height) reader_.reset();
}

void RowSource::decode_until(int row) {
  if (spilled_rows_ >= row) return;
  if (!reader_) reader_.emplace(name_);
  std::vector<std::byte> strip;
  while (spilled_rows_ < row) {
    const int rows = std::min(kRowsAtOnce, row - spilled_rows_);
    strip.resize(static_cast<std::size_t>(rows) * header_.row_bytes());
    reader_->read_native(spilled_rows_, rows, strip);
    spill_->write_at(place_ + static_cast<std::size_t>(spilled_rows_) * header_.row_bytes(), strip);
    spilled_rows_ += rows;
  }
}

}  // namespace brdfit::io
