// Bars and lines.
#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "cli/common.h"

namespace brdfit::cli {
namespace {

constexpr std::size_t kBarWidth = 30;

}  // namespace

Progress::Progress(std::size_t total, bool quiet)
    : total_(total), quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1) {
  if (!quiet_ && is_terminal_ && total_ > 0) draw_bar("");
}

Progress::~Progress() {
  if (!quiet_ && is_terminal_) wipe_bar();
}

void Progress::step(const std::string& what) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (quiet_) return;
  if (is_terminal_) {
    draw_bar(what);
  } else {
    fmt::print(stderr, "[{}/{}] {}\n", done_, total_, what);
  }
}

void Progress::note(const std::string& line) {
  if (!quiet_) error(line);
}

void Progress::error(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (!quiet_ && is_terminal_) wipe_bar();
  fmt::print(stderr, "{}\n", line);
  if (!quiet_ && is_terminal_) draw_bar(last_);
}

void Progress::draw_bar(const std::string& what) {
  last_ = what;
  const std::size_t filled = total_ == 0 ? kBarWidth : kBarWidth * done_ / total_;
  std::string left;
  if (done_ > 0 && done_ < total_) {
    const double seconds =
        watch_.seconds() * static_cast<double>(total_ - done_) / static_cast<double>(done_);
    left = fmt::format("  {:.0f} s left", seconds);
  }
  // A line that is longer than the terminal could not be wiped.
  fmt::print(stderr, "\r\x1b[K[{}{}] {}/{}{}  {}", std::string(filled, '#'),
             std::string(kBarWidth - filled, '.'), done_, total_, left, what.substr(0, 24));
  std::fflush(stderr);
}

void Progress::wipe_bar() {
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
}

void stop_if_interrupted() {
  if (interrupted()) throw std::runtime_error("interrupted; what is written is complete");
}

}  // namespace brdfit::cli
