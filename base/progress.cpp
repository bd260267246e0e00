// Draws the progress bar. Depends on base and POSIX (is stderr a terminal?).
#include "base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace nephele {
namespace {

constexpr int64_t kRedrawMs = 100;
constexpr int kBarCells = 30;
constexpr double kMsPerSecond = 1000.0;

}  // namespace

Progress::Progress(std::string label, uint64_t total, bool quiet)
    : label_(std::move(label)),
      total_(std::max<uint64_t>(total, 1)),
      enabled_(!quiet && ::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  if (enabled_) draw(0);
}

Progress::~Progress() {
  if (enabled_) std::fputs("\r\033[K", stderr);  // back to the line's start, clear to its end
}

void Progress::advance(uint64_t units) {
  const uint64_t done = done_.fetch_add(units, std::memory_order_relaxed) + units;
  if (!enabled_) return;
  const auto elapsed = std::chrono::steady_clock::now() - start_;
  const int64_t nowMs = std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count();
  int64_t due = nextDrawMs_.load(std::memory_order_relaxed);
  // One thread wins the right to draw; the others go on working.
  if (nowMs < due || !nextDrawMs_.compare_exchange_strong(due, nowMs + kRedrawMs)) return;
  draw(done);
}

void Progress::draw(uint64_t done) {
  const std::lock_guard lock(drawing_);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
  const auto elapsed = std::chrono::steady_clock::now() - start_;
  const double seconds =
      static_cast<double>(std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count()) /
      kMsPerSecond;
  const int filled = static_cast<int>(share * kBarCells);
  const std::string bar = std::string(static_cast<size_t>(filled), '#') +
                          std::string(static_cast<size_t>(kBarCells - filled), '.');
  constexpr double kPercent = 100.0;
  std::fprintf(stderr, "\r\033[K%s [%s] %3.0f%% %.1f s", label_.c_str(), bar.c_str(), share * kPercent,
               seconds);
  std::fflush(stderr);
}

}  // namespace nephele
