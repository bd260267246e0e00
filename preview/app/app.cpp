// The window's loop: hands move the camera, the viewer draws, the panel lies on top, and at rest everything
// sleeps. Depends on all of preview and volume.
#include "preview/app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>

#include "preview/app/orbit_camera.h"
#include "preview/app/panel.h"
#include "preview/app/window.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

constexpr double kWorkSeconds = 0.03;   // of drawing between two looks at the hands
constexpr double kZoomPerNotch = 0.87;  // of the distance
constexpr int kFramesAfterEvent = 3;    // the panel needs a few to settle its hover and sizes

class App {
 public:
  explicit App(const AppOptions& options)
      : options_(options),
        scene_(openScene(options.render.scene, options.render.stepVoxels)),
        bricks_(openVolume(options.render.file, options.render.grid)),
        window_(options.width, options.height, "Nephele: " + options.render.file),
        orbit_(resolve()) {
    loadGl(reinterpret_cast<GLADloadfunc>(glfwGetProcAddress));
    viewer_.emplace(bricks_, options.render.filter, options.render.seed);
    panel_.emplace(window_.handle());
  }

  int run() {
    restart();
    if (width_ > 0 && height_ > 0) {
      viewer_->work(kWorkSeconds);  // a first coarse picture
      state_.exposureEv = exposureFor(options_.render, viewer_->read());
    }
    bool more = true;
    for (int framesLeft = kFramesAfterEvent; !window_.closing();) {
      const Hands hands = window_.poll(!more && framesLeft == 0);
      if (hands.any) framesLeft = kFramesAfterEvent;
      framesLeft = std::max(0, framesLeft - 1);
      takeHands(hands);
      int width = 0, height = 0;
      window_.framebufferSize(width, height);
      if (width != width_ || height != height_) restart();
      if (width < 1 || height < 1) {  // minimised: nothing to draw
        more = false;
        continue;
      }
      more = viewer_->work(kWorkSeconds);
      if (takeScreenshot_) screenshot();
      viewer_->show(state_.view.scene, state_.exposureEv, width, height);
      if (panel_->draw(state_, viewer_->stats())) {
        restart();
        more = true;
      }
      window_.panelWantsMouse = panel_->wantsMouse();
      window_.panelWantsKeys = panel_->wantsKeys();
      window_.swap();
    }
    return kExitDone;
  }

 private:
  Camera resolve() {
    std::string sentence;
    state_.view = resolveScene(scene_, bricks_, aspect(), sentence);
    state_.up = state_.view.camera.up;
    state_.title = std::filesystem::path(bricks_.path).filename().string() + ", " + bricks_.gridName;
    state_.notice = sentence;
    std::cerr << sentence << '\n' << describeLight(state_.view) << '\n';
    firstCamera_ = state_.view.camera;
    return firstCamera_;
  }

  double aspect() const {
    int width = 0, height = 0;
    window_.framebufferSize(width, height);
    return width > 0 && height > 0 ? static_cast<double>(width) / height : 1.0;
  }

  void restart() {
    window_.framebufferSize(width_, height_);
    state_.view.camera = orbit_.camera();
    if (width_ > 0 && height_ > 0) viewer_->restart(state_.view, width_, height_);
  }

  void takeHands(const Hands& hands) {
    const bool moved = hands.orbitX != 0.0 || hands.orbitY != 0.0 || hands.panX != 0.0 || hands.panY != 0.0 ||
                       hands.scroll != 0.0;
    if (moved) {
      // A drag over the window's whole height is half a turn.
      orbit_.orbit(-std::numbers::pi * hands.orbitX, std::numbers::pi * hands.orbitY);
      orbit_.pan(hands.panX, -hands.panY);
      orbit_.zoom(std::pow(kZoomPerNotch, hands.scroll));
      restart();
    }
    for (int key : hands.keys) takeKey(key);
  }

  void takeKey(int key) {
    switch (key) {
      case GLFW_KEY_ESCAPE:
      case GLFW_KEY_Q:
        window_.close();
        break;
      case GLFW_KEY_F:
        orbit_ = OrbitCamera(frameCamera(bricks_, state_.up, state_.view.camera.fov, aspect()));
        restart();
        break;
      case GLFW_KEY_R:
        orbit_ = OrbitCamera(firstCamera_);
        restart();
        break;
      case GLFW_KEY_L:
        switchLook();
        break;
      case GLFW_KEY_H:
        state_.visible = !state_.visible;
        break;
      case GLFW_KEY_F1:
        state_.help = !state_.help;
        break;
      case GLFW_KEY_F12:
        takeScreenshot_ = true;
        break;
      default:
        break;
    }
  }

  void switchLook() {
    Look& look = state_.view.scene.look;
    look = look == Look::report ? Look::physical : Look::report;
    state_.notice = describeLight(state_.view);
    restart();
  }

  void screenshot() {
    takeScreenshot_ = false;
    std::filesystem::path path;
    for (int number = 1; path.empty() || std::filesystem::exists(path); ++number) {
      constexpr int kDigits = 4;
      std::ostringstream name;
      name << "nephele_" << std::setw(kDigits) << std::setfill('0') << number << ".png";
      path = std::filesystem::path(options_.screenshotFolder) / name.str();
    }
    try {
      writePicture(path.string(), viewer_->read(), state_.view, state_.exposureEv, false);
      state_.notice = "wrote " + path.filename().string();
    } catch (const WorldError& error) {  // a folder that cannot be written must not end the session
      state_.notice = error.what();
    }
    std::cerr << state_.notice << '\n';
  }

  AppOptions options_;
  Scene scene_;
  BrickVolume bricks_;
  Window window_;
  PanelState state_;
  Camera firstCamera_;
  OrbitCamera orbit_;
  std::optional<Viewer> viewer_;
  std::optional<Panel> panel_;  // last: goes first, while the context lives
  int width_ = 0, height_ = 0;
  bool takeScreenshot_ = false;
};

}  // namespace

int runApp(const AppOptions& options) { return App(options).run(); }

}  // namespace nephele
