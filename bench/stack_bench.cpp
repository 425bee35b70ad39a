// What reading a stack of photographs costs, in units of decoding alone in the same run: strips of colours,
// of luminance, a second pass from spilled rows, and OpenImageIO's cache in place of scanlines.
//
//   stack_bench FOLDER [SIDE [LIGHTS [ROUNDS [MEGABYTES]]]]    makes the pictures in FOLDER if it is not
//   there
#include <OpenImageIO/imagecache.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/image_stack_file.h"

namespace brdfit {
namespace {

namespace fs = std::filesystem;

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Bumps under a moving light, with grain as a camera has it, so that a JPEG is no smaller than in life.
void make_picture(const fs::path& file, int side, int light, int lights) {
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * 3);
  const double azimuth = 6.2831853 * light / lights;
  std::uint32_t state = 12345U + static_cast<std::uint32_t>(light);
  std::size_t at = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double slope_x = 0.4 * std::cos(0.07 * x) * std::cos(0.011 * y);
      const double slope_y = 0.4 * std::sin(0.05 * y + 0.01 * x);
      const double cosine = 0.7 - 0.6 * (slope_x * std::cos(azimuth) + slope_y * std::sin(azimuth));
      state = state * 1664525U + 1013904223U;
      const double code = 200.0 * std::clamp(cosine, 0.0, 1.2) + static_cast<double>(state >> 28) - 8.0;
      for (const double tint : {1.0, 0.9, 0.7}) {
        samples[at++] = static_cast<std::uint8_t>(std::clamp(tint * code, 0.0, 255.0));
      }
    }
  }
  io::write_image(file, {side, side, 3, io::SampleType::kUint8, std::as_bytes(std::span(samples))},
                  {.type = io::SampleType::kUint8, .jpeg_quality = 90});
}

void make_stack(const fs::path& folder, int side, int lights) {
  fs::create_directories(folder);
  tbb::parallel_for(0, lights, [&](int light) {
    make_picture(folder / fmt::format("light{:03}.jpg", light), side, light, lights);
  });
  std::ofstream list(folder / "lights.lp");
  list << lights << '\n';
  for (int light = 0; light < lights; ++light) {
    const double azimuth = 6.2831853 * light / lights;
    list << fmt::format("light{:03}.jpg {} {} {}\n", light, 0.6 * std::cos(azimuth), 0.6 * std::sin(azimuth),
                        0.8);
  }
}

std::vector<fs::path> pictures_of(const io::StackSource& source) {
  std::vector<fs::path> files;
  for (const auto& picture : source.pictures) files.push_back(picture.file);
  return files;
}

// Decoding alone: every picture from top to bottom, nothing done with the rows.
void decode(const std::vector<fs::path>& files) {
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t k) {
    io::ImageReader reader(files[k]);
    std::vector<std::byte> rows(16 * reader.header().row_bytes());
    for (int first = 0; first < reader.header().height; first += 16) {
      const int count = std::min(16, reader.header().height - first);
      reader.read_native(
          first, count, std::span(rows).first(static_cast<std::size_t>(count) * reader.header().row_bytes()));
    }
  });
}

// The same strips through OpenImageIO's cache, as 8-bit samples.
void through_cache(const std::vector<fs::path>& files, int side, int strip, float megabytes) {
  OIIO::attribute("threads", 1);
  OIIO::ImageCache* cache = OIIO::ImageCache::create(false);
  cache->attribute("max_memory_MB", megabytes);
  cache->attribute("max_open_files", static_cast<int>(files.size()) + 8);
  cache->attribute("autotile", 64);
  cache->attribute("autoscanline", 1);
  // Opened from several threads at once, files of the cache of OpenImageIO 2.4 fail an assertion now and
  // then.
  for (const fs::path& file : files) {
    OIIO::ImageSpec spec;
    cache->get_imagespec(OIIO::ustring(file.string()), spec);
  }
  for (int first = 0; first < side; first += strip) {
    const int last = std::min(first + strip, side);
    tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t k) {
      std::vector<std::uint8_t> rows(static_cast<std::size_t>((last - first) * side) * 3);
      cache->get_pixels(OIIO::ustring(files[k].string()), 0, 0, 0, side, first, last, 0, 1,
                        OIIO::TypeDesc::UINT8, rows.data());
    });
  }
  OIIO::ImageCache::destroy(cache);
}

