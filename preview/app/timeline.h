// Time on a sequence: which frame is asked for, which one is shown, when the next is due. No clock, no files,
// no window in here. Depends on nothing.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace nephele {

/// What is known of a frame.
enum class FrameState { pending, ready, bad };

/// Frames are positions from 0. Playing loops, waits for a frame that is still being read, and passes over a
/// bad one after its time. Not thread-safe.
class Timeline {
 public:
  /// What the owner has to do now.
  struct Turn {
    std::optional<int> show;  // this frame has become the one to show
    std::optional<int> bad;   // this one cannot be shown; the picture before stays
  };

  static constexpr double kDefaultFps = 24.0;

  /// `frames` at least 1; `shown` is on the screen already.
  Timeline(int frames, int shown);

  /// More or fewer frames, and where the one on the screen is now. Playing goes on.
  void setFrames(int frames, int shown);
  void play(bool on);
  bool playing() const { return playing_; }
  void setFps(double fps) { fps_ = fps; }  // > 0
  double fps() const { return fps_; }
  /// Asks for a frame, clamped to those there are. Stops playing.
  void seek(int frame);
  /// Asks for the frame `by` further on, round the end. Stops playing.
  void step(int by);
  /// The frame asked for is to be looked up once more: its file has changed.
  void lookAgain() { settled_ = false; }

  /// Call each turn of the loop with the seconds gone by.
  Turn advance(double seconds, const std::function<FrameState(int)>& stateOf);

  int frames() const { return frames_; }
  int position() const { return position_; }  // the frame asked for
  int shown() const { return shown_; }        // the frame on the screen
  /// Whether the frame asked for is neither shown nor known to be bad.
  bool waiting() const { return !settled_; }
  /// Seconds until the next frame is due; nullopt where none is.
  std::optional<double> due() const;
  /// The frames to read, in order of need: the one asked for, then `ahead` more the way that playing goes.
  std::vector<int> wishes(int ahead) const;

 private:
  int wrapped(int frame) const;
  int frames_;
  int position_;
  int shown_;
  bool settled_ = true;
  bool playing_ = false;
  double fps_ = kDefaultFps;
  double clock_ = 0.0;  // since the frame asked for was due
};

}  // namespace nephele
