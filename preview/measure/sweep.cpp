// Sweeping methods against truth. Depends on preview/method.h, scene and preview/measure alone.
#include "preview/measure/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>

#include "base/enlarge.h"
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

/// One sweep as it goes on: view by view, in each all settings that still fit into the time.
class Sweep {
 public:
  Sweep(const BrickVolume& bricks, const ViewedScene& given, const SweepOptions& options)
      : options_(options),
        views_(viewsFor(given)),
        methods_(bricks, options_.methods),
        truthSeconds_(kTruthShare * options.seconds / static_cast<double>(views_.size())) {
    std::vector<std::string> names;
    for (const MethodRow& row : options_.methods)
      if (options_.chartsTruth || row.name != kTruth) names.emplace_back(row.name);
    result_.settings = settingsFor(names, given.scene);
    lastCost_.assign(result_.settings.size(), 0.0);
    tried_.assign(result_.settings.size(), true);
  }

  SweepResult run() {
    Progress progress("measuring", views_.size() * result_.settings.size(), options_.quiet);
    for (const SweepView& view : views_) look(view, progress);
    result_.all = overViews(result_.single, result_.settings.size(), viewsDone_);
    result_.front = paretoFront(result_.all);
    result_.knee = kneeOf(result_.all, result_.front);
    return std::move(result_);
  }

 private:
  static constexpr double kTruthShare = 0.2;  // of all the time
  /// Seconds per guessed cost, by method and kind of light.
  using Rates = std::map<std::pair<std::string, bool>, double>;

  void look(const SweepView& view, Progress& progress) {
    double expected = truthSeconds_;
    for (size_t s = 0; s < lastCost_.size(); ++s) expected += tried_[s] ? lastCost_[s] : 0.0;
    if (viewsDone_ > 0 && expected > options_.seconds - secondsSince(start_)) {
      result_.leftOut.push_back("the view '" + view.name + "', for want of time");
      return;
    }
    const Picture truth = truthWithin(methods_, view.view, options_, truthSeconds_);
    if (viewsDone_ == 0) result_.shots.push_back({"truth", truth});
    Rates rates;
    for (size_t s = 0; s < result_.settings.size(); ++s) {
      progress.advance();
      if (tried_[s] && fits(s, rates)) measure(s, view, truth, rates);
    }
    ++viewsDone_;
  }

  /// Whether a setting can be measured in the time that is left; else it is left out, and named.
  bool fits(size_t s, Rates& rates) {
    const Setting& setting = result_.settings[s];
    const bool divides = options_.width % setting.coarser == 0 && options_.height % setting.coarser == 0;
    const double needed = rates[rateOf(setting)] * guessedCost(setting);
    // The first view may take half of the time: others are to follow.
    const bool late = viewsDone_ == 0 && secondsSince(start_) + needed > 0.5 * options_.seconds;
    if (divides && !late) return true;
    tried_[s] = false;
    result_.leftOut.push_back(
        "'" + setting.name +
        (divides ? "', for want of time" : "': the picture's edges are no multiples of it"));
    return false;
  }

  void measure(size_t s, const SweepView& view, const Picture& truth, Rates& rates) {
    const Setting& setting = result_.settings[s];
    const auto before = Clock::now();
    Method& method = methods_.at(setting.method);
    const ViewedScene set = withSetting(view.view, setting);
    warmUp(method, set, options_, setting);
    PictureCost cost;
    const Picture picture =
        enlarged(method.render(set, requestOf(options_, setting.samples, 0, setting.coarser), cost),
                 options_.width, options_.height);
    const double pixels = 1.0 / (setting.coarser * setting.coarser);  // rendered, a pixel of the picture
    result_.single.push_back({s, view.name, cost.milliseconds, pixels * cost.densitySamplesPerPixel,
                              compareWithHalves(picture, truth)});
    lastCost_[s] = secondsSince(before);
    rates[rateOf(setting)] = 1e-3 * cost.milliseconds / guessedCost(setting);
    if (viewsDone_ == 0) result_.shots.push_back({setting.name, picture});
  }

  static Rates::key_type rateOf(const Setting& setting) { return {setting.method, setting.march.lightCache}; }

  const Clock::time_point start_ = Clock::now();
  const SweepOptions& options_;
  const std::vector<SweepView> views_;
  Methods methods_;
  const double truthSeconds_;  // that a view's truth may take
  SweepResult result_;
  std::vector<double> lastCost_;  // of each setting, seconds under the view before
  std::vector<bool> tried_;       // whether it is still
  size_t viewsDone_ = 0;
};

}  // namespace

std::vector<size_t> paretoFront(const std::vector<Measured>& points) {
  return paretoFront(costsOf(points), kWorthNaming);
}

size_t kneeOf(const std::vector<Measured>& points, const std::vector<size_t>& front) {
  return kneeOf(costsOf(points), front);
}

SweepResult sweep(const BrickVolume& bricks, const ViewedScene& given, const SweepOptions& asked) {
  SweepOptions options = asked;
  if (!options.bounces && lightModelOf(given.scene, given.medium).octaveCount == 0) options.bounces = 0;
  return Sweep(bricks, given, options).run();
}

}  // namespace nephele
