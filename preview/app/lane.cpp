// Coarse and accumulated pictures. Depends on gpu, volume/bricks.h and app/noise_estimate.h.
#include "preview/app/lane.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "preview/app/noise_estimate.h"
#include "preview/gpu/camera_rays.h"
#include "preview/gpu/moving.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

// A coarse frame should take about this long; its size changes only outside the band, so that it does not
// flutter.
constexpr double kQuickSecondsLow = 0.012, kQuickSecondsHigh = 0.035;
constexpr int kMostDivisor = 8;
constexpr unsigned kFirstCheck = 8;  // samples before noise is measured: two halves of fewer tell too little
constexpr unsigned kSamplesWithoutNoise = 16;  // a view without random numbers needs smooth edges alone

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void fitFilm(std::optional<Film>& film, int width, int height) {
  if (film && film->width() == width && film->height() == height) {
    film->clear();
  } else {
    film.reset();
    film.emplace(width, height);
  }
}

/// One channel of four, over the pixels.
std::vector<float> channelOf(const std::vector<float>& texels, size_t channel) {
  constexpr size_t kChannels = 4;
  std::vector<float> values;
  values.reserve(texels.size() / kChannels);
  for (size_t i = channel; i < texels.size(); i += kChannels) values.push_back(texels[i]);
  return values;
}

}  // namespace

void Lane::restart(const LaneRequest& request) {
  scaleKnown_ = scaleKnown_ && request.show == request_.show;
  request_ = request;
  quickNeeded_ = true;
  stats_.noise = 0.0;
  accumulator_.reset();
}

void Lane::drawQuick(const LaneTools& tools) {
  const int width = std::max(1, request_.width / divisor_), height = std::max(1, request_.height / divisor_);
  fitFilm(quick_, width, height);
  ViewedScene coarse = request_.view;
  coarse.scene.march = movingMarch(coarse.scene.march, static_cast<double>(height) / request_.height);
  const auto start = Clock::now();
  tools.pass.setParameters(
      marchParameters(coarse, tools.bricks, tools.atlas.layout().frame, width, height, tools.seed, true));
  tools.pass.prepare(tools.atlas, kMovingCacheSeconds);
  // Through the pixels' centres: a single sample anywhere else would shift the picture.
  constexpr glm::vec2 kCentre(0.5f, 0.5f);
  tools.pass.draw(tools.atlas, *quick_, kCentre, 0, {0, 0, width, height});
  sharpenQuick(tools);
  finishGl("marching a moving picture");
  const double seconds = secondsSince(start);
  stats_.quickMilliseconds = seconds * 1e3;
  stats_.quickWidth = width;
  stats_.quickHeight = height;
  // A single frame tells little: the first one waits for the driver's compiler, others for other programs.
  const double before = std::exchange(quickSeconds_, seconds);
  if (std::min(seconds, before) > kQuickSecondsHigh) divisor_ = std::min(divisor_ + 1, kMostDivisor);
  if (std::max(seconds, before) < kQuickSecondsLow) divisor_ = std::max(divisor_ - 1, 1);
  if (!scaleKnown_) chooseScale(*quick_);
  quickNeeded_ = false;
}

void Lane::sharpenQuick(const LaneTools& tools) {
  if (divisor_ == 1 || rowOf(request_.show).writes != MarchWrites::radiance) {
    sharpened_.reset();
    return;
  }
  fitFilm(sharpened_, quick_->width(), quick_->height());
  tools.sharpen.draw(*quick_, *sharpened_);
}

void Lane::beginRest(const LaneTools& tools, const RestGoal& goal) {
  fitFilm(full_, request_.width, request_.height);
  const bool random = rowOf(request_.show).writes == MarchWrites::radiance;
  wanted_ = random ? goal.most : kSamplesWithoutNoise;
  check_ = random ? kFirstCheck : std::numeric_limits<unsigned>::max();
  accumulator_.emplace(request_.width, request_.height, wanted_, tools.seed);
  fullSeconds_ = 0.0;
  stats_.densitySamplesPerPixel = 0.0;
  stats_.skips = {};
  stats_.raysCutShort = 0.0;
  stats_.noise = 0.0;
}

