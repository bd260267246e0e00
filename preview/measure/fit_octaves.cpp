// Fitting factors. Depends on what its header names.
#include "preview/measure/fit_octaves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/progress.h"

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

ViewedScene viewAt(const ViewedScene& given, const Station& station, int count) {
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
  scene.octaves.count = count;
  scene.march.lightCache = false;  // each view has another sun
  return view;
}

void setFactors(ViewedScene& view, const OctaveFactors& factors) {
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
                     viewAt(subjects_[s].view, station, options_.count),
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

  NoisyError errorOf(FitView& view, const OctaveFactors& factors) {
    if (loaded_ != view.subject) march_.setVolume(*subjects_[view.subject].bricks);
    loaded_ = view.subject;
    setFactors(view.view, factors);
    PictureCost cost;
    return compareWithHalves(march_.render(view.view, requestOf(), cost), view.truth);
  }

  double cost(const OctaveFactors& factors) {
    double sum = 0.0;
    for (FitView& view : views) {
      if (!view.fitted) continue;
      const double error = errorOf(view, factors).relativeRmse;
      sum += error * error;
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
  static bool isDark(const Picture& picture) {
    return std::all_of(picture.planes[0].begin(), picture.planes[0].end(),
                       [](float value) { return value <= 0.0f; });
  }

  Method &march_, &truth_;
  std::vector<FitSubject> subjects_;
  const FitOptions& options_;
  size_t loaded_ = std::numeric_limits<size_t>::max();
};

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

OctaveFactors leastOf(const std::function<double(const OctaveFactors&)>& cost, const OctaveFactors& start,
                      double tolerance, size_t most) {
  struct Corner {
    OctaveFactors at;
    double cost;
  };
  size_t spent = 0;
  const auto corner = [&](OctaveFactors at) {
    for (double& factor : at) factor = std::clamp(factor, 0.0, 1.0);  // the nearest point of the cube
    ++spent;
    return Corner{at, cost(at)};
  };
  constexpr double kFirstEdge = 0.2;
  std::vector<Corner> simplex{corner(start)};
  for (size_t axis = 0; axis < start.size(); ++axis) {
    OctaveFactors at = start;
    at[axis] += at[axis] > 0.5 ? -kFirstEdge : kFirstEdge;
    simplex.push_back(corner(at));
  }
  const auto byCost = [](const Corner& a, const Corner& b) { return a.cost < b.cost; };
  const auto spread = [&] {
    double widest = 0.0;
    for (size_t axis = 0; axis < start.size(); ++axis)
      for (const Corner& c : simplex) widest = std::max(widest, std::abs(c.at[axis] - simplex[0].at[axis]));
    return widest;
  };
  for (std::sort(simplex.begin(), simplex.end(), byCost); spent < most && spread() > tolerance;
       std::sort(simplex.begin(), simplex.end(), byCost)) {
    Corner& worst = simplex.back();
    OctaveFactors middle{};
    for (size_t i = 0; i + 1 < simplex.size(); ++i)
      for (size_t axis = 0; axis < middle.size(); ++axis) middle[axis] += simplex[i].at[axis] / 3.0;
    // From the worst corner through the middle of the others: 1 is its mirror image, −½ half-way back.
    const auto through = [&](double times) {
      OctaveFactors at{};
      for (size_t axis = 0; axis < at.size(); ++axis)
        at[axis] = middle[axis] + times * (middle[axis] - worst.at[axis]);
      return corner(at);
    };
    const Corner mirrored = through(1.0);
    if (mirrored.cost < simplex[0].cost) {
      const Corner farther = through(2.0);
      worst = farther.cost < mirrored.cost ? farther : mirrored;
    } else if (mirrored.cost < simplex[simplex.size() - 2].cost) {
      worst = mirrored;
    } else {
      const Corner nearer = through(mirrored.cost < worst.cost ? 0.5 : -0.5);
      if (nearer.cost < std::min(worst.cost, mirrored.cost)) {
        worst = nearer;
        continue;
      }
      for (size_t i = 1; i < simplex.size(); ++i) {
        for (size_t axis = 0; axis < start.size(); ++axis)
          simplex[i].at[axis] = 0.5 * (simplex[i].at[axis] + simplex[0].at[axis]);
        simplex[i] = corner(simplex[i].at);
      }
    }
  }
  return simplex[0].at;
}

FitResult fitOctaves(Method& march, Method& truth, const std::vector<FitSubject>& subjects,
                     const std::vector<FitSubject>& checks, const FitOptions& options) {
  std::vector<FitSubject> all = subjects;
  all.insert(all.end(), checks.begin(), checks.end());
  Fit fit(march, truth, std::move(all), options);
  fit.addViews(subjects.size());
  constexpr double kTolerance = 0.005;
  constexpr size_t kMost = 80;
  FitResult result;
  {
    Progress progress("fitting", kMost, options.quiet);
    const auto cost = [&](const OctaveFactors& factors) {
      progress.advance();
      ++result.evaluations;
      return fit.cost(factors);
    };
    result.factors = leastOf(cost, kUnfittedFactors, kTolerance, kMost);
  }
  for (FitView& view : fit.views) {
    view.before = fit.errorOf(view, kUnfittedFactors);
    view.after = fit.errorOf(view, result.factors);
  }
  result.views = std::move(fit.views);
  return result;
}

}  // namespace nephele
