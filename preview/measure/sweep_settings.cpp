// What a sweep tries: settings of each method, and views. Depends on preview/measure/sweep.h, scene.
#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <sstream>

#include "preview/measure/sweep.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

constexpr const char *kTruth = "reference", *kMarch = "march", *kDda = "dda";
constexpr double kMiddleStep = 1.0;     // voxels, where something else is swept
constexpr unsigned kMiddleSamples = 4;  // a pixel, likewise

/// Makes settings one after another, each from a method's middle.
class Settings {
 public:
  explicit Settings(const Scene& scene) : scene_(scene) {}

  /// Nothing where the same is there already.
  void add(Setting setting) {
    setting.name = nameOf(setting);
    for (const Setting& other : made_)
      if (other.name == setting.name) return;
    made_.push_back(std::move(setting));
  }
  /// Steps of kMiddleStep, light cached, nothing else set.
  Setting middle(const std::string& method) const {
    Setting setting;
    setting.method = method;
    setting.samples = method == kTruth ? 1 : kMiddleSamples;
    setting.march = scene_.march;
    setting.march.stepVoxels = kMiddleStep;
    setting.march.lightCache = true;
    setting.march.cacheDepth = std::numeric_limits<double>::max();
    return setting;
  }
  /// Light cached and marched, at 1, 4 and 16 samples.
  void addLights(Setting setting) {
    for (const unsigned samples : {1u, 4u, 16u})
      for (const bool cached : {true, false}) {
        setting.samples = samples;
        setting.march.lightCache = cached;
        if (!cached) setting.march.shadowStepVoxels = 2.0 * setting.march.stepVoxels;
        add(setting);
      }
  }
  std::vector<Setting> take() { return std::move(made_); }

 private:
  const Scene& scene_;
  std::vector<Setting> made_;
};

/// Shadow samples, the chord, powder, precision, levels and resolution, one at a time from the middle.
void addOneByOne(Settings& settings) {
  for (const double shadowStep : {0.5, 1.0, 4.0, 8.0}) {
    Setting setting = settings.middle(kMarch);
    setting.march.lightCache = false;
    setting.march.shadowStepVoxels = shadowStep;
    settings.add(setting);
  }
  Setting chord = settings.middle(kMarch), powder = chord;
  chord.chord = true;
  settings.add(chord);
  powder.powder = true;
  settings.add(powder);
  for (const AtlasPrecision precision : {AtlasPrecision::r8, AtlasPrecision::r16f, AtlasPrecision::r32f}) {
    Setting setting = settings.middle(kMarch);
    setting.march.precision = precision;
    settings.add(setting);
  }
  for (const double pixels : {0.5, 1.0, 2.0, 4.0}) {
    Setting setting = settings.middle(kMarch);
    setting.march.levelPixels = pixels;
    settings.add(setting);
  }
  for (const int coarser : {2, 4}) {
    Setting setting = settings.middle(kMarch);
    setting.coarser = coarser;
    settings.add(setting);
  }
}

}  // namespace

std::string nameOf(const Setting& setting) {
  std::ostringstream out;
  out << setting.method;
  if (setting.method != kTruth) {
    if (setting.method != kDda) out << " step " << setting.march.stepVoxels << ',';
    if (setting.chord)
      out << " light by the chord";
    else if (setting.march.lightCache)
      out << " light cached every " << setting.march.cacheVoxels;
    else
      out << " shadow step " << setting.march.shadowStepVoxels;
    if (setting.octaves) out << ", octaves " << *setting.octaves;
    if (setting.powder) out << ", powder";
    if (setting.march.precision != AtlasPrecision::automatic)
      out << ", texels " << nameOf(setting.march.precision);
    if (setting.march.levelPixels > 0.0) out << ", voxels up to " << setting.march.levelPixels << " px";
    if (setting.coarser > 1) out << ", 1/" << setting.coarser << " of the resolution";
    out << ',';
  } else {
    out << ',';
  }
  out << ' ' << setting.samples << " spp";
  return out.str();
}

double guessedCost(const Setting& setting) {
  constexpr double kTruthCost = 0.1, kMarchedLight = 4.0;  // beside a march of one voxel under cached light
  if (setting.method == kTruth) return kTruthCost * setting.samples;
  const bool marches = !setting.march.lightCache && !setting.chord;
  return setting.samples / setting.march.stepVoxels * (marches ? kMarchedLight : 1.0) /
         (setting.coarser * setting.coarser);
}

ViewedScene withSetting(const ViewedScene& view, const Setting& setting) {
  ViewedScene changed = view;
  changed.scene.march = setting.march;
  if (setting.octaves) changed.scene.octaves.count = *setting.octaves;
  if (setting.chord) changed.scene.lightTransmittance = LightTransmittance::chord;
  if (setting.powder) changed.scene.powder.on = true;
  return changed;
}

std::vector<Setting> settingsFor(const std::vector<std::string>& methods, const Scene& scene) {
  Settings settings(scene);
  for (const std::string& method : methods) {
    if (method == kTruth) {
      for (const unsigned samples : {1u, 4u, 16u, 64u, 256u}) {
        Setting setting = settings.middle(method);
        setting.samples = samples;
        settings.add(setting);
      }
      continue;
    }
    const bool marches = method == kMarch;
    const std::vector<double> steps = marches          ? std::vector{8.0, 4.0, 2.0, 1.0, 0.5}
                                      : method == kDda ? std::vector{kMiddleStep}
                                                       : std::vector{4.0, kMiddleStep};
    for (const double step : steps) {
      Setting setting = settings.middle(method);
      setting.march.stepVoxels = step;
      settings.addLights(setting);
    }
    if (!marches) continue;
    addOneByOne(settings);
    constexpr int kMostOctaves = 8;
    if (scene.octaves.count.value_or(0) > 0)
      for (int octaves = 0; octaves <= kMostOctaves; ++octaves) {
        Setting setting = settings.middle(method);
        setting.octaves = octaves;
        settings.add(setting);
      }
  }
  std::vector<Setting> made = settings.take();
  std::stable_sort(made.begin(), made.end(),
                   [](const Setting& a, const Setting& b) { return guessedCost(a) < guessedCost(b); });
  return made;
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

}  // namespace nephele
