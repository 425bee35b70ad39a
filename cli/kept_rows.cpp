// A head with sizes and checksums, then the arrays as they are.
#include "cli/kept_rows.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "bake/record.h"
#include "io/checksum.h"
#include "io/error.h"

namespace brdfit::cli {
namespace {

constexpr std::uint64_t kMagic = 0x3173776f72667262;  // "brfrows1"

struct Frame {
  std::uint64_t magic = kMagic;
  std::uint64_t head_bytes = 0;
  std::uint64_t head_checksum = 0;
};

template <class T>
std::span<const std::byte> bytes_of_vector(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// The arrays of a strip, in the order of the file; textures last, as many as there are.
std::vector<std::span<const std::byte>> arrays_of(const AssetRows& rows) {
  std::vector<std::span<const std::byte>> arrays = {
      bytes_of_vector(rows.amplitudes),     bytes_of_vector(rows.chroma),
      bytes_of_vector(rows.surface.albedo), bytes_of_vector(rows.surface.normals),
      bytes_of_vector(rows.confidence),     bytes_of_vector(rows.packed.mask)};
  for (const std::vector<std::uint8_t>& texture : rows.packed.textures)
    arrays.push_back(bytes_of_vector(texture));
  return arrays;
}
constexpr std::size_t kFixedArrays = 6;

// Memory for an array of so many bytes.
template <class T>
std::span<std::byte> room_in(std::vector<T>& values, std::size_t bytes) {
  values.resize(bytes / sizeof(T));
  return std::as_writable_bytes(std::span(values));
}

}  // namespace

struct KeptRows::Head {
  int first_row = 0;
  int rows = 0;
  io::PixelCounts pixels;
  std::size_t cut_codes = 0;
  std::vector<std::uint64_t> bytes;  // of each array
  std::vector<std::uint64_t> checksums;
  std::size_t arrays_offset = 0;  // in the file; not stored
  std::size_t end = 0;

  template <class Archive>
  friend void fields(Archive& a, Head& head) {
    io::PixelCounts& pixels = head.pixels;
    a(head.first_row, head.rows, pixels.pixels, pixels.saturated, pixels.non_finite, pixels.masked_texels,
      pixels.bad_texels, head.cut_codes, head.bytes, head.checksums);
  }
};

void KeptRows::fail(const char* what) const {
  throw io::IoError(io::IoError::Side::kOutput, name_,
                    fmt::format("{}: {}", what, std::generic_category().message(errno)), "a place with room");
}

KeptRows::KeptRows(const std::filesystem::path& file, const std::string& key) : name_(file.string()) {
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("cannot be written");
  struct stat status = {};
  if (fstat(descriptor_, &status) != 0) fail("cannot be read");
  size_ = static_cast<std::size_t>(status.st_size);
  std::string found(key.size(), '\0');
  if (size_ >= key.size()) read_at(0, std::as_writable_bytes(std::span(found)));
  if (found == key) {
    end_ = key.size();
    scan();
  } else {
    size_ = 0;
  }
  if (end_ < size_ || end_ == 0) {
    if (ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) fail("cannot be written");
  }
  if (end_ == 0) {
    write_at(0, std::as_bytes(std::span(key)));
    end_ = key.size();
  }
}

KeptRows::~KeptRows() {
  if (descriptor_ >= 0) close(descriptor_);
}

void KeptRows::read_at(std::size_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail("cannot be read");
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void KeptRows::write_at(std::size_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail("cannot be written");
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

// Whether a whole head is there, whose arrays end within the file.
bool KeptRows::read_head(std::size_t offset, Head& head) const {
  Frame frame;
  if (size_ - offset < sizeof(frame)) return false;
  read_at(offset, std::as_writable_bytes(std::span(&frame, 1)));
  offset += sizeof(frame);
  if (frame.magic != kMagic || frame.head_bytes > size_ - offset) return false;
  std::vector<std::byte> bytes(frame.head_bytes);
  read_at(offset, bytes);
  offset += bytes.size();
  if (io::checksum(bytes) != frame.head_checksum) return false;
  head = {};
  bake::RecordReader reader(bytes);
  reader(head);
  head.arrays_offset = offset;
  for (const std::uint64_t count : head.bytes) {
    if (count > size_ - offset) return false;
    offset += count;
  }
  head.end = offset;
  return head.rows > 0 && head.bytes.size() >= kFixedArrays && head.checksums.size() == head.bytes.size();
}

// Strips up to the first that is not whole.
void KeptRows::scan() {
  Head head;
  std::vector<std::byte> bytes;
  while (read_head(end_, head)) {
    std::size_t offset = head.arrays_offset;
    for (std::size_t k = 0; k < head.bytes.size(); ++k) {
      bytes.resize(head.bytes[k]);
      read_at(offset, bytes);
      if (io::checksum(bytes) != head.checksums[k]) return;
      offset += bytes.size();
    }
    places_[head.first_row] = {head.rows, end_};
    total_ += head.rows;
    end_ = head.end;
  }
}

int KeptRows::rows_at(int first_row) const {
  const auto found = places_.find(first_row);
  return found == places_.end() ? 0 : found->second.rows;
}

int KeptRows::next(int row, int end) const {
  const auto found = places_.lower_bound(row);
  return found == places_.end() ? end : found->first;
}

KeptStrip KeptRows::read(int first_row) const {
  Head head;
  read_head(places_.at(first_row).offset, head);
  KeptStrip strip;
  strip.pixels = head.pixels;
  strip.cut_codes = head.cut_codes;
  AssetRows& rows = strip.rows;
  rows.packed.textures.resize(head.bytes.size() - kFixedArrays);
  std::size_t offset = head.arrays_offset;
  std::size_t k = 0;
  const auto fill = [&](auto& values) {
    const std::span<std::byte> room = room_in(values, head.bytes[k++]);
    read_at(offset, room);
    offset += room.size();
  };
  fill(rows.amplitudes);
  fill(rows.chroma);
  fill(rows.surface.albedo);
  fill(rows.surface.normals);
  fill(rows.confidence);
  fill(rows.packed.mask);
  for (std::vector<std::uint8_t>& texture : rows.packed.textures) fill(texture);
  return strip;
}

void KeptRows::append(int first_row, int rows, const KeptStrip& strip) {
  if (rows <= 0 || places_.contains(first_row))
    throw std::invalid_argument("KeptRows: a strip that is there");
  Head head;
  head.first_row = first_row;
  head.rows = rows;
  head.pixels = strip.pixels;
  head.cut_codes = strip.cut_codes;
  const std::vector<std::span<const std::byte>> arrays = arrays_of(strip.rows);
  for (const std::span<const std::byte> array : arrays) {
    head.bytes.push_back(array.size());
    head.checksums.push_back(io::checksum(array));
  }
  bake::RecordWriter writer;
  writer(head);
  Frame frame;
  frame.head_bytes = writer.bytes().size();
  frame.head_checksum = io::checksum(writer.bytes());
  const std::size_t begin = end_;
  std::size_t offset = begin;
  const auto put = [&](std::span<const std::byte> bytes) {
    write_at(offset, bytes);
    offset += bytes.size();
  };
  put(std::as_bytes(std::span(&frame, 1)));
  put(writer.bytes());
  for (const std::span<const std::byte> array : arrays) put(array);
  places_[first_row] = {rows, begin};
  total_ += rows;
  end_ = size_ = offset;
}

std::size_t KeptRows::bytes_of(const KeptStrip& strip) {
  std::size_t bytes = 0;
  for (const std::span<const std::byte> array : arrays_of(strip.rows)) bytes += array.size();
  return bytes;
}

}  // namespace brdfit::cli
