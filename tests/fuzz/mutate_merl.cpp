// Mutations of MERL files: most inputs get a header and a length that agree, which chance would not find.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  constexpr std::size_t kCellBytes = 3 * sizeof(double);
  size = LLVMFuzzerMutate(data, size, max_size);
  std::array<std::int32_t, 3> header = {};
  if (seed % 4 == 0 || max_size < sizeof(header) + 64 * kCellBytes) return size;
  std::minstd_rand random(seed);
  for (std::int32_t& n : header) n = std::uniform_int_distribution<std::int32_t>(1, 4)(random);
  std::memcpy(data, header.data(), sizeof(header));
  const std::size_t wanted =
      sizeof(header) + kCellBytes * static_cast<std::size_t>(header[0] * header[1] * header[2]);
  if (size < wanted) std::fill(data + std::max(size, sizeof(header)), data + wanted, std::uint8_t{0});
  return wanted;
}