void pass(io::FileStack& stack, bool is_luminance, double& sum) {
  const int strip = stack.strip_rows();
  for (int first = 0; first < stack.info().height; first += strip) {
    const int rows = std::min(strip, stack.info().height - first);
    TexelBlock block = is_luminance ? stack.read_luminance(first, rows) : stack.read_rows(first, rows);
    sum += static_cast<double>(block.rgb.back());
    stack.give_back(std::move(block));
  }
}

struct Way {
  std::string name;
  std::function<void()> run;
  std::vector<double> seconds = {};
};

int run(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "stack_bench FOLDER [SIDE [LIGHTS [ROUNDS [MEGABYTES]]]]\n");
    return 2;
  }
  const fs::path folder = argv[1];
  const int side = argc > 2 ? std::atoi(argv[2]) : 2048;
  const int lights = argc > 3 ? std::atoi(argv[3]) : 50;
  const int rounds = argc > 4 ? std::atoi(argv[4]) : 3;
  io::FileStackOptions plain;
  if (argc > 5) plain.memory_bytes = static_cast<std::size_t>(std::atoi(argv[5])) << 20;
  if (!fs::exists(folder / "lights.lp")) make_stack(folder, side, lights);
  const io::StackSource source = io::read_stack_source(folder / "lights.lp");
  const std::vector<fs::path> files = pictures_of(source);
  double sum = 0.0;
  io::FileStackOptions spilling = plain;
  spilling.spill = true;
  spilling.spill_folder = folder;
  std::unique_ptr<io::FileStack> spilled;
  std::vector<std::uint32_t> sample;
  for (std::uint32_t k = 97; k < static_cast<std::uint32_t>(side) * static_cast<std::uint32_t>(side);
       k += 1009) {
    sample.push_back(k);
  }
  std::vector<Way> ways = {
      {"decoding alone", [&] { decode(files); }},
      {"strips of luminance",
       [&] {
         io::FileStack stack(source, plain);
         pass(stack, true, sum);
       }},
      {"strips of colours",
       [&] {
         io::FileStack stack(source, plain);
         pass(stack, false, sum);
       }},
      {"one texel in 1009",
       [&] {
         io::FileStack stack(source, plain);
         sum += stack.read_texels(sample).rgb.back();
       }},
      {"luminance, spilling",
       [&] {
         spilled = std::make_unique<io::FileStack>(source, spilling);
         pass(*spilled, true, sum);
       }},
      {"luminance, from spilled", [&] { pass(*spilled, true, sum); }},
      {"cache of OpenImageIO", [&] { through_cache(files, side, 64, 192.0F); }},
  };
  for (int round = 0; round < rounds; ++round) {
    for (Way& way : ways) {
      const double before = cpu_seconds();
      way.run();
      way.seconds.push_back(cpu_seconds() - before);
      if (round == 0) fmt::print(stderr, "{:26} peak so far {:.0f} MB\n", way.name, peak_mb());
    }
  }
  const double megapixels = static_cast<double>(side) * side * static_cast<double>(files.size()) * 1e-6;
  double unit = 0.0;
  for (Way& way : ways) {
    std::sort(way.seconds.begin(), way.seconds.end());
    const double median = way.seconds[way.seconds.size() / 2];
    if (unit == 0.0) unit = median;
    fmt::print("{:26} {:7.3f} CPU s, {:6.2f} ms per megapixel, {:5.2f} of decoding\n", way.name, median,
               1e3 * median / megapixels, median / unit);
  }
  return sum > 0.0 ? 0 : 1;
}

}  // namespace
}  // namespace brdfit

int main(int argc, char** argv) {
  return brdfit::run(argc, argv);
}
