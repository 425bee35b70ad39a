// MERL .binary files.
#include "io/merl.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {
namespace {

void check_value(const Rgb& value) {
  require(std::all_of(value.begin(), value.end(), [](double f) { return std::isfinite(f) && f >= 0.0; }),
          "a valid cell holds finite values that are not negative");
}

void check(const MeasuredTable& table, const io::MerlReadReport& report) {
  const std::size_t cells = table.grid().cell_count();
  std::size_t valid = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (!table.is_valid(cell)) continue;
    ++valid;
    check_value(table.value(cell));
  }
  require(valid > 0 && valid == table.valid_count(), "valid cells are counted");
  require(report.cells == cells && report.invalid_cells == cells - valid, "the report counts cells");
  require(std::isfinite(table.largest()), "the largest value is finite");
  constexpr double kQuarter = std::numbers::pi / 4.0;
  for (const HalfDiff& angles : {HalfDiff{0.0, 0.0, 0.0}, HalfDiff{kQuarter, kQuarter, kQuarter},
                                 HalfDiff{2.0 * kQuarter, 2.0 * kQuarter, 3.9 * kQuarter}}) {
    if (const auto value = table.interpolate(angles)) check_value(*value);
  }
}

void require_same(const MeasuredTable& a, const MeasuredTable& b) {
  require(a.grid() == b.grid() && a.valid_count() == b.valid_count(), "grid and validity come back");
  for (std::size_t cell = 0; cell < a.grid().cell_count(); ++cell) {
    require(a.is_valid(cell) == b.is_valid(cell), "a cell stays valid or not");
    require(!a.is_valid(cell) || a.value(cell) == b.value(cell), "a value comes back unchanged");
  }
}

}  // namespace

bool run_merl(Bytes input) {
  static const tests::TempFolder folder;
  const std::filesystem::path file = folder / "input.binary";
  write_input(file, input);
  bool is_accepted = false;
  for (const bool lenient : {false, true}) {
    io::MerlReadReport report;
    const auto table = read_unless_refused([&] {
      return io::read_merl(file, {CellAnchor::kLowerEdge, lenient}, &report);
    });
    if (!table) continue;
    is_accepted = true;
    require(lenient || report.non_finite_values == 0, "what is not finite is refused unless lenient");
    check(*table, report);
    const std::filesystem::path again = folder / "again.binary";
    io::write_merl(again, *table);
    require_same(*table, io::read_merl(again));
  }
  return is_accepted;
}

}  // namespace brdfit::fuzz
