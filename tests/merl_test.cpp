// MERL files: every kind of damage with its message, and round trips.
#include "io/merl.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::read_text;
using tests::TempFolder;
using tests::write_text;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string header(std::int32_t n_theta_h, std::int32_t n_theta_d, std::int32_t n_phi_d) {
  return bytes_of<std::int32_t>({n_theta_h, n_theta_d, n_phi_d});
}

// A file of 2 x 3 x 4 cells, all 150 (f = 0.1, 0.115, 0.166), but for what a test changes.
struct SmallFile {
  std::vector<double> values = std::vector<double>(std::size_t{3} * 24, 150.0);
  std::string bytes() const { return header(2, 3, 4) + bytes_of(values); }
};

class MerlTest : public testing::Test {
 protected:
  // What read_merl says of a file with these bytes, without the file's name.
  std::string complaint(const std::string& bytes, bool lenient = false) const {
    write_text(file_, bytes);
    return complaint_about_file(lenient);
  }

  std::string complaint_about_file(bool lenient = false) const {
    try {
      read_merl(file_, {CellAnchor::kLowerEdge, lenient});
    } catch (const IoError& error) {
      EXPECT_EQ(error.side(), IoError::Side::kInput);
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_EQ(message.substr(0, file_.string().size() + 2), file_.string() + ": ");
      return message.substr(file_.string().size() + 2);
    }
    return "no error";
  }

  TempFolder folder_;
  std::filesystem::path file_ = folder_ / "a.binary";
};

const std::string kWhatMerlIs =
    " (expected a MERL .binary file: three int32 dimensions, then three planes of float64); copy it again "
    "from its "
    "source";
const std::string kDamaged = "; the header is damaged, or this is no MERL .binary file";

TEST_F(MerlTest, AnEmptyFileIsRefused) {
  EXPECT_EQ(complaint(""), "the file is empty" + kWhatMerlIs);
}

TEST_F(MerlTest, AShortHeaderIsRefused) {
  for (std::size_t size = 1; size < 12; ++size) {
    EXPECT_EQ(complaint(header(2, 3, 4).substr(0, size)),
              std::to_string(size) + " bytes, less than a header of 12" + kWhatMerlIs);
  }
}

TEST_F(MerlTest, DimensionsThatAreNotPositiveAreRefused) {
  const std::string planes = bytes_of(SmallFile().values);
  const std::string tail = " (expected three positive numbers)" + kDamaged;
  EXPECT_EQ(complaint(header(0, 3, 4) + planes), "dimensions 0 x 3 x 4" + tail);
  EXPECT_EQ(complaint(header(2, 3, 0)), "dimensions 2 x 3 x 0" + tail);
  EXPECT_EQ(complaint(header(-2, -3, 4) + planes), "dimensions -2 x -3 x 4" + tail);
  EXPECT_EQ(complaint(header(std::numeric_limits<std::int32_t>::min(), 3, 4)),
            "dimensions -2147483648 x 3 x 4" + tail);
}

TEST_F(MerlTest, DimensionsWhoseProductOverflowsAreRefused) {
  const std::string tail =
      ", more cells than any file can hold (expected dimensions like 90 x 90 x 180)" + kDamaged;
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(complaint(header(most, most, most)), "dimensions 2147483647 x 2147483647 x 2147483647" + tail);
  // 2^64 cells, so that a careless product is 0 and asks for the 12 bytes that there are.
  const std::int32_t large = 1 << 30;
  EXPECT_EQ(complaint(header(large, large, 17)), "dimensions 1073741824 x 1073741824 x 17" + tail);
  EXPECT_EQ(complaint(header(large, large, 1 << 4)), "dimensions 1073741824 x 1073741824 x 16" + tail);
}

TEST_F(MerlTest, LargeDimensionsWithoutTheirPlanesAreRefusedWithoutMemory) {
  EXPECT_EQ(
      complaint(header(60000, 60000, 60000)),
      "truncated: 12 bytes (expected 5184000000000012 bytes for dimensions 60000 x 60000 x 60000); copy it "
      "again from its source");
}

TEST_F(MerlTest, TruncatedPlanesAreRefused) {
  const std::string whole = SmallFile().bytes();
  for (const std::size_t size : {whole.size() - 1, whole.size() - 8, whole.size() / 2, std::size_t{12}}) {
    EXPECT_EQ(complaint(whole.substr(0, size)),
              "truncated: " + std::to_string(size) +
                  " bytes (expected 588 bytes for dimensions 2 x 3 x 4); copy it again from its source");
  }
}

