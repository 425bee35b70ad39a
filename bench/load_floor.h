// The floor of loading a MERL file: reading its bytes and converting them to float.
#ifndef BRDFIT_BENCH_LOAD_FLOOR_H_
#define BRDFIT_BENCH_LOAD_FLOOR_H_

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace brdfit::bench {

// A place in the folder for temporary files, whose file is removed in the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / (name + "-" + std::to_string(getpid()))) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Reads and converts a file of a 90 x 90 x 180 table.
class LoadFloor {
 public:
  explicit LoadFloor(std::filesystem::path path) : path_(std::move(path)) {}

  // Into buffers that live on: no page is touched for the first time.
  void run_reused() {
    if (!values_) values_ = std::make_unique<double[]>(kValues);
    if (!f_) f_ = std::make_unique<float[]>(kValues);
    run({values_.get(), kValues}, f_.get());
  }

  void run_fresh() const {
    const auto values = std::make_unique_for_overwrite<double[]>(kValues);
    const auto f = std::make_unique_for_overwrite<float[]>(kValues);
    run({values.get(), kValues}, f.get());
  }

 private:
  static constexpr std::size_t kHeaderBytes = 12;
  static constexpr std::size_t kValues = std::size_t{3} * 90 * 90 * 180;

  void run(std::span<double> values, float* f) const {
    read_bytes(std::as_writable_bytes(values));
    for (std::size_t k = 0; k < values.size(); ++k) f[k] = static_cast<float>(values[k]);
    benchmark::DoNotOptimize(f);
    benchmark::ClobberMemory();
  }

  void read_bytes(std::span<std::byte> bytes) const {
    const int descriptor = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) throw std::runtime_error("the sample file is gone");
    auto offset = static_cast<off_t>(kHeaderBytes);
    while (!bytes.empty()) {
      const ssize_t count = pread(descriptor, bytes.data(), bytes.size(), offset);
      if (count <= 0) throw std::runtime_error("the sample file cannot be read");
      offset += count;
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
    close(descriptor);
  }

  std::filesystem::path path_;
  std::unique_ptr<double[]> values_;
  std::unique_ptr<float[]> f_;
};

template <typename Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace brdfit::bench

#endif  // BRDFIT_BENCH_LOAD_FLOOR_H_
