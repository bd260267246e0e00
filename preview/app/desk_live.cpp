// Live particles on the desk. Depends on all of preview.
#include <algorithm>
#include <filesystem>

#include "preview/app/desk.h"

namespace nephele {
namespace {

/// The box that particles move through is that of so many frames, or of those that the sequence has.
constexpr int64_t kUsualFrames = 48;

}  // namespace

void Desk::actOnParticles(Action action) {
  if (action == Action::liveParticles) {
    if (live_)
      endLive();
    else
      beginLive();
    return;
  }
  if (!live_) {
    say("no particles are moved live; P moves those of the file");
    return;
  }
  switch (action) {
    case Action::play:
      live_->play(!live_->playing());
      say(live_->playing() ? "live particles play" : "live particles pause");
      break;
    case Action::stepOn:
      live_->stepFrame();
      break;
    case Action::stepBack:
      say("live particles go forward alone; shift + P begins anew");
      break;
    case Action::resetParticles:
      live_->reset();
      say("live particles begin anew");
      break;
    default:
      bakeThis();
      break;
  }
  restart();
}

void Desk::beginLive() {
  if (!liveSource_ || !state_.settings.particles) {
    say("this file carries no particle block in its metadata, so there is nothing to move");
    return;
  }
  const int64_t frames = std::max<int64_t>(kUsualFrames, document_.frames().back().number + 1);
  try {
    live_.emplace(*liveSource_, *state_.settings.particles, document_.volume(), frames, state_.liveEdge);
  } catch (const std::exception& error) {  // what is not simulated live, or does not fit onto the GPU
    say(error.what());
    return;
  }
  document_.timeline().play(false);
  say("particles are moved live");
  restart();
}

void Desk::endLive() {
  live_.reset();
  try {
    viewer_.setVolume(document_.sharedVolume());
    say("back to the file");
  } catch (const std::exception& error) {  // too large for the GPU by now: what the particles left stays
    say(error.what());
  }
  restart();
}

void Desk::followLive() {
  if (!live_ || !state_.settings.particles) return;
  try {
    if (state_.liveEdge != live_->edge()) live_->setEdge(state_.liveEdge);
    live_->setSystem(*state_.settings.particles);
  } catch (const SimulationError& error) {
    say(error.what());
  }
  if (&viewer_.volume() == live_->volume().get()) return;
  try {
    viewer_.setLiveVolume(live_->volume());
  } catch (const std::exception& error) {  // too large for the GPU: the volume before stays
    say(error.what());
    live_.reset();
    viewer_.setVolume(document_.sharedVolume());
  }
}

bool Desk::advanceLive(double seconds) {
  if (!live_ || width_ < 1 || height_ < 1) return false;
  const bool moved = live_->advance(seconds, *viewer_.liveAtlas());
  if (const std::string trouble = live_->takeTrouble(); !trouble.empty()) say(trouble);
  if (moved) restart();
  return moved;
}

void Desk::bakeThis() {
  std::optional<FrameRange> frames;
  if (liveSource_->framed) frames = {document_.frames().front().number, document_.frames().back().number + 1};
  Scene scene = state_.settings.scene;
  scene.camera = orbit_.camera();
  scene.cameraUpGiven = true;
  scene.medium = state_.settings.medium;
  try {
    const std::string path = writeLiveRecipe(options_.folder, *liveSource_, *state_.settings.particles,
                                             frames, writeScene(scene, options_.folder));
    say("wrote " + std::filesystem::path(path).filename().string());
  } catch (const WorldError& error) {  // a folder that cannot be written must not end the session
    say(error.what());
  }
}

}  // namespace nephele
