// A progress bar on stderr, for people at a terminal. Silent where stderr is none.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace nephele {

/// One bar for one job of `total` units. advance() may be called from any thread; it draws at most ten times
/// a second. The destructor clears the line.
class Progress {
 public:
  Progress(std::string label, uint64_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance(uint64_t units = 1);

 private:
  void draw(uint64_t done);
  std::string label_;
  uint64_t total_;
  bool enabled_;
  std::atomic<uint64_t> done_{0};
  std::atomic<int64_t> nextDrawMs_{0};
  std::chrono::steady_clock::time_point start_;
  std::mutex drawing_;
};

}  // namespace nephele
