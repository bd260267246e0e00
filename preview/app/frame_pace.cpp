// Times between frames. Depends on nothing.
#include "preview/app/frame_pace.h"

#include <algorithm>

namespace nephele {

void FramePace::shown(double seconds) {
  if (frames_ == 0 || seconds - last_ > kLongestPause) {
    frames_ = 1;
    first_ = last_ = seconds;
    between_.clear();
    return;
  }
  if (between_.size() < kKept) between_.push_back(0.0);
  between_[(frames_ - 1) % kKept] = seconds - last_;
  last_ = seconds;
  ++frames_;
}

double FramePace::perSecond() const { return last_ > first_ ? (frames_ - 1) / (last_ - first_) : 0.0; }

double FramePace::medianSeconds() const {
  if (between_.empty()) return 0.0;
  std::vector<double> sorted = between_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace nephele
