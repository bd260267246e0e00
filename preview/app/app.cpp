// The window's loop: hands move the camera, files come and go, the viewer draws, the panel lies on top, and
// at rest everything sleeps. Depends on all of preview and volume.
#include "preview/app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "preview/app/desk.h"
#include "preview/app/heap.h"
#include "preview/app/panel.h"
#include "preview/app/window.h"
#include "preview/temperature.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kWorkSeconds = 0.03;   // of drawing between two looks at the hands
constexpr double kLookSeconds = 0.5;    // between two looks at the files; also the longest sleep
constexpr double kRedrawSeconds = 0.1;  // between two looks of the user at a picture that gets better
constexpr int kFramesAfterEvent = 3;    // the panel needs a few to settle its hover and sizes
constexpr uint64_t kReadAheadBytes = uint64_t{2} << 30;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

class App {
 public:
  explicit App(const AppOptions& options)
      : first_(openFirst(options.render)),
        window_(options.width, options.height, "Nephele"),
        reader_(readVolume, Window::wake, kReadAheadBytes),
        desk_(options, first_, window_, reader_) {
    panel_.emplace(window_.handle());
  }

  int run() {
    desk_.begin();
    for (int i = 0; i < kFramesAfterEvent; ++i) panel_->build(desk_.state(), desk_.facts());
    while (!window_.closing()) turn();
    desk_.writeStats();
    return kExitDone;
  }

 private:
  static BrickVolume readVolume(const VolumeKey& key) {
    BrickVolume volume = loadBricks(key.path, key.grid);
    Emission emission;
    emission.grid = key.heat;
    addTemperature(volume, emission);
    return volume;
  }

  void turn() {
    const Hands hands = window_.poll(sleepSeconds());
    const Clock::time_point now = Clock::now();
    const double seconds = secondsBetween(std::exchange(lastTurn_, now), now);
    if (hands.any) framesLeft_ = kFramesAfterEvent;
    presses_ += hands.presses;
    desk_.takeHands(hands);
    if (secondsBetween(lastLook_, now) >= kLookSeconds) {
      lastLook_ = now;
      desk_.lookAtFiles();
    }
    const bool moved = desk_.advance(seconds);
    int width = 0, height = 0;
    window_.framebufferSize(width, height);
    if (width < 1 || height < 1) {  // minimised: nothing to draw
      more_ = false;
      framesLeft_ = 0;
      return;
    }
    const bool wasMore = more_;
    more_ = desk_.work(kWorkSeconds);
    const bool finished = wasMore && !more_;
    const bool due = more_ && secondsBetween(lastDrawn_, now) >= kRedrawSeconds;
    if (framesLeft_ > 0 || moved || finished || due) draw(width, height);
  }

  void draw(int width, int height) {
    framesLeft_ = std::max(0, framesLeft_ - 1);
    lastDrawn_ = Clock::now();
    desk_.show(width, height);
    const Settings before = desk_.state().settings;
    const UiWishes wishes = panel_->draw(desk_.state(), desk_.facts());
    desk_.takeWishes(wishes, before, panel_->held());
    if (wishes.settings || wishes.picture) framesLeft_ = kFramesAfterEvent;
    window_.panelWantsMouse = panel_->wantsMouse();
    window_.panelWantsKeys = panel_->wantsKeys();
    window_.swap();
    if (framesLeft_ == 0) desk_.noteShown(presses_);
  }

  double sleepSeconds() const {
    if (more_ || framesLeft_ > 0 || window_.flying()) return 0.0;
    const double toLook = kLookSeconds - secondsBetween(lastLook_, Clock::now());
    return std::clamp(std::min(toLook, desk_.due().value_or(kLookSeconds)), 0.0, kLookSeconds);
  }

  FirstVolume first_;
  Window window_;
  ReadAhead reader_;
  Desk desk_;
  std::optional<Panel> panel_;  // last: goes first, while the context lives
  bool more_ = true;
  int framesLeft_ = kFramesAfterEvent;
  uint64_t presses_ = 0;  // that were taken so far
  Clock::time_point lastTurn_ = Clock::now(), lastLook_ = Clock::now(), lastDrawn_{};
};

}  // namespace

int runApp(const AppOptions& options) {
  keepLargeBlocksApart();
  const int code = App(options).run();
  // Whatever was made on the GPU is gone, or something was leaked.
  NEPHELE_CHECK_EQ(glCounts().made, glCounts().destroyed);
  return code;
}

}  // namespace nephele
