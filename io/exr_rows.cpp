// Runs of rows through OpenEXR.
#include "io/exr_rows.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "io/atomic_file.h"

namespace brdfit::io {
namespace {

constexpr float kLargestHalf = 65504.0F;

// Where OpenEXR writes to: it goes back to fill in where rows lie. A row comes in four pieces, of which the
// small ones are gathered.
class AtomicStream : public Imf::OStream {
 public:
  explicit AtomicStream(const std::filesystem::path& file) : Imf::OStream(file.c_str()), file_(file) {}
  void write(const char data[], int size) override {
    const auto bytes = std::as_bytes(std::span(data, static_cast<std::size_t>(size)));
    if (bytes.size() < kSmall) {
      gathered_.insert(gathered_.end(), bytes.begin(), bytes.end());
    } else {
      flush();
      file_.write_at(place_, bytes);
    }
    place_ += bytes.size();
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override {
    flush();
    place_ = place;
  }
  void flush() {
    file_.write_at(place_ - gathered_.size(), gathered_);
    gathered_.clear();
  }
  void begin_flush() { file_.begin_flush(); }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t kSmall = 4096;
  AtomicFile file_;
  std::uint64_t place_ = 0;
  std::vector<std::byte> gathered_;
};

void check(int width, int height, const std::vector<std::string>& channels) {
  const std::set<std::string> names(channels.begin(), channels.end());
  if (width <= 0 || height <= 0 || channels.empty() || names.size() != channels.size() ||
      names.contains("")) {
    throw std::invalid_argument("EXR: sizes must be positive and every channel needs a name of its own");
  }
}

Imf::Header header_of(int width, int height, const std::vector<std::string>& channels, ExrDepth depth,
                      const ImageMetadata& metadata, ExrCompression compression) {
  Imf::Header header(width, height);
  header.compression() = compression == ExrCompression::kZip ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
  for (const std::string& name : channels) {
    header.channels().insert(name, Imf::Channel(depth == ExrDepth::kHalf ? Imf::HALF : Imf::FLOAT));
  }
  for (const auto& [name, text] : metadata) {
    header.insert(name == "ImageDescription" ? "comments" : name, Imf::StringAttribute(text));
  }
  return header;
}

// OpenEXR finds row y at base + y * stride, so the base lies before the planes of a later run.
template <class T>
Imf::Slice slice_of(Imf::PixelType type, T* plane, int width, int first_row) {
  const auto stride = static_cast<std::size_t>(width) * sizeof(T);
  char* base = reinterpret_cast<char*>(plane) - static_cast<std::ptrdiff_t>(stride) * first_row;
  return Imf::Slice(type, base, sizeof(T), stride);
}

}  // namespace

struct ExrRowWriter::State {
  State(const std::filesystem::path& path, const Imf::Header& header)
      : file(path), stream(path), output(std::in_place, stream, header, 0) {}
  std::filesystem::path file;
  AtomicStream stream;
  std::optional<Imf::OutputFile> output;
  std::vector<std::string> channels;
  ExrDepth depth = ExrDepth::kFloat;
  int width = 0;
  int height = 0;
  int done = 0;
  std::size_t cut = 0;
  std::vector<half> halves;