bool Lane::work(const LaneTools& tools, double seconds, const RestGoal& goal) {
  NEPHELE_CHECK_EQ(quickNeeded_, false);
  if (!accumulator_) beginRest(tools, goal);
  if (!unfinished()) return false;
  tools.pass.setParameters(marchParameters(request_.view, tools.bricks, tools.atlas.layout().frame,
                                           request_.width, request_.height, tools.seed, true));
  if (!tools.pass.prepare(tools.atlas, seconds)) return true;
  const auto start = Clock::now();
  const unsigned before = accumulator_->wholeSamples();
  // The two halves are read where exactly so many samples are whole.
  const unsigned halt = before < check_ / 2 ? check_ / 2 : check_;
  accumulator_->advance(tools.pass, tools.atlas, *full_, seconds, std::min(halt, wanted_));
  fullSeconds_ += secondsSince(start);
  const SkipCheck skips = tools.pass.takeSkipCheck();
  stats_.skips.checked += skips.checked;
  stats_.skips.wrong += skips.wrong;
  const unsigned whole = accumulator_->wholeSamples();
  if (before == 0 && whole > 0) lookAtFirstSample();
  if (whole != before && whole == check_ / 2) firstHalf_ = full_->radianceSums();
  if (whole != before && whole == check_) measureNoise(goal);
  return unfinished();
}

void Lane::lookAtFirstSample() {
  const double drawn = static_cast<double>(accumulator_->pixelsDone());
  const std::vector<float> texels = full_->depthSums();
  const std::vector<float> reads = channelOf(texels, 2), cut = channelOf(texels, 3);
  double sum = 0.0;
  for (const float value : reads) sum += double{value};
  for (const float value : cut) stats_.raysCutShort += double{value};
  stats_.densitySamplesPerPixel = sum / drawn;
  stats_.sampleMilliseconds = fullSeconds_ * 1e3 * request_.width * request_.height / drawn;
  chooseScale(*full_);
}

void Lane::chooseScale(const Film& film) {
  if (const double top = rowOf(request_.show).top; top > 0.0) stats_.scale = top;
  if (request_.show == View::steps) stats_.scale = scaleFor(channelOf(film.depthSums(), 2));
  if (request_.show == View::slice) stats_.scale = scaleFor(channelOf(film.radianceSums(), 0));
  scaleKnown_ = true;
}

void Lane::measureNoise(const RestGoal& goal) {
  std::vector<float> sums = full_->radianceSums();
  stats_.noise = relativeNoise(firstHalf_, sums, check_);
  wanted_ = samplesFor(stats_.noise, check_, goal.tolerance, goal.most);
  firstHalf_ = std::move(sums);  // check_ samples are the first half of the next measurement's
  check_ *= 2;
}

const Film* Lane::best() const {
  if (accumulator_ && accumulator_->wholeSamples() > 0) return &*full_;
  if (sharpened_) return &*sharpened_;
  return quick_ ? &*quick_ : nullptr;
}

LaneStats Lane::stats() const {
  LaneStats stats = stats_;
  stats.samples = accumulator_ ? accumulator_->wholeSamples() : 0;
  stats.samplesWanted = wanted_;
  const unsigned measured = check_ / 2;  // it has fallen since
  if (stats.samples > measured) stats.noise *= std::sqrt(static_cast<double>(measured) / stats.samples);
  return stats;
}

uint64_t Lane::gpuBytes() const {
  uint64_t bytes = 0;
  for (const auto& film : {&quick_, &sharpened_, &full_}) bytes += *film ? (*film)->gpuBytes() : 0;
  return bytes;
}

}  // namespace nephele
