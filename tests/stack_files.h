// Stacks of tiny photographs on disk, made by a formula, with manifests.
#ifndef BRDFIT_TESTS_STACK_FILES_H_
#define BRDFIT_TESTS_STACK_FILES_H_

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/image_reader.h"
#include "io/json.h"
#include "tests/temp_folder.h"

namespace brdfit::tests {

// Writes a picture of floats in [0, 1], or of any value for half and float.
inline void write_picture(const std::filesystem::path& file, int width, int height, int channels,
                          io::SampleType type, const std::function<float(int x, int y, int c)>& value) {
  std::vector<float> samples;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) samples.push_back(value(x, y, c));
    }
  }
  io::write_image(
      file, {width, height, channels, io::SampleType::kFloat, std::as_bytes(std::span<const float>(samples))},
      {.type = type, .jpeg_quality = 95});
}

inline void write_grey(const std::filesystem::path& file, int width = 4, int height = 3, float level = 0.5F) {
  write_picture(file, width, height, 3, io::SampleType::kUint8, [level](int, int, int) { return level; });
}

// The message of the IoError (kInput) that a call ends in, checked to be one line.
inline std::string input_error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const io::IoError& error) {
    EXPECT_EQ(error.side(), io::IoError::Side::kInput);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}

// A manifest with two directional lights, whose pictures are a.png and b.png.
inline io::Json two_lights() {
  return io::Json::parse(R"({"version": 1, "images": [
      {"file": "b.png", "direction": [0.6, 0, 0.8]},
      {"file": "a.png", "direction": [0, 0, 1]}]})");
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_STACK_FILES_H_
