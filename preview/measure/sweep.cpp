// Sweeping methods against truth. Depends on preview/method.h, scene and preview/measure alone.
#include "preview/measure/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "base/error.h"
#include "base/front.h"
#include "base/progress.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kTruth = "reference";

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A guess of relative cost, for order alone.
double guessedCost(const Setting& setting) {
  constexpr double kTruthCost = 0.1, kMarchedLight = 4.0;  // beside a march of one voxel under cached light
  if (setting.method == kTruth) return kTruthCost * setting.samples;
  return setting.samples / setting.march.stepVoxels * (setting.march.lightCache ? 1.0 : kMarchedLight);
}

/// Makes methods as they are needed and keeps them.
class Methods {
 public:
  Methods(const BrickVolume& bricks, const std::vector<MethodRow>& rows) : bricks_(bricks), rows_(rows) {}
  Method& at(const std::string& name) {
    std::unique_ptr<Method>& method = made_[name];
    if (!method) {
      const auto row =
          std::find_if(rows_.begin(), rows_.end(), [&](const MethodRow& r) { return r.name == name; });
      NEPHELE_CHECK_EQ(row != rows_.end() && row->make != nullptr, true);
      method = row->make({});
      method->setVolume(bricks_);
    }
    return *method;
  }

 private:
  const BrickVolume& bricks_;
  const std::vector<MethodRow>& rows_;
  std::map<std::string, std::unique_ptr<Method>> made_;
};

PictureRequest requestOf(const SweepOptions& options, unsigned samples, unsigned seed) {
  PictureRequest request;
  request.width = options.width;
  request.height = options.height;
  request.samples = samples;
  request.seed = seed;
  request.quiet = true;
  request.bounces = options.bounces;
  return request;
}

/// As many samples as fit into `seconds`, by the cost of a first picture.
Picture truthWithin(Methods& methods, const ViewedScene& view, const SweepOptions& options, double seconds) {
  // Another seed than the settings have: the reference, as a setting, is held against a picture of its own
  // making.
  constexpr unsigned kTruthSeed = 0x7247u, kPilot = 32, kMost = 1u << 16;
  PictureCost cost;
  Picture pilot = methods.at(kTruth).render(view, requestOf(options, kPilot, kTruthSeed), cost);
  const double fits = kPilot * (seconds - 1e-3 * cost.milliseconds) * 1e3 / std::max(cost.milliseconds, 1e-3);
  if (fits < 2.0 * kPilot) return pilot;
  const unsigned samples = static_cast<unsigned>(std::min(fits, double{kMost}));
  return methods.at(kTruth).render(view, requestOf(options, samples, kTruthSeed + 1), cost);
}

/// Means over views of the settings that were measured under all of them.
std::vector<Measured> overViews(const std::vector<Measured>& single, size_t settings, size_t views) {
  std::vector<Measured> all;
  for (size_t s = 0; s < settings; ++s) {
    Measured sum;
    sum.setting = s;
    sum.view = "all";
    double squares = 0.0, lows = 0.0, highs = 0.0, found = 0.0;
    for (const Measured& m : single) {
      if (m.setting != s) continue;
      found += 1.0;
      sum.milliseconds += m.milliseconds;
      sum.densitiesPerPixel += m.densitiesPerPixel;
      squares += m.error.relativeRmse * m.error.relativeRmse;
      lows += m.error.low * m.error.low;
      highs += m.error.high * m.error.high;
      sum.error.bias += m.error.bias;
      sum.error.p99 = std::max(sum.error.p99, m.error.p99);
    }
    if (found < static_cast<double>(views) || found == 0.0) continue;
    sum.milliseconds /= found;
    sum.densitiesPerPixel /= found;
    sum.error.bias /= found;
    sum.error.relativeRmse = std::sqrt(squares / found);
    sum.error.low = std::sqrt(lows / found);
    sum.error.high = std::sqrt(highs / found);
    all.push_back(sum);
  }
  return all;
}

}  // namespace

std::string nameOf(const Setting& setting) {
  std::ostringstream out;
  out << setting.method;
  if (setting.method != kTruth) {
    out << " step " << setting.march.stepVoxels;
    if (setting.march.lightCache)
      out << ", light cached every " << setting.march.cacheVoxels;
    else
      out << ", shadow step " << setting.march.shadowStepVoxels;
    if (setting.octaves) out << ", octaves " << *setting.octaves;
  }
  out << ", " << setting.samples << " spp";
  return out.str();
}

ViewedScene withSetting(const ViewedScene& view, const Setting& setting) {
  ViewedScene changed = view;
  changed.scene.march = setting.march;
  if (setting.octaves) changed.scene.octaves.count = *setting.octaves;
  return changed;
}

std::vector<Setting> settingsFor(const std::vector<std::string>& methods, const Scene& scene) {
  std::vector<Setting> settings;
  Setting setting;
  const auto add = [&](unsigned samples) {
    setting.samples = samples;
    setting.name = nameOf(setting);
    settings.push_back(setting);
  };
  for (const std::string& method : methods) {
    setting = {};
    setting.method = method;
    setting.march = scene.march;
    if (method == kTruth) {
      for (const unsigned samples : {1u, 4u, 16u, 64u, 256u}) add(samples);
      continue;
    }
    for (const double step : {8.0, 4.0, 2.0, 1.0, 0.5})
      for (const unsigned samples : {1u, 4u, 16u}) {
        setting.march.stepVoxels = step;
        setting.march.lightCache = true;
        setting.march.cacheDepth = std::numeric_limits<double>::max();
        add(samples);
        setting.march.lightCache = false;
        setting.march.shadowStepVoxels = 2.0 * step;
        add(samples);
      }
    setting.march = scene.march;
    if (scene.octaves.count.value_or(0) > 0)
      for (int octaves = 0; octaves <= 8; octaves += 2) {
        setting.octaves = octaves;
        add(4);
      }
  }
  std::stable_sort(settings.begin(), settings.end(),
                   [](const Setting& a, const Setting& b) { return guessedCost(a) < guessedCost(b); });
  return settings;
}

