// Frames of live particles and the box they live in. Depends on preview/app/live_session.h.
#include "preview/app/live_session.h"

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

constexpr double kLookSeconds = 1.0;   // between two looks at what the stages counted
constexpr int64_t kPrewarmFrames = 4;  // in one turn of the window's loop
// What the box found by few particles is grown by, a share of its sides: others go a little farther.
constexpr double kMargin = 0.06;

}  // namespace

LiveSession::LiveSession(const LiveSource& source, const ParticleSystem& system, const BrickVolume& like,
                         int64_t frames, int edge)
    : like_(withoutBricks(like)), frames_(frames), edge_(edge), motion_(system, source.settings) {
  written_ = writeParticles(system);
  findBox();
  makeVolume();
}

void LiveSession::findBox() {
  const std::optional<MotionBox> box = motionBox(motion_.system(), motion_.settings(), frames_);
  if (!box) throw SimulationError("no particle is born in " + std::to_string(frames_) + " frames");
  found_ = *box;
  if (motion_.system().hasBox()) return;
  const glm::dvec3 margin = kMargin * (found_.high - found_.low);
  found_.low -= margin;
  found_.high += margin;
}

void LiveSession::makeVolume() {
  mostMass_ = mostMass(motion_.system(), motion_.rings());
  const LiveBox box = liveBox(found_, edge_);
  if (!volume_ || !(box == box_)) volume_ = std::make_shared<BrickVolume>(liveVolume(box, like_));
  box_ = box;
  stale_ = true;
}

void LiveSession::setSystem(const ParticleSystem& system) {
  std::string written = writeParticles(system);
  if (written == written_) return;
  const bool otherBox = system.boxMin != motion_.system().boxMin || system.boxMax != motion_.system().boxMax;
  motion_.setSystem(system);
  written_ = std::move(written);
  if (otherBox) findBox();
  makeVolume();
}

void LiveSession::setEdge(int edge) {
  edge_ = edge;
  makeVolume();
}

void LiveSession::reset() {
  motion_.reset();
  findBox();
  makeVolume();
  clock_ = 0.0;
}

int64_t LiveSession::frame() const {
  const int64_t steps = static_cast<int64_t>(motion_.stepsDone());
  return steps / substeps() - motion_.system().prewarm;
}

void LiveSession::stepFrame() {
  playing_ = false;
  for (int64_t n = 0; n < substeps(); ++n) motion_.step();
  stale_ = true;
}

void LiveSession::look() {
  sinceLook_ = 0.0;
  const LiveStatus before = std::exchange(status_, motion_.status());
  if (status_.runaways > before.runaways)
    trouble_ = std::to_string(status_.runaways) +
               " live particles left the range where they can be moved and were taken away; the bake would "
               "refuse them";
  if (status_.crowded > before.crowded)
    trouble_ =
        "live particles lie too close for their neighbours to be looked at; use a smaller 'radius' of "
        "'neighbours'";
  if (!trouble_.empty()) playing_ = false;
}

bool LiveSession::advance(double seconds, BrickAtlas& atlas) {
  sinceLook_ += seconds;
  clock_ += seconds;
  const double perFrame = 1.0 / motion_.settings().fps;
  const bool warming = frame() < 0;
  if (playing_ && (warming || clock_ >= perFrame)) {
    // Frames that there was no time for are not made up for: they would only come later still.
    clock_ = std::min(clock_ - perFrame, perFrame);
    for (int64_t n = 0; n < (warming ? kPrewarmFrames : 1) * substeps(); ++n) {
      if (warming && frame() >= 0) break;
      motion_.step();
    }
    stale_ = true;
  }
  if (!stale_) return false;
  grid_.rebuild(motion_, box_, mostMass_, atlas);
  stale_ = false;
  if (sinceLook_ >= kLookSeconds || !playing_) look();
  return true;
}

std::optional<double> LiveSession::due() const {
  if (stale_) return 0.0;
  if (!playing_) return std::nullopt;
  return std::max(0.0, 1.0 / motion_.settings().fps - clock_);
}

}  // namespace nephele
