// What changes the desk's settings: scenes and skies that come in, undo, the split. Depends on all of
// preview.
#include <filesystem>

#include "preview/app/desk.h"
#include "preview/resolve.h"

namespace nephele {

Camera Desk::framed(const BrickVolume& volume, double fov) const {
  return frameCamera(volume, state_.up, fov, aspect(), state_.settings.scene.stage);
}

void Desk::change(const Settings& before, std::optional<CameraMove> move) {
  std::optional<CameraMove>& known = state_.settings.cameraMove;
  if (move && known && history_.inGesture()) move->from = known->from;
  if (move || !history_.inGesture()) known = move;
  history_.changed(before);
  restart();
}

std::optional<CameraMove> Desk::riseAboveFloor() {
  const Stage& stage = state_.settings.scene.stage;
  const Camera now = orbit_.camera();
  const auto below = [&](const Camera& camera) {
    return seesFloorFromBelow(camera, stage, state_.up, viewer_.volume());
  };
  if (!firstScene_.camera && below(firstCamera_)) firstCamera_ = framed(viewer_.volume(), now.fov);
  if (!below(now)) return std::nullopt;
  orbit_ = OrbitCamera(framed(viewer_.volume(), now.fov));
  say("the camera was beneath the stage's floor, and stands above it now");
  return CameraMove{now, orbit_.camera()};
}

void Desk::takeDrop(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  try {
    if (ending == ".vdb")
      document_.open(path);
    else if (ending == ".yaml" || ending == ".yml")
      adoptScene(path);
    else if (ending == ".exr")
      adoptEnvironment(path);
    else
      say("'" + std::filesystem::path(path).filename().string() +
          "' is no .vdb, no .yaml with a scene and no .exr of the sky");
  } catch (const InputError& error) {
    say(error.what());
  }
}

void Desk::adoptScene(const std::string& path) {
  const Settings before = state_.settings;
  std::string sentence;
  const ViewedScene view = resolveScene(loadScene(path), document_.volume(), aspect(), sentence);
  state_.settings.scene = view.scene;
  state_.settings.medium = view.medium;
  state_.settings.environmentMap = view.environmentMap;
  std::optional<CameraMove> move;
  if (view.scene.camera) {
    move = CameraMove{orbit_.camera(), view.camera};
    orbit_ = OrbitCamera(view.camera);
  } else {
    move = riseAboveFloor();
  }
  change(before, move);
  history_.rest();
  say("took over the scene of " + std::filesystem::path(path).filename().string());
}

void Desk::adoptEnvironment(const std::string& path) {
  const auto map = loadEnvironmentMap(path);
  const Settings before = state_.settings;
  state_.settings.environmentMap = map;
  state_.settings.scene.environment.kind = Environment::Kind::exr;
  state_.settings.scene.environment.exr.path = path;
  change(before);
  history_.rest();
  say("lit by " + std::filesystem::path(path).filename().string());
}

void Desk::undoOrRedo(bool undo) {
  const auto value = undo ? history_.undo(state_.settings) : history_.redo(state_.settings);
  if (!value) {
    say(undo ? "nothing to undo" : "nothing to redo");
    return;
  }
  const std::optional<CameraMove> left = std::exchange(state_.settings, *value).cameraMove;
  const std::optional<CameraMove>& entered = state_.settings.cameraMove;
  if (undo && left) orbit_ = OrbitCamera(left->from);
  if (!undo && entered) orbit_ = OrbitCamera(entered->to);
  restart();
}

void Desk::split() {
  if (state_.kept) {
    state_.kept.reset();
    viewer_.endSplit();
  } else {
    state_.kept = state_.settings;
  }
  restart();
}

void Desk::swapSides() {
  if (!state_.kept) return;
  const Settings before = state_.settings;
  std::swap(state_.settings, *state_.kept);
  change(before);
  history_.rest();
}

}  // namespace nephele
