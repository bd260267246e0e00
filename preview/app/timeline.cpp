// Playing, seeking, stepping. Depends on base alone.
#include "preview/app/timeline.h"

#include <algorithm>

#include "base/error.h"

namespace nephele {

Timeline::Timeline(int frames, int shown) : frames_(frames), position_(shown), shown_(shown) {
  NEPHELE_CHECK_GT(frames, 0);
  NEPHELE_CHECK_LT(shown, frames);
}

void Timeline::setFrames(int frames, int shown) {
  NEPHELE_CHECK_GT(frames, 0);
  NEPHELE_CHECK_LT(shown, frames);
  if (settled_) position_ = shown;
  frames_ = frames;
  shown_ = shown;
  position_ = std::min(position_, frames - 1);
}

void Timeline::play(bool on) {
  playing_ = on && frames_ > 1;
  clock_ = 0.0;
}

void Timeline::seek(int frame) {
  playing_ = false;
  const int wanted = std::clamp(frame, 0, frames_ - 1);
  if (wanted == position_) return;
  position_ = wanted;
  settled_ = false;
}

void Timeline::step(int by) { seek(wrapped(position_ + by)); }

int Timeline::wrapped(int frame) const { return ((frame % frames_) + frames_) % frames_; }

Timeline::Turn Timeline::advance(double seconds, const std::function<FrameState(int)>& stateOf) {
  if (playing_) {
    clock_ += seconds;
    const double period = 1.0 / fps_;
    // At most one frame's time is carried over: after a long wait nothing is rushed.
    if (!settled_) clock_ = std::min(clock_, period);
    if (settled_ && clock_ >= period) {
      clock_ = std::min(clock_ - period, period);
      position_ = wrapped(position_ + 1);
      settled_ = false;
    }
  }
  if (settled_) return {};
  const FrameState state = stateOf(position_);
  if (state == FrameState::pending) return {};
  settled_ = true;
  if (state == FrameState::bad) return {std::nullopt, position_};
  shown_ = position_;
  return {position_, std::nullopt};
}

std::optional<double> Timeline::due() const {
  if (!playing_ || !settled_) return std::nullopt;
  return std::max(0.0, 1.0 / fps_ - clock_);
}

std::vector<int> Timeline::wishes(int ahead) const {
  std::vector<int> wishes{position_};
  for (int i = 1; i <= ahead && i < frames_; ++i) wishes.push_back(wrapped(position_ + i));
  return wishes;
}

}  // namespace nephele
