// What is done with an input of each format, by the fuzzers and by the test that replays their corpora.
//
// A harness writes the input to a file, reads it as the program does, and asks for one of two ends: the
// reader refuses it with an IoError of one plain line, or what was read is valid, finite, and comes back
// unchanged when it is written and read again. Anything else is thrown out of the harness.
#ifndef BRDFIT_TESTS_FUZZ_HARNESS_H_
#define BRDFIT_TESTS_FUZZ_HARNESS_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "brdf/vec3.h"
#include "io/error.h"
#include "tests/temp_folder.h"

namespace brdfit::fuzz {

using Bytes = std::span<const std::uint8_t>;

// Each returns whether the input was accepted.
bool run_light_file(Bytes input);
bool run_material(Bytes input);
bool run_merl(Bytes input);
bool run_olat(Bytes input);
bool run_realis(Bytes input);
bool run_recipe(Bytes input);
bool run_stack_recipe(Bytes input);

struct Harness {
  std::string_view name;  // that of its fuzzer, and of its folder of inputs
  bool (*run)(Bytes input);
};
inline constexpr std::array<Harness, 7> kHarnesses{{{"light_file", run_light_file},
                                                    {"material", run_material},
                                                    {"merl", run_merl},
                                                    {"olat", run_olat},
                                                    {"realis", run_realis},
                                                    {"recipe", run_recipe},
                                                    {"stack_recipe", run_stack_recipe}}};

// Thrown where an input breaks what a reader promises.
struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& promise) {
  if (!holds) throw Broken("not so: " + promise);
}

bool is_finite(const Vec3& v);
bool is_unit(const Vec3& v);

// A refusal must be of the input's side, short, and fit for one line of a terminal.
void require_plain(const io::IoError& error);

void write_input(const std::filesystem::path& file, Bytes input);

// What read() gives, or nothing where it refuses the input as it should.
template <class Read>
std::optional<std::invoke_result_t<Read>> read_unless_refused(const Read& read) {
  try {
    return read();
  } catch (const io::IoError& error) {
    require_plain(error);
    return std::nullopt;
  }
}

// The harness of JSON files whose values compare: read, check(value), write, read again.
template <class Read, class Check, class Write>
bool run_json(Bytes input, const Read& read, const Check& check, const Write& write) {
  static const tests::TempFolder folder;
  const std::filesystem::path file = folder / "input.json";
  write_input(file, input);
  const auto value = read_unless_refused([&] { return read(file); });
  if (!value) return false;
  check(*value);
  const std::filesystem::path again = folder / "again.json";
  write(again, *value);
  require(read(again) == *value, "what is written comes back unchanged");
  return true;
}

}  // namespace brdfit::fuzz

#endif  // BRDFIT_TESTS_FUZZ_HARNESS_H_