TEST_F(MerlTest, TrailingBytesAreRefused) {
  const std::string tail = " bytes (expected 588 bytes for dimensions 2 x 3 x 4)" + kDamaged;
  EXPECT_EQ(complaint(SmallFile().bytes() + "x"), "trailing bytes: 589" + tail);
  EXPECT_EQ(complaint(SmallFile().bytes() + std::string(8, '\0')), "trailing bytes: 596" + tail);
}

TEST_F(MerlTest, ABigEndianFileIsRecognised) {
  std::string bytes = SmallFile().bytes();
  for (std::size_t at = 0; at < 12; at += 4) std::reverse(&bytes[at], &bytes[at] + 4);
  for (std::size_t at = 12; at < bytes.size(); at += 8) std::reverse(&bytes[at], &bytes[at] + 8);
  EXPECT_EQ(complaint(bytes),
            "big-endian dimensions 2 x 3 x 4 (expected a little-endian file); swap the bytes of every number "
            "in it");
}

TEST_F(MerlTest, NumbersThatAreNotFiniteAreRefusedWithTheirPlace) {
  const auto complaint_with = [this](double odd, std::size_t at) {
    SmallFile file;
    file.values[at] = odd;
    return complaint(file.bytes());
  };
  const auto message = [](const std::string& what) {
    return "1 of 72 values are not finite, the first is " + what +
           " (expected finite single-precision numbers); repair the file, or take them as not measured with "
           "--lenient";
  };
  EXPECT_EQ(complaint_with(kNan, 0), message("nan in the red plane at theta_h 0, theta_d 0, phi_d 0"));
  EXPECT_EQ(complaint_with(kInfinity, 24 + 12),
            message("inf in the green plane at theta_h 1, theta_d 0, phi_d 0"));
  EXPECT_EQ(complaint_with(-kInfinity, 71),
            message("-inf in the blue plane at theta_h 1, theta_d 2, phi_d 3"));
  EXPECT_EQ(complaint_with(1e300, 71), message("1e+300 in the blue plane at theta_h 1, theta_d 2, phi_d 3"));
}

TEST_F(MerlTest, NumbersThatAreNotFiniteAreCountedAndTheFirstIsNamed) {
  SmallFile file;
  for (const std::size_t at : {70U, 30U, 25U, 50U}) file.values[at] = kNan;
  EXPECT_THAT(
      complaint(file.bytes()),
      HasSubstr("4 of 72 values are not finite, the first is nan in the green plane at theta_h 0, theta_d "
                "0, phi_d 1"));
}

TEST_F(MerlTest, LenientTakesNumbersThatAreNotFiniteAsNotMeasured) {
  SmallFile file;
  file.values[3] = kNan;
  file.values[24 + 3] = kInfinity;
  file.values[48 + 5] = -kInfinity;
  file.values[48 + 6] = 1e300;
  file.values[7] = -1.0;
  write_text(file_, file.bytes());
  MerlReadReport report;
  const MeasuredTable table = read_merl(file_, {CellAnchor::kLowerEdge, true}, &report);
  EXPECT_EQ(report.non_finite_values, 4U);
  EXPECT_EQ(report.invalid_cells, 4U);
  EXPECT_EQ(report.cells, 24U);
  EXPECT_EQ(report.file_bytes, 588U);
  for (std::size_t cell = 0; cell < 24; ++cell) {
    EXPECT_EQ(table.is_valid(cell), cell != 3 && cell != 5 && cell != 6 && cell != 7);
  }
}

TEST_F(MerlTest, ATableWithoutAnyMeasurementIsRefused) {
  SmallFile file;
  // Each cell lacks one of its channels.
  for (std::size_t cell = 0; cell < 24; ++cell) file.values[cell + cell % 3 * 24] = -1.0;
  const std::string expected =
      "none of its 24 cells holds a measurement (expected values that are not negative); there is nothing to "
      "fit in "
      "this file";
  EXPECT_EQ(complaint(file.bytes()), expected);
  std::fill(file.values.begin(), file.values.end(), kNan);
  EXPECT_EQ(complaint(file.bytes(), true), expected);
}

TEST_F(MerlTest, ADirectoryAPipeAndNothingAreRefused) {
  EXPECT_EQ(complaint_about_file(), "no such file (expected a MERL .binary file); check the name");
  std::filesystem::create_directory(file_);
  EXPECT_EQ(complaint_about_file(), "is a directory (expected a MERL .binary file); name a file in it");
  std::filesystem::remove(file_);
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_EQ(complaint_about_file(),
            "is not a regular file (expected a MERL .binary file); copy it to a file first");
}

