// How fast pictures follow each other while things move. Plain arithmetic on a clock's seconds; knows no
// window.
#pragma once

#include <cstddef>
#include <vector>

namespace nephele {

/// A run of frames ends where none was shown for kLongestPause: what came between was rest.
class FramePace {
 public:
  static constexpr double kLongestPause = 0.25;  // seconds

  /// A picture of something that moves was shown at this time.
  void shown(double seconds);
  /// Frames of the last run, and how many of them a second; 0 where it has less than two.
  unsigned frames() const { return frames_; }
  double perSecond() const;
  /// The middle one of its times between two frames, in seconds; 0 where there is none.
  double medianSeconds() const;

 private:
  unsigned frames_ = 0;
  double first_ = 0.0, last_ = 0.0;
  std::vector<double> between_;  // the newest kKept, the oldest written over
  static constexpr size_t kKept = 1024;
};

}  // namespace nephele