  // Values as halves, those beyond the largest cut to it.
  half* to_halves(std::span<const float> planes) {
    halves.resize(planes.size());
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const float inside = std::clamp(planes[k], -kLargestHalf, kLargestHalf);
      if (inside != planes[k]) ++cut;
      halves[k] = half(inside);
    }
    return halves.data();
  }
};

ExrRowWriter::ExrRowWriter(const std::filesystem::path& file, int width, int height,
                           std::vector<std::string> channels, ExrDepth depth, const ImageMetadata& metadata,
                           ExrCompression compression) {
  check(width, height, channels);
  state_ = std::make_unique<State>(file, header_of(width, height, channels, depth, metadata, compression));
  state_->channels = std::move(channels);
  state_->depth = depth;
  state_->width = width;
  state_->height = height;
}

ExrRowWriter::~ExrRowWriter() = default;

void ExrRowWriter::write(std::span<const float> planes, int rows) {
  State& s = *state_;
  const std::size_t plane = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(std::max(rows, 0));
  if (rows < 0 || s.done + rows > s.height || planes.size() != plane * s.channels.size()) {
    throw std::invalid_argument("EXR: rows that the file has no place for");
  }
  if (!std::all_of(planes.begin(), planes.end(), [](float v) { return std::isfinite(v); })) {
    throw std::invalid_argument("EXR: a value is not finite");
  }
  Imf::FrameBuffer frame;
  half* halves = s.depth == ExrDepth::kHalf ? s.to_halves(planes) : nullptr;
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    // OpenEXR reads through a pointer that is not const.
    frame.insert(s.channels[c],
                 halves != nullptr
                     ? slice_of(Imf::HALF, halves + c * plane, s.width, s.done)
                     : slice_of(Imf::FLOAT, const_cast<float*>(planes.data()) + c * plane, s.width, s.done));
  }
  s.output->setFrameBuffer(frame);
  s.output->writePixels(rows);
  s.stream.begin_flush();
  s.done += rows;
}

void ExrRowWriter::commit() {
  if (state_->done != state_->height) throw std::invalid_argument("EXR: rows are missing");
  state_->output.reset();
  state_->stream.commit();
}

std::size_t ExrRowWriter::cut_values() const {
  return state_->cut;
}

struct ExrRowReader::State {
  std::string name;
  std::vector<std::string> channels;
  std::optional<Imf::InputFile> input;
  int width = 0;
  int height = 0;
  int top = 0;
  int left = 0;
};

ExrRowReader::ExrRowReader(const std::filesystem::path& file, std::vector<std::string> channels)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.name = file.string();
  s.channels = std::move(channels);
  try {
    s.input.emplace(file.c_str(), 0);
  } catch (const std::exception& error) {
    throw IoError(IoError::Side::kInput, s.name, fmt::format("cannot be read: {}", error.what()),
                  "an EXR file");
  }
  const Imath::Box2i window = s.input->header().dataWindow();
  s.width = window.max.x - window.min.x + 1;
  s.height = window.max.y - window.min.y + 1;
  s.left = window.min.x;
  s.top = window.min.y;
  for (const std::string& name : s.channels) {
    if (s.input->header().channels().findChannel(name) == nullptr) {
      throw IoError(IoError::Side::kInput, s.name, fmt::format("has no channel \"{}\"", name),
                    fmt::format("channels {}", fmt::join(s.channels, ", ")));
    }
  }
}

ExrRowReader::~ExrRowReader() = default;

int ExrRowReader::width() const {
  return state_->width;
}
int ExrRowReader::height() const {
  return state_->height;
}

std::vector<float> ExrRowReader::read(int first_row, int rows) {
  State& s = *state_;
  if (first_row < 0 || rows < 0 || first_row + rows > s.height)
    throw std::invalid_argument("EXR: rows outside");
  const std::size_t plane = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(rows);
  std::vector<float> planes(plane * s.channels.size());
  if (planes.empty()) return planes;
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    frame.insert(s.channels[c],
                 slice_of(Imf::FLOAT, planes.data() + c * plane - s.left, s.width, s.top + first_row));
  }
  try {
    s.input->setFrameBuffer(frame);
    s.input->readPixels(s.top + first_row, s.top + first_row + rows - 1);
  } catch (const std::exception& error) {
    throw IoError(IoError::Side::kInput, s.name, fmt::format("is damaged: {}", error.what()),
                  "a whole EXR file");
  }
  if (!std::all_of(planes.begin(), planes.end(), [](float v) { return std::isfinite(v); })) {
    throw IoError(IoError::Side::kInput, s.name, "holds a value that is not finite", "finite values");
  }
  return planes;
}

}  // namespace brdfit::io