// Root may read everything: the test gives that up for a while.
class WithoutRoot {
 public:
  WithoutRoot() {
    constexpr uid_t kNobody = 65534;
    if (geteuid() == 0 && seteuid(kNobody) != 0) throw std::runtime_error("root cannot be given up");
  }
  WithoutRoot(const WithoutRoot&) = delete;
  WithoutRoot& operator=(const WithoutRoot&) = delete;
  ~WithoutRoot() {
    if (getuid() == 0 && seteuid(0) != 0) std::abort();
  }
};

TEST_F(MerlTest, AFileWithoutReadPermissionIsRefused) {
  ASSERT_EQ(chmod(folder_.path().c_str(), 0755), 0);
  write_text(file_, SmallFile().bytes());
  for (const mode_t mode : {0644, 0}) {
    ASSERT_EQ(chmod(file_.c_str(), mode), 0);
    const WithoutRoot without_root;
    // With permission it is read: nothing else is in the way.
    EXPECT_EQ(complaint_about_file(), mode != 0
                                          ? "no error"
                                          : "cannot be opened: Permission denied (expected a file that can "
                                            "be read); check its permissions");
  }
}

TEST_F(MerlTest, NoMixOfHeaderAndLengthCrashes) {
  std::mt19937 random(13);
  const std::string sound = SmallFile().bytes();
  for (int k = 0; k < 500; ++k) {
    std::string bytes = sound.substr(0, random() % 2 == 0 ? sound.size() : random() % sound.size());
    for (unsigned int changes = random() % 4; changes > 0 && !bytes.empty(); --changes) {
      bytes[random() % std::min<std::size_t>(bytes.size(), 24)] = static_cast<char>(random() % 256);
    }
    write_text(file_, bytes);
    try {
      EXPECT_GT(read_merl(file_).valid_count(), 0U);
      EXPECT_EQ(bytes.size(), sound.size());
    } catch (const IoError& error) {
      EXPECT_NE(error.found(), "");
    }
  }
}

TEST_F(MerlTest, ValuesAreScaledByChannel) {
  write_text(file_, SmallFile().bytes());
  MerlReadReport report;
  const MeasuredTable table = read_merl(file_, {}, &report);
  const Rgb f = table.value(17);
  EXPECT_FLOAT_EQ(static_cast<float>(f[0]), 0.1F);
  EXPECT_FLOAT_EQ(static_cast<float>(f[1]), 0.115F);
  EXPECT_FLOAT_EQ(static_cast<float>(f[2]), 0.166F);
  EXPECT_EQ(report.invalid_cells, 0U);
  EXPECT_EQ(report.non_finite_values, 0U);
}

TEST_F(MerlTest, NegativeIsNotMeasuredHoweverSmallOrLargeAndZeroIsMeasured) {
  SmallFile file;
  const std::vector<double> negative = {-1.0, -1e-320, -1e-60, -1e300, -std::numeric_limits<double>::max()};
  std::copy(negative.begin(), negative.end(), file.values.begin());
  file.values[5] = 0.0;
  file.values[6] = -0.0;
  file.values[7] = 1e-320;
  write_text(file_, file.bytes());
  const MeasuredTable table = read_merl(file_);
  for (std::size_t cell = 0; cell < 24; ++cell) EXPECT_EQ(table.is_valid(cell), cell >= negative.size());
  for (const std::size_t cell : {5U, 6U, 7U}) EXPECT_EQ(table.value(cell)[0], 0.0);
}

TEST_F(MerlTest, TheGridIsThatOfTheHeaderAndTheAnchorThatOfTheOptions) {
  write_text(file_, SmallFile().bytes());
  EXPECT_EQ(read_merl(file_).grid(), (Grid{2, 3, 4, CellAnchor::kLowerEdge}));
  EXPECT_EQ(read_merl(file_, {CellAnchor::kCentre, false}).grid(), (Grid{2, 3, 4, CellAnchor::kCentre}));
}

TEST_F(MerlTest, PlacesInTheFileAreThoseOfTheFormat) {
  SmallFile file;
  for (std::size_t k = 0; k < file.values.size(); ++k) file.values[k] = static_cast<double>(k) * 1500.0;
  write_text(file_, file.bytes());
  const MeasuredTable table = read_merl(file_);
  const std::size_t cell = (1 * 3 + 2) * 4 + 3;
  EXPECT_EQ(table.grid().index(1, 2, 3), cell);
  EXPECT_FLOAT_EQ(static_cast<float>(table.value(cell)[0]), 23.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(table.value(cell)[1]), 47.0F * 1.15F);
  EXPECT_FLOAT_EQ(static_cast<float>(table.value(cell)[2]), 71.0F * 1.66F);
}

