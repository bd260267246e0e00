// Keys, drags and the panel's wishes on the desk. Depends on all of preview.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "preview/app/desk.h"
#include "preview/app/scene_file.h"
#include "preview/app/screenshot.h"
#include "preview/app/sun_drag.h"
#include "preview/resolve.h"

namespace nephele {
namespace {

constexpr double kZoomPerNotch = 0.87;   // of the distance
constexpr double kSpeedPerNotch = 1.25;  // of flying
constexpr double kLongestStep = 0.1;     // seconds of flight in one turn: after a pause nothing leaps
constexpr double kDividerMargin = 0.02;  // of the width: it stays within reach

}  // namespace

void Desk::takeHands(const Hands& hands) {
  const double turn = std::numbers::pi;  // a drag over the window's whole height is half a turn
  const bool moved =
      hands.orbit.any() || hands.pan.any() || hands.look.any() || (hands.scroll != 0.0 && !window_.flying());
  if (moved) {
    orbit_.orbit(-turn * hands.orbit.x, turn * hands.orbit.y);
    orbit_.pan(hands.pan.x, -hands.pan.y);
    // The view turns with the hand at the rate of the picture: a height of it is the field of view.
    const double fov = orbit_.camera().fov;
    orbit_.look(-fov * hands.look.x, fov * hands.look.y);
    if (!window_.flying()) orbit_.zoom(std::pow(kZoomPerNotch, hands.scroll));
    restart();
  }
  if (window_.flying()) flySpeed_ *= std::pow(kSpeedPerNotch, hands.scroll);
  if (hands.sun.any()) turnSun(hands.sun);
  if (hands.divider) state_.divider = std::clamp(*hands.divider, kDividerMargin, 1.0 - kDividerMargin);
  if (hands.released) history_.rest();
  if (hands.doubleClick) focus(hands.doubleClick);
  for (const KeyPress& press : hands.keys) takeKey(press);
  for (const std::string& path : hands.drops) takeDrop(path);
  window_.divider = state_.kept ? std::optional(state_.divider) : std::nullopt;
}

void Desk::turnSun(const Drag& drag) {
  for (Light& light : state_.settings.scene.lights) {
    Sun* sun = std::get_if<Sun>(&light);
    if (sun == nullptr) continue;
    const Settings before = state_.settings;
    sun->toLight = dragSun(sun->toLight, state_.up, drag.x, drag.y);
    change(before);
    return;
  }
  say("the scene has no sun to turn");
}

void Desk::focus(const std::optional<Place>& place) {
  if (!place) return;
  const double depth = viewer_.depthAt(place->x, place->y);
  if (!(depth > 0.0)) {
    actOnCamera(Action::frameAll);
    return;
  }
  const Camera camera = orbit_.camera();
  orbit_.focus(camera.position + depth * rayThrough(camera, place->x, place->y, aspect()));
  restart();
}

void Desk::fly(double seconds) {
  const Flight flight = window_.flight();
  if (!flight.any()) return;
  const double way = std::min(seconds, kLongestStep) * flySpeed_ * orbit_.distance();
  orbit_.fly(way * flight.forward, way * flight.right, way * flight.up);
  restart();
}

void Desk::takeKey(const KeyPress& press) {
  if (const int number = bookmarkOf(press); number > 0) {
    if (press.control) {
      bookmarks_.set(number, orbit_.camera());
      say("bookmark " + std::to_string(number) + " is set");
    } else if (const auto camera = bookmarks_.get(number)) {
      orbit_ = OrbitCamera(*camera);
      restart();
    } else {
      say("bookmark " + std::to_string(number) + " is not set; ctrl + " + std::to_string(number) +
          " sets it");
    }
    return;
  }
  if (const auto action = actionOf(press)) act(*action);
}

void Desk::quit() {
  if (state_.listOpen)
    state_.listOpen = false;
  else if (state_.help)
    state_.help = false;
  else
    window_.close();
}

void Desk::otherLook() {
  const Settings before = state_.settings;
  Look& look = state_.settings.scene.look;
  look = look == Look::report ? Look::physical : Look::report;
  change(before);
  history_.rest();
  say(describeLight(request(state_.settings).view));
}

void Desk::turnViews(int by) {
  state_.view = static_cast<View>((static_cast<int>(state_.view) + by) % kViewCount);
  say("view: " + std::string(rowOf(state_.view).name));
  restart();
}

void Desk::act(Action action) {
  switch (action) {
    case Action::quit:
      quit();
      break;
    case Action::look:
      otherLook();
      break;
    case Action::nextView:
      turnViews(1);
      break;
    case Action::previousView:
      turnViews(kViewCount - 1);
      break;
    case Action::split:
      split();
      break;
    case Action::swapSides:
      swapSides();
      break;
    case Action::undo:
    case Action::redo:
      undoOrRedo(action == Action::undo);
      break;
    case Action::panel:
      state_.visible = !state_.visible;
      break;
    case Action::help:
      state_.help = !state_.help;
      break;
    case Action::liveParticles:
    case Action::resetParticles:
    case Action::bakeThis:
      actOnParticles(action);
      break;
    case Action::play:
    case Action::stepBack:
    case Action::stepOn:
      if (live_)
        actOnParticles(action);
      else
        actOnFiles(action);
      break;
    case Action::focus:
    case Action::frameAll:
    case Action::firstView:
      actOnCamera(action);
      break;
    default:
      actOnFiles(action);
      break;
  }
}

void Desk::actOnCamera(Action action) {
  if (action == Action::focus) {
    const auto cursor = window_.cursor();
    focus(cursor ? cursor : Place{0.5, 0.5});
    return;
  }
  const Camera now = orbit_.camera();
  orbit_ = OrbitCamera(action == Action::frameAll ? framed(viewer_.volume(), now.fov) : firstCamera_);
  restart();
}

void Desk::actOnFiles(Action action) {
  Timeline& timeline = document_.timeline();
  switch (action) {
    case Action::play:
      if (timeline.frames() < 2) say("no sequence lies beside this file");
      timeline.play(!timeline.playing());
      break;
    case Action::stepBack:
      timeline.step(-1);
      break;
    case Action::stepOn:
      timeline.step(1);
      break;
    case Action::saveScene:
      saveTheScene();
      break;
    case Action::readScene:
      takeDrop(state_.sceneFile);
      break;
    case Action::picturePng:
      picture(".png");
      break;
    case Action::pictureExr:
      picture(".exr");
      break;
    default:
      break;
  }
}

void Desk::saveTheScene() {
  try {
    saveScene(state_.sceneFile, state_.settings, orbit_.camera(), hasFittedFactors(document_.volume()));
    say("wrote " + std::filesystem::path(state_.sceneFile).filename().string());
  } catch (const std::runtime_error& error) {  // a folder that cannot be written must not end the session
    say(error.what());
  }
}

void Desk::picture(const std::string& extension) {
  if (width_ < 1 || height_ < 1) return;
  try {
    const std::string path = nextPictureName(options_.folder, extension);
    if (extension == ".png")
      writeScreen(path, viewer_, screen(width_, height_), shown());
    else
      writeExr(path, viewer_.read());
    say("wrote " + std::filesystem::path(path).filename().string());
  } catch (const WorldError& error) {
    say(error.what());
  }
}

void Desk::takeWishes(const UiWishes& wishes, const Settings& before, bool held) {
  if (wishes.settings) {
    std::optional<CameraMove> move;
    if (before.scene.stage != state_.settings.scene.stage) move = riseAboveFloor();
    change(before, move);
  }
  if (!held && !window_.dragging()) history_.rest();
  if (wishes.picture) restart();
  for (const Action action : wishes.actions) act(action);
  if (wishes.environment) takeDrop(*wishes.environment);
  if (wishes.grid) document_.chooseGrid(*wishes.grid);
  if (wishes.frame) document_.timeline().seek(*wishes.frame);
  if (wishes.fps) document_.timeline().setFps(*wishes.fps);
}

}  // namespace nephele
