// Truth in steps of less noise. Depends on what its header names.
#include "preview/measure/truth_ladder.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace nephele {
namespace {

// The least error that the first step tells, and of each further one as a share of that of the step before.
constexpr double kFirstTells = 0.03, kNextTells = 1.0 / 3.0;
// Halves cancel: over kPixels pixels, of which a medium covers a third, noise of kTimesError errors leaves an
// interval of about a fifth of the error; it grows with the noise's square over the root of the pixels.
constexpr double kMostNoise = 0.05, kTimesError = 2.0, kPixels = 8000.0;

double tells(size_t step) { return kFirstTells * std::pow(kNextTells, static_cast<double>(step)); }

}  // namespace

double workOfTruth(double looks, double paths) {
  // Of the processor's time on the same cores as llvmpipe: cumulus and stratus, one and all orders, within
  // 30%.
  constexpr double kLook = 2.3, kPath = 12.0;
  return kLook * looks + kPath * paths;
}

TruthLadder::TruthLadder(Method& truth, const ViewedScene& view, const PictureRequest& sparse)
    : truth_(truth), view_(view), sparse_(sparse) {
  sparse_.mostSamples = kMostTruthSamples;
  const double pixels =
      static_cast<double>(strided(sparse_.width, sparse_.stride)) * strided(sparse_.height, sparse_.stride);
  fewPixels_ = std::min(1.0, std::pow(pixels / kPixels, 0.25));
}

double TruthLadder::noiseOf(size_t step) const {
  return fewPixels_ * std::min(kMostNoise, kTimesError * tells(step));
}

NoisyError TruthLadder::compared(const Picture& picture, size_t step) {
  return compareWithHalves(picture, at(step));
}

size_t TruthLadder::stepFor(double error) {
  NEPHELE_CHECK_EQ(error > 0.0, true);
  size_t step = 0;
  while (tells(step) > error) ++step;
  return step;
}

double TruthLadder::allowed(double error, size_t step) { return std::max(error, tells(step)); }

TruthLadder::Cost TruthLadder::costOf(const PictureCost& cost) const {
  const double pixels =
      static_cast<double>(strided(sparse_.width, sparse_.stride)) * strided(sparse_.height, sparse_.stride);
  return {workOfTruth(pixels * cost.densitySamplesPerPixel, pixels * cost.pathsPerPixel), cost.milliseconds};
}

void TruthLadder::measureLeast() {
  if (steps_.empty()) {
    PictureRequest request = sparse_;
    request.error = 1.0;
    PictureCost cost;
    truth_.render(view_, request, cost);
    least_ = costOf(cost);
  }
  at(0);
}

double TruthLadder::workFor(double error) {
  measureLeast();
  return std::max(least_.work, atOne_.work / (error * error));
}

double TruthLadder::millisecondsFor(double error) {
  measureLeast();
  return std::max(least_.milliseconds, atOne_.milliseconds / (error * error));
}

const Picture& TruthLadder::at(size_t step) {
  while (steps_.size() <= step) {
    PictureRequest request = sparse_;
    request.error = noiseOf(steps_.size());
    request.seed += static_cast<unsigned>(steps_.size());
    PictureCost cost;
    steps_.push_back(truth_.render(view_, request, cost));
    if (steps_.size() > 1) continue;
    const Cost spent = costOf(cost);
    const double square = cost.relativeError * cost.relativeError;
    atOne_ = {spent.work * square, spent.milliseconds * square};
  }
  return steps_[step];
}

}  // namespace nephele
