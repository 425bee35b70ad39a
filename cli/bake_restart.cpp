// Pieces in files of their own, under one key.
#include "cli/bake_restart.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <utility>

#include "bake/plan_record.h"
#include "bake/record.h"
#include "cli/bake_key.h"
#include "io/atomic_file.h"
#include "io/checksum.h"
#include "io/input_file.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyFile = "key.json";
constexpr const char* kLockFile = "lock";
constexpr const char* kPlan = "plan";
constexpr const char* kRanges = "ranges";
constexpr const char* kEvidence = "evidence";
constexpr const char* kRows = "rows";
constexpr const char* kOutputs = "outputs";
constexpr std::string_view kFold = "fold-";

// Of the time of a bake, what keeping strips may take; and what it is thought to take before any was kept.
constexpr double kStripShare = 0.01;
constexpr double kSecondsPerByte = 1e-9;
// So much is kept in any case.
constexpr std::size_t kFreeBytes = std::size_t{8} << 20;

std::vector<std::byte> bytes_of_file(const fs::path& file) {
  const io::InputFile input(file, "a part of a bake");
  std::vector<std::byte> bytes(input.size());
  input.read_at(0, bytes);
  return bytes;
}

std::optional<int> number_of(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// As a file gives it back: names that are not UTF-8 are not the same there.
io::Json as_written(const io::Json& json) {
  return io::Json::parse(json.dump(-1, ' ', false, io::Json::error_handler_t::replace));
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    files.push_back(at->path());
  }
  return files;
}

}  // namespace

// Held while a bake is at work; gone with its process. Says whose it is, as temporaries carry that number.
class BakeRestart::Lock {
 public:
  explicit Lock(const fs::path& folder) {
    const fs::path file = folder / kLockFile;
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw io::IoError(io::IoError::Side::kOutput, file.string(),
                        "cannot be written: " + std::generic_category().message(errno),
                        "a place that can be written to");
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor_);
      throw UsageError("another bake is at work: " + folder.string());
    }
    std::array<char, 32> text{};
    const ssize_t count = pread(descriptor_, text.data(), text.size(), 0);
    if (count > 0) before_ = number_of(std::string_view(text.data(), static_cast<std::size_t>(count)));
    const std::string own = std::to_string(getpid());
    const bool is_written =
        ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, own.data(), own.size(), 0) > 0;
    if (!is_written) before_.reset();
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() { close(descriptor_); }

  // The process that held it before, where it is known.
  std::optional<int> before() const { return before_; }

 private:
  int descriptor_ = -1;
  std::optional<int> before_;
};

BakeRestart::BakeRestart(fs::path folder, const io::Json& key, bool fresh)
    : folder_(std::move(folder)), key_(as_written(key)), key_hash_(io::sha256_of_text(key_.dump())) {
  if (!fs::is_directory(folder_)) return;
  lock_ = std::make_unique<Lock>(folder_);
  remove_left_temporaries();
  if (fresh || !fs::exists(folder_ / kKeyFile)) return;
  try {
    refusal_ = difference_of_keys(key_, io::read_json(folder_ / kKeyFile));
  } catch (const io::IoError&) {
    refusal_ = std::string(kKeyFile) + " is damaged";
  }
  if (refusal_.empty()) take_over();
}

BakeRestart::~BakeRestart() = default;

void BakeRestart::take_over() {
  is_begun_ = true;
  const auto read = [&](const char* name, auto& value, const auto& value_of) {
    const std::optional<std::vector<std::byte>> bytes = piece(name);
    if (!bytes) return;
    try {
      value = value_of(*bytes);
    } catch (const std::exception&) {
      damaged_.emplace_back(name);
    }
  };
  read(kPlan, plan_, bake::plan_of_record);
  read(kRanges, ranges_, bake::ranges_of_record);
  read(kEvidence, evidence_, bake::evidence_of_record);
  outputs_begun_ = piece(kOutputs).has_value();
  for (const fs::path& file : files_of(folder_)) {
    const std::string name = file.filename().string();
    if (!name.starts_with(kFold)) continue;
    const std::optional<int> fold = number_of(std::string_view(name).substr(kFold.size()));
    if (fold && piece(name)) folds_.insert(*fold);
  }
  try {
    if (fs::exists(folder_ / kRows)) rows_ = std::make_unique<KeptRows>(folder_ / kRows, key_hash_);
  } catch (const std::exception&) {
    damaged_.emplace_back(kRows);
  }
}

