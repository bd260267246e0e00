// Sweeping methods against truth. Depends on preview/method.h, scene and preview/measure alone.
#include "preview/measure/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>

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

PictureRequest requestOf(const SweepOptions& options, unsigned samples, unsigned seed, int coarser = 1) {
  PictureRequest request;
  request.width = options.width / coarser;
  request.height = options.height / coarser;
  request.samples = samples;
  request.seed = seed;
  request.quiet = true;
  request.bounces = options.bounces;
  return request;
}

/// Each plane, linear between the centres of the smaller picture's pixels and held beyond them.
Picture enlarged(const Picture& small, int times) {
  if (times == 1) return small;
  Picture large;
  large.width = small.width * times;
  large.height = small.height * times;
  for (const std::string& name : small.names) large.add(name);
  const auto place = [times](int at, int length) {
    return std::clamp((at + 0.5) / times - 0.5, 0.0, length - 1.0);
  };
  for (int y = 0; y < large.height; ++y)
    for (int x = 0; x < large.width; ++x) {
      const double fromX = place(x, small.width), fromY = place(y, small.height);
      const int x0 = static_cast<int>(fromX), y0 = static_cast<int>(fromY);
      const int x1 = std::min(x0 + 1, small.width - 1), y1 = std::min(y0 + 1, small.height - 1);
      for (size_t plane = 0; plane < small.planes.size(); ++plane) {
        const auto at = [&](int column, int row) {
          return double{small.planes[plane][static_cast<size_t>(row) * static_cast<size_t>(small.width) +
                                            static_cast<size_t>(column)]};
        };
        const double above = std::lerp(at(x0, y0), at(x1, y0), fromX - x0),
                     below = std::lerp(at(x0, y1), at(x1, y1), fromX - x0);
        large.planes[plane][static_cast<size_t>(y) * static_cast<size_t>(large.width) +
                            static_cast<size_t>(x)] = static_cast<float>(std::lerp(above, below, fromY - y0));
      }
    }
  return large;
}

/// A picture of one sample a pixel that nothing is taken of: shaders are built by then. The reference has
/// none.
void warmUp(Method& method, const ViewedScene& view, const SweepOptions& options, const Setting& setting) {
  if (setting.method == kTruth) return;
  PictureCost cost;
  method.render(view, requestOf(options, 1, 0, setting.coarser), cost);
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

std::vector<CostAndError> costsOf(const std::vector<Measured>& points) {
  std::vector<CostAndError> costs;
  for (const Measured& m : points) costs.push_back({m.milliseconds, m.error.relativeRmse});
  return costs;
}

}  // namespace

std::vector<size_t> paretoFront(const std::vector<Measured>& points) {
  return paretoFront(costsOf(points), kWorthNaming);
}

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
      result.leftOut.push_back("the view '" + view.name + "', for want of time");
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
      if (options.width % setting.coarser != 0 || options.height % setting.coarser != 0) {
        tried[s] = false;
        result.leftOut.push_back("'" + setting.name + "': the picture's edges are no multiples of it");
        continue;
      }
      double& rate = rates[{setting.method, setting.march.lightCache}];
      if (viewsDone == 0 && secondsSince(start) + rate * guessedCost(setting) > until) {
        tried[s] = false;
        result.leftOut.push_back("'" + setting.name + "', for want of time");
        continue;
      }
      const auto before = Clock::now();
      Method& method = made.at(setting.method);
      const ViewedScene set = withSetting(view.view, setting);
      warmUp(method, set, options, setting);
      PictureCost cost;
      const Picture picture = enlarged(
          method.render(set, requestOf(options, setting.samples, 0, setting.coarser), cost), setting.coarser);
      const double pixels = 1.0 / (setting.coarser * setting.coarser);  // rendered, a pixel of the picture
      Measured measured{s, view.name, cost.milliseconds, pixels * cost.densitySamplesPerPixel,
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
