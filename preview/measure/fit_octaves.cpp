// Fitting factors. Depends on what its header names.
#include "preview/measure/fit_octaves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/progress.h"
#include "preview/measure/least_point.h"

namespace nephele {
namespace {

using glm::dvec3;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr unsigned kTruthSeed = 0x4669u;
constexpr unsigned kMostTruthSamples = 2048;
constexpr double kIrradiance = 3.0;

/// Where camera and sun stand about the subject, degrees: azimuths, and elevations above the ground.
struct Station {
  double camera, cameraUp, sun, sunUp;
  bool fitted;
};

/// From all sides, the sun from behind the camera to behind the cloud, from high to low.
constexpr Station kStations[] = {
    {0, -8, 40, 45, true},     {60, 15, 0, 20, true},    {120, 0, 270, 35, true}, {180, 30, 270, 70, true},
    {240, -5, 120, 10, true},  {300, 10, 120, 30, true}, {30, 5, 10, 30, false},  {150, 20, 270, 55, false},
    {210, -10, 50, 20, false}, {270, 0, 330, 5, false}};

/// Unit; azimuth 0 looks from where the view's camera stands, at elevation 0.
dvec3 directionAt(const ViewedScene& view, double azimuth, double elevation) {
  const dvec3 up = glm::normalize(view.up);
  dvec3 towards = view.camera.position - view.camera.target;
  towards = glm::normalize(towards - glm::dot(towards, up) * up);
  const dvec3 side = glm::cross(up, towards);
  const dvec3 flat = std::cos(azimuth * kDegree) * towards + std::sin(azimuth * kDegree) * side;
  return std::cos(elevation * kDegree) * flat + std::sin(elevation * kDegree) * up;
}

ViewedScene viewAt(const ViewedScene& given, const Station& station) {
  ViewedScene view = given;
  const double distance = glm::length(given.camera.position - given.camera.target);
  view.camera.position =
      given.camera.target + distance * directionAt(given, station.camera, station.cameraUp);
  view.camera.up = given.up;
  Scene& scene = view.scene;
  scene.lights = {
      Sun{directionAt(given, station.sun, station.sunUp), {kIrradiance, kIrradiance, kIrradiance}}};
  scene.environment = Environment{};
  scene.look = Look::physical;
  scene.powder.on = false;
  scene.lightTransmittance = LightTransmittance::marched;
  scene.march.lightCache = false;  // each view has another sun
  scene.march.levelPixels = scene.march.stepPixels =
      0.0;  // the small pictures stand for large ones, which resolve every voxel
  return view;
}

void setFactors(ViewedScene& view, const OctaveFactors& factors, int count) {
  view.scene.octaves.count = count;
  view.scene.octaves.a = factors[0];
  view.scene.octaves.b = factors[1];
  view.scene.octaves.c = factors[2];
}

/// The fit at work.
class Fit {
 public:
  Fit(Method& march, Method& truth, std::vector<FitSubject> subjects, const FitOptions& options)
      : march_(march), truth_(truth), subjects_(std::move(subjects)), options_(options) {}

  void addViews(size_t checksFrom) {
    Progress progress("tracing truth", subjects_.size() * std::size(kStations), options_.quiet);
    for (size_t s = 0; s < subjects_.size(); ++s) {
      truth_.setVolume(*subjects_[s].bricks);
      for (const Station& station : kStations) {
        FitView view{s,
                     subjects_[s].name,
                     station.fitted && s < checksFrom,
                     viewAt(subjects_[s].view, station),
                     {},
                     {},
                     {}};
        view.name += " camera " + std::to_string(static_cast<int>(station.camera)) + ", sun " +
                     std::to_string(static_cast<int>(station.sun)) + "/" +
                     std::to_string(static_cast<int>(station.sunUp));
        PictureRequest request = requestOf();
        request.error = options_.truthError;
        request.mostSamples = kMostTruthSamples;
        request.seed = kTruthSeed;
        PictureCost cost;
        view.truth = truth_.render(view.view, request, cost);
        if (isDark(view.truth))
          throw InputError({view.name}, "scatters no light, so there is nothing to fit to");
        views.push_back(std::move(view));
        progress.advance();
      }
    }
  }