// What a process that was killed could not remove: the lock is ours, so it is gone.
void BakeRestart::remove_left_temporaries() const {
  const std::optional<int> process = lock_->before();
  if (!process || *process == getpid() || kill(*process, 0) == 0 || errno != ESRCH) return;
  const std::string begin = fmt::format(".brdfit-{}-", *process);
  std::string panels = folder_.filename().string();
  panels.resize(panels.size() - std::string_view(".realis.part").size());
  for (const fs::path& place :
       {folder_, folder_.parent_path(), folder_.parent_path() / (panels + ".panels")}) {
    for (const fs::path& file : files_of(place)) {
      const std::string name = file.filename().string();
      std::error_code error;
      if (name.starts_with(begin) && name.ends_with(".tmp")) fs::remove(file, error);
    }
  }
}

std::string BakeRestart::found(int height, int folds) const {
  std::string text;
  if (!refusal_.empty()) {
    return fmt::format("{} is not of this bake, as {}: beginning anew", folder_.string(), refusal_);
  }
  std::vector<std::string> parts;
  if (plan_) parts.emplace_back("plan");
  if (evidence_) {
    parts.emplace_back("evidence");
  } else if (!folds_.empty()) {
    parts.push_back(fmt::format("{} of {} folds", folds_.size(), folds));
  }
  if (rows_ && rows_->total() > 0) parts.push_back(fmt::format("{} of {} rows", rows_->total(), height));
  if (!parts.empty()) text = fmt::format("continuing: {}", fmt::join(parts, ", "));
  if (!damaged_.empty()) {
    text += fmt::format("{}damaged, so made anew: {}", text.empty() ? "" : "; ", fmt::join(damaged_, ", "));
  }
  return text;
}

std::string BakeRestart::how_to_go_on() const {
  return is_begun_ && !has_failed_ ? fmt::format("the same command goes on from {}", folder_.string())
                                   : std::string("nothing is written");
}

fs::path BakeRestart::fold_file(int fold) const {
  return fmt::format("{}{}", kFold, fold);
}

// A piece: the key, the checksum of what follows, and that.
std::optional<std::vector<std::byte>> BakeRestart::piece(const std::string& name) {
  const fs::path file = folder_ / name;
  if (!fs::exists(file)) return {};
  try {
    std::vector<std::byte> bytes = bytes_of_file(file);
    bake::RecordReader reader(bytes);
    std::string key;
    std::uint64_t sum = 0;
    std::vector<std::byte> content;
    reader(key, sum, content);
    reader.finish();
    if (key == key_hash_ && sum == io::checksum(content)) return content;
  } catch (const std::exception&) {
    // Told with those whose checksum is wrong.
  }
  damaged_.push_back(name);
  return {};
}

void BakeRestart::remove_files() const {
  for (const fs::path& file : files_of(folder_)) {
    const std::string name = file.filename().string();
    bool is_ours = name.starts_with(kFold);
    for (const char* known : {kKeyFile, kPlan, kRanges, kEvidence, kRows, kOutputs}) {
      is_ours = is_ours || name == known;
    }
    std::error_code error;
    if (is_ours) fs::remove(file, error);
  }
}

// Makes the folder this bake's, once.
bool BakeRestart::begin() {
  if (is_begun_ || has_failed_) return is_begun_;
  fs::create_directories(folder_);
  if (!lock_) lock_ = std::make_unique<Lock>(folder_);
  remove_files();
  io::write_json(folder_ / kKeyFile, key_);
  is_begun_ = true;
  return true;
}