// Floats of every size, and cells that are not measured.
MeasuredTable random_table(const Grid& grid) {
  std::mt19937 random(14);
  const std::size_t cells = grid.cell_count();
  std::vector<float> planes(3 * cells);
  for (float& f : planes) {
    const int exponent = static_cast<int>(random() % 60) - 40;
    f = std::ldexp(1.0F + static_cast<float>(random() % 8388608) / 8388608.0F, exponent);
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (random() % 3 == 0) planes[cell] = planes[cell + cells] = planes[cell + 2 * cells] = -1.0F;
  }
  return {grid, std::move(planes)};
}

TEST_F(MerlTest, TablesOfAnySizeSurviveBitForBit) {
  for (const Grid& grid : {Grid{1, 1, 1}, Grid{2, 3, 4}, Grid{13, 7, 361}, Grid{90, 90, 180}}) {
    const MeasuredTable table = random_table(grid);
    if (table.valid_count() == 0) continue;
    write_merl(file_, table);
    EXPECT_EQ(std::filesystem::file_size(file_), 12 + 24 * grid.cell_count());
    MerlReadReport report;
    const MeasuredTable back = read_merl(file_, {}, &report);
    EXPECT_EQ(back.grid(), grid);
    EXPECT_EQ(back.valid_count(), table.valid_count());
    EXPECT_EQ(report.invalid_cells, grid.cell_count() - table.valid_count());
    for (int c = 0; c < 3; ++c) {
      EXPECT_TRUE(std::equal(back.plane(c).begin(), back.plane(c).end(), table.plane(c).begin()));
    }
  }
  EXPECT_THAT(folder_.names(), ElementsAre("a.binary"));
}

TEST_F(MerlTest, NumbersThatAreNotFiniteAreFoundInEveryPieceOfALargeFile) {
  const Grid grid{30, 40, 50};
  write_merl(file_, random_table(grid));
  const std::string sound = read_text(file_);
  for (std::size_t at = 5; at < 3 * grid.cell_count(); at += 9973) {
    std::string bytes = sound;
    std::memcpy(&bytes[12 + 8 * at], &kNan, 8);
    EXPECT_THAT(complaint(bytes), HasSubstr("1 of 180000 values are not finite"));
  }
}

TEST_F(MerlTest, WritesDoublePrecisionOncePerCell) {
  const Grid grid{3, 4, 5};
  std::vector<std::atomic<int>> calls(grid.cell_count());
  write_merl(file_, grid, [&](int h, int d, int p) {
    ++calls[grid.index(h, d, p)];
    const double f = h == 2 && p == 0 ? -0.5 : (1.0 + h + 0.1 * d + 0.01 * p) / 1500.0;
    return Rgb{f, std::abs(f), std::abs(f)};
  });
  for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  const std::string bytes = read_text(file_);
  ASSERT_EQ(bytes.size(), 12 + 24 * grid.cell_count());
  const auto stored = [&](std::size_t at) {
    double value = 0.0;
    std::memcpy(&value, &bytes[12 + 8 * at], 8);
    return value;
  };
  EXPECT_DOUBLE_EQ(stored(grid.index(1, 2, 3)), 2.23);
  EXPECT_DOUBLE_EQ(stored(grid.cell_count() + grid.index(1, 2, 3)), 2.23 / 1.15);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(stored(c * grid.cell_count() + grid.index(2, 2, 0)), -1.0);
}

TEST_F(MerlTest, WritingWhatIsNotFiniteFailsAndLeavesNothing) {
  for (const double odd : {kNan, kInfinity, -kInfinity}) {
    EXPECT_THROW(write_merl(file_, Grid{3, 4, 5},
                            [&](int h, int, int) {
                              return Rgb{0.1, h == 2 ? odd : 0.1, 0.1};
                            }),
                 std::invalid_argument);
  }
  EXPECT_THROW(write_merl(file_, Grid{3, 0, 5}, [](int, int, int) { return Rgb{}; }), std::invalid_argument);
  EXPECT_THAT(folder_.names(), IsEmpty());
}

TEST_F(MerlTest, WritingNowhereFailsBeforeTheWork) {
  int calls = 0;
  EXPECT_THROW(write_merl(folder_ / "none/a.binary", Grid{1, 1, 1},
                          [&](int, int, int) {
                            ++calls;
                            return Rgb{};
                          }),
               IoError);
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace brdfit::io