std::vector<SweepView> viewsFor(const ViewedScene& view) {
  std::vector<SweepView> views{{"as given", view}};
  const glm::dvec3 ahead = glm::normalize(view.camera.target - view.camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, view.camera.up));
  constexpr double kAbove = 0.3;  // of the distance ahead: the sun's height
  const auto lit = [&](const std::string& name, const glm::dvec3& toLight) {
    SweepView changed{name, view};
    for (Light& light : changed.view.scene.lights)
      if (Sun* sun = std::get_if<Sun>(&light)) sun->toLight = glm::normalize(toLight + kAbove * view.up);
    views.push_back(changed);
  };
  const bool hasSun = std::any_of(view.scene.lights.begin(), view.scene.lights.end(),
                                  [](const Light& light) { return std::holds_alternative<Sun>(light); });
  if (hasSun) lit("sun behind the cloud", ahead);
  const double distance = glm::length(view.camera.target - view.camera.position);
  SweepView side{"camera from the side", view};
  side.view.camera.position = view.camera.target + distance * glm::normalize(right + kAbove * view.up);
  side.view.camera.up = view.up;
  views.push_back(side);
  if (hasSun) lit("sun behind the camera", -ahead);
  return views;
}

namespace {

std::vector<CostAndError> costsOf(const std::vector<Measured>& points) {
  std::vector<CostAndError> costs;
  for (const Measured& m : points) costs.push_back({m.milliseconds, m.error.relativeRmse});
  return costs;
}

}  // namespace

std::vector<size_t> paretoFront(const std::vector<Measured>& points) { return paretoFront(costsOf(points)); }

size_t kneeOf(const std::vector<Measured>& points, const std::vector<size_t>& front) {
  return kneeOf(costsOf(points), front);
}

SweepResult sweep(const BrickVolume& bricks, const ViewedScene& given, const SweepOptions& asked) {
  const auto start = Clock::now();
  SweepOptions options = asked;
  if (!options.bounces && lightModelOf(given.scene, given.medium).octaveCount == 0) options.bounces = 0;
  std::vector<std::string> names;
  for (const MethodRow& row : options.methods)
    if (options.chartsTruth || row.name != kTruth) names.emplace_back(row.name);
  SweepResult result;
  result.settings = settingsFor(names, given.scene);
  const std::vector<SweepView> views = viewsFor(given);
  Methods made(bricks, options.methods);
  std::vector<double> lastCost(result.settings.size(), 0.0);  // seconds under the view before
  std::vector<bool> tried(result.settings.size(), true);
  size_t viewsDone = 0;
  constexpr double kTruthShare = 0.2;
  Progress progress("measuring", views.size() * result.settings.size(), options.quiet);
  for (const SweepView& view : views) {
    const double left = options.seconds - secondsSince(start);
    double expected = 0.0;
    for (size_t s = 0; s < lastCost.size(); ++s) expected += tried[s] ? lastCost[s] : 0.0;
    if (viewsDone > 0 &&
        expected + kTruthShare * options.seconds / static_cast<double>(views.size()) > left) {
      result.leftOut.push_back("the view '" + view.name + "'");
      continue;
    }
    const Picture truth = truthWithin(made, view.view, options,
                                      kTruthShare * options.seconds / static_cast<double>(views.size()));
    if (viewsDone == 0) result.shots.push_back({"truth", truth});
    // The first view may take half of the time: others are to follow.
    const double until = viewsDone == 0 ? 0.5 * options.seconds : options.seconds;
    std::map<std::pair<std::string, bool>, double>
        rates;  // seconds per guessed cost, by method and kind of light
    for (size_t s = 0; s < result.settings.size(); ++s) {
      progress.advance();
      if (!tried[s]) continue;
      const Setting& setting = result.settings[s];
      double& rate = rates[{setting.method, setting.march.lightCache}];
      if (viewsDone == 0 && secondsSince(start) + rate * guessedCost(setting) > until) {
        tried[s] = false;
        result.leftOut.push_back("'" + setting.name + "'");
        continue;
      }
      const auto before = Clock::now();
      Method& method = made.at(setting.method);
      PictureCost cost;
      const Picture picture =
          method.render(withSetting(view.view, setting), requestOf(options, setting.samples, 0), cost);
      Measured measured{s, view.name, cost.milliseconds, cost.densitySamplesPerPixel,
                        compareWithHalves(picture, truth)};
      result.single.push_back(measured);
      lastCost[s] = secondsSince(before);
      rate = 1e-3 * cost.milliseconds / guessedCost(setting);
      if (viewsDone == 0) result.shots.push_back({setting.name, picture});
    }
    ++viewsDone;
  }
  result.all = overViews(result.single, result.settings.size(), viewsDone);
  result.front = paretoFront(result.all);
  result.knee = kneeOf(result.all, result.front);
  return result;
}

}  // namespace nephele
