// Coarse and accumulated pictures for the window. Depends on gpu, scene and volume/bricks.h.
#include "preview/app/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "preview/behind.h"
#include "preview/gpu/camera_rays.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

// A coarse frame should take about this long; its size changes only outside the band, so that it does not
// flutter.
constexpr double kQuickSecondsLow = 0.012, kQuickSecondsHigh = 0.035;
constexpr int kMostDivisor = 8;
constexpr double kQuickStepFactor = 3.0;

// As shaders/display.frag declares them.
enum DisplayLocation : GLint { kBottom = 0, kTop = 1, kWindowSize = 3, kExposure = 4, kBehind = 5 };
constexpr GLuint kParameterBinding = 0;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void setRgb(GLint location, const Rgb& rgb) {
  glUniform3f(location, static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]));
}

void fitFilm(std::optional<Film>& film, int width, int height) {
  if (film && film->width() == width && film->height() == height) {
    film->clear();
  } else {
    film.reset();
    film.emplace(width, height);
  }
}

}  // namespace

Viewer::Viewer(const BrickVolume& bricks, Filter filter, unsigned seed)
    : bricks_(bricks),
      seed_(seed),
      pass_(filter),
      atlas_(bricks, filter),
      display_(buildProgram("screen.vert", "display.frag")),
      displayParameters_(makeBuffer()),
      noVertices_(makeVertexArray()) {
  glNamedBufferStorage(displayParameters_.name(), sizeof(shared::MarchParameters), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  checkGl("making the display's parameters");
}

void Viewer::restart(const ViewedScene& view, int width, int height) {
  view_ = view;
  width_ = width;
  height_ = height;
  quickNeeded_ = true;
  accumulator_.reset();
  pass_.setEnvironment(view.environmentMap);
  const shared::MarchParameters parameters = marchParameters(view, bricks_, width, height, seed_, true);
  glNamedBufferSubData(displayParameters_.name(), 0, sizeof parameters, &parameters);
}

void Viewer::drawQuick() {
  const int width = std::max(1, width_ / divisor_), height = std::max(1, height_ / divisor_);
  fitFilm(quick_, width, height);
  ViewedScene coarse = view_;
  coarse.scene.march.stepVoxels *= kQuickStepFactor;
  coarse.scene.march.shadowStepVoxels *= kQuickStepFactor;
  const auto start = Clock::now();
  pass_.setParameters(marchParameters(coarse, bricks_, width, height, seed_, true));
  Accumulator once(width, height, 1, seed_);
  once.advance(pass_, atlas_, *quick_, std::numeric_limits<double>::infinity());
  const double seconds = secondsSince(start);
  stats_.quickMilliseconds = seconds * 1e3;
  if (seconds > kQuickSecondsHigh) divisor_ = std::min(divisor_ + 1, kMostDivisor);
  if (seconds < kQuickSecondsLow) divisor_ = std::max(divisor_ - 1, 1);
}

bool Viewer::work(double seconds) {
  if (width_ < 1 || height_ < 1) return false;
  if (quickNeeded_) {
    drawQuick();
    quickNeeded_ = false;
    fitFilm(full_, width_, height_);
    pass_.setParameters(marchParameters(view_, bricks_, width_, height_, seed_, true));
    accumulator_.emplace(width_, height_, kRestSamples, seed_);
    fullSeconds_ = 0.0;
    stats_.densitySamplesPerPixel = 0.0;
    return true;
  }
  if (!accumulator_ || accumulator_->done()) return false;
  const auto start = Clock::now();
  const bool more = accumulator_->advance(pass_, atlas_, *full_, seconds);
  fullSeconds_ += secondsSince(start);
  const unsigned whole = accumulator_->wholeSamples();
  if (whole > 0 && stats_.densitySamplesPerPixel == 0.0) {
    const double drawn = static_cast<double>(accumulator_->pixelsDone());
    const FilmPicture soFar = full_->read();
    stats_.densitySamplesPerPixel = soFar.densitySamples / drawn;
    stats_.raysCutShort = soFar.raysCutShort;
    stats_.sampleMilliseconds = fullSeconds_ * 1e3 * width_ * height_ / drawn;
  }
  return more;
}

const Film& Viewer::best() const {
  return accumulator_ && accumulator_->wholeSamples() > 0 ? *full_ : *quick_;
}

void Viewer::show(const Scene& scene, double exposureEv, int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  if (!quick_) return;
  best().bindForDisplay();
  glUseProgram(display_.name());
  glBindVertexArray(noVertices_.name());
  const BackdropColours colours = scene.backdrop.value_or(BackdropColours{});
  setRgb(kBottom, colours.bottom);
  setRgb(kTop, colours.top);
  pass_.bindEnvironment();
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameterBinding, displayParameters_.name());
  glUniform2f(kWindowSize, static_cast<float>(width), static_cast<float>(height));
  glUniform1f(kExposure, static_cast<float>(std::exp2(exposureEv)));
  glUniform1i(kBehind, static_cast<int>(behindOf(scene)));
  constexpr GLsizei kTriangleCorners = 3;
  glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
  checkGl("showing the picture");
}

Picture Viewer::read() const { return best().read().picture; }

ViewerStats Viewer::stats() const {
  ViewerStats stats = stats_;
  stats.samplesWanted = kRestSamples;
  stats.samples = accumulator_ ? accumulator_->wholeSamples() : 0;
  stats.gpuBytes = atlas_.gpuBytes() + pass_.gpuBytes() + (quick_ ? quick_->gpuBytes() : 0) +
                   (full_ ? full_->gpuBytes() : 0);
  return stats;
}

}  // namespace nephele