void BakeRestart::keep_piece(const std::string& name, const std::function<std::vector<std::byte>()>& record) {
  if (has_failed_) return;
  try {
    begin();
    std::vector<std::byte> content = record();
    std::uint64_t sum = io::checksum(content);
    bake::RecordWriter writer;
    writer(key_hash_, sum, content);
    io::AtomicFile file(folder_ / name);
    file.write(writer.bytes());
    file.commit();
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception&) {
    has_failed_ = true;
  }
}

void BakeRestart::keep_plan(const bake::BakePlan& plan) {
  keep_piece(kPlan, [&] { return bake::plan_record(plan); });
}
void BakeRestart::keep_ranges(const std::vector<RealisRange>& ranges) {
  keep_piece(kRanges, [&] { return bake::ranges_record(ranges); });
}
void BakeRestart::keep_evidence(const bake::Evidence& evidence) {
  keep_piece(kEvidence, [&] { return bake::evidence_record(evidence); });
}
void BakeRestart::keep_fold(int fold, const bake::FoldEvidence& evidence) {
  keep_piece(fold_file(fold), [&] { return bake::fold_record(evidence); });
  if (!has_failed_) folds_.insert(fold);
}
void BakeRestart::keep_outputs_begun() {
  outputs_begun_ = true;
  keep_piece(kOutputs, [] { return std::vector<std::byte>(); });
}

std::optional<bake::FoldEvidence> BakeRestart::fold(int fold) {
  if (!folds_.contains(fold)) return {};
  try {
    if (const auto bytes = piece(fold_file(fold))) return bake::fold_of_record(*bytes);
  } catch (const std::exception&) {
    // Then it is made anew.
  }
  folds_.erase(fold);
  return {};
}

bake::FoldEvidence BakeRestart::fold_of(int fold, const std::function<bake::FoldEvidence()>& make) {
  if (std::optional<bake::FoldEvidence> kept = this->fold(fold)) return std::move(*kept);
  bake::FoldEvidence made = make();
  keep_fold(fold, made);
  return made;
}

// Whether so many bytes more stay within the share, on the wall and of processors.
bool BakeRestart::is_cheap(std::size_t bytes) const {
  if (strip_bytes_ + bytes <= kFreeBytes) return true;
  const TimeTaken all = clocks_.taken();
  const double wanted = static_cast<double>(bytes);
  const auto is_within = [&](double taken, double whole) {
    const double rate = strip_bytes_ > 0 ? taken / static_cast<double>(strip_bytes_) : kSecondsPerByte;
    return taken + rate * wanted <= kStripShare * whole;
  };
  return is_within(strip_time_.wall_seconds, all.wall_seconds) &&
         is_within(strip_time_.cpu_seconds, all.cpu_seconds);
}

void BakeRestart::keep_strip(int row, int rows, const KeptStrip& strip) {
  const std::size_t bytes = KeptRows::bytes_of(strip);
  if (has_failed_ || !is_cheap(bytes)) return;
  const BothClocks clocks(CpuOf::kThread);
  try {
    begin();
    if (!rows_) rows_ = std::make_unique<KeptRows>(folder_ / kRows, key_hash_);
    rows_->append(row, rows, strip);
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception&) {
    has_failed_ = true;
  }
  const TimeTaken taken = clocks.taken();
  strip_time_.wall_seconds += taken.wall_seconds;
  strip_time_.cpu_seconds += taken.cpu_seconds;
  strip_bytes_ += bytes;
}

void BakeRestart::remove() {
  rows_.reset();
  if (!lock_) return;
  remove_files();
  std::error_code error;
  fs::remove(folder_ / kLockFile, error);
  fs::remove(folder_, error);
  lock_.reset();
  is_begun_ = false;
}

}  // namespace brdfit::cli