  NoisyError errorOf(FitView& view, const OctaveFactors& factors, int count) {
    take(view.subject);
    setFactors(view.view, factors, count);
    PictureCost cost;
    return compareWithHalves(march_.render(view.view, requestOf(), cost), view.truth);
  }

  /// The squared errors of all views that are fitted to, for any factors.
  OctaveForm form() {
    Progress progress("orders", views.size(), options_.quiet);
    OctaveForm sum;
    for (const FitView& view : views) {
      if (view.fitted) {
        take(view.subject);
        sum.add(OctaveForm::of(march_, view.view, requestOf(), view.truth));
      }
      progress.advance();
    }
    return sum;
  }

  std::vector<FitView> views;

 private:
  PictureRequest requestOf() const {
    PictureRequest request;
    request.width = options_.width;
    request.height = options_.height;
    request.samples = options_.samples;
    request.quiet = true;
    return request;
  }
  void take(size_t subject) {
    if (loaded_ != subject) march_.setVolume(*subjects_[subject].bricks);
    loaded_ = subject;
  }
  static bool isDark(const Picture& picture) {
    return std::all_of(picture.planes[0].begin(), picture.planes[0].end(),
                       [](float value) { return value <= 0.0f; });
  }

  Method &march_, &truth_;
  std::vector<FitSubject> subjects_;
  const FitOptions& options_;
  size_t loaded_ = std::numeric_limits<size_t>::max();
};

struct FittedFactors {
  OctaveFactors factors;
  int count;
  double error;  // root mean square over the views, times the root of how many they are
};

FittedFactors fittedTo(const OctaveForm& form, int count) {
  constexpr int kSide = 11;
  constexpr double kTolerance = 1e-4;
  constexpr size_t kMost = 400;
  const auto cost = [&](const OctaveFactors& factors) { return form.at(factors, count); };
  const OctaveFactors factors = leastOfCube(cost, kSide, kTolerance, kMost);
  return {factors, count, std::sqrt(std::max(cost(factors), 0.0))};
}

/// The fewest octaves whose error is within a share of the least.
FittedFactors fewestFittedTo(const OctaveForm& form) {
  constexpr double kNearly = 1.03;
  std::vector<FittedFactors> all;
  double least = std::numeric_limits<double>::infinity();
  for (int count = 1; count <= kMostOctaveCount; ++count) {
    all.push_back(fittedTo(form, count));
    least = std::min(least, all.back().error);
  }
  return *std::find_if(all.begin(), all.end(),
                       [&](const FittedFactors& f) { return f.error <= kNearly * least; });
}

}  // namespace

double errorOver(const std::vector<FitView>& views, bool fitted, bool after) {
  double sum = 0.0, count = 0.0;
  for (const FitView& view : views) {
    if (view.fitted != fitted) continue;
    const double error = (after ? view.after : view.before).relativeRmse;
    sum += error * error;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

bool worsensHeldBack(const std::vector<FitView>& views) {
  return errorOver(views, false, true) > errorOver(views, false, false);
}

FitResult fitOctaves(Method& march, Method& truth, const std::vector<FitSubject>& subjects,
                     const std::vector<FitSubject>& checks, const FitOptions& options) {
  std::vector<FitSubject> all = subjects;
  all.insert(all.end(), checks.begin(), checks.end());
  Fit fit(march, truth, std::move(all), options);
  fit.addViews(subjects.size());
  const OctaveForm form = fit.form();
  FitResult result;
  const FittedFactors fitted = options.count ? fittedTo(form, *options.count) : fewestFittedTo(form);
  result.factors = fitted.factors;
  result.count = fitted.count;
  for (FitView& view : fit.views) {
    view.before = fit.errorOf(view, kUnfittedFactors, result.count);
    view.after = fit.errorOf(view, result.factors, result.count);
  }
  result.views = std::move(fit.views);
  return result;
}

}  // namespace nephele
