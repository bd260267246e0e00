// Methods and their settings held against truth: what a chart shows and what --error chooses from. Depends on
// preview/method.h, scene and preview/measure alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "preview/measure/compare.h"
#include "preview/method.h"

namespace nephele {

/// One way to render: a method and what is set beside its defaults.
struct Setting {
  std::string method;
  std::string name;  // "step 0.5, shadow 1, 4 spp"
  unsigned samples = 1;
  MarchSettings march;
  std::optional<int> octaves;  // none: the scene's
  bool chord = false;          // light by the chord; else as the scene says
  bool powder = false;         // on; else as the scene says
  int coarser = 1;             // pixels along an edge that one rendered pixel stands for, enlarged linearly
};

/// A guess of relative cost, for order alone.
double guessedCost(const Setting& setting);
/// "march step 0.5, light cached every 2, 4 spp".
std::string nameOf(const Setting& setting);
/// The view with all of a setting that is the scene's.
ViewedScene withSetting(const ViewedScene& view, const Setting& setting);

/// A camera and a light to measure under.
struct SweepView {
  std::string name;
  ViewedScene view;
};

/// What one setting cost and erred under one view, or as root mean square over all (view: "all").
struct Measured {
  size_t setting = 0;
  std::string view;
  double milliseconds = 0.0;
  double densitiesPerPixel = 0.0;
  NoisyError error;
};

struct SweepOptions {
  std::vector<MethodRow> methods;  // built ones; `reference` among them, which is truth as well
  bool chartsTruth = true;         // the reference is a setting too
  int width = 128, height = 72;
  double seconds = 300.0;      // that all may take
  std::optional<int> bounces;  // of truth; none: 0 where the scene's octaves are 0, else all orders
  bool quiet = false;
};

struct SweepResult {
  std::vector<Setting> settings;
  std::vector<Measured> single;  // one setting under one view
  std::vector<Measured> all;     // settings measured under every view that was looked at
  std::vector<size_t> front;     // indices into `all`: no other is both faster and more accurate; by time
  size_t knee = 0;               // index into `front` of the point farthest below the line between its ends
  std::vector<std::string> leftOut;  // what was not measured, and why
  struct Shot {
    std::string name;  // of the setting, or "truth"
    Picture picture;
  };
  std::vector<Shot> shots;  // under the first view: truth first, then settings in the order of `settings`
};

/// Settings that a sweep tries for the methods of these names, cheap ones first.
std::vector<Setting> settingsFor(const std::vector<std::string>& methods, const Scene& scene);

/// The given view, lit from behind and from the side, and seen from above: as MODEL.md's terms differ most
/// there.
std::vector<SweepView> viewsFor(const ViewedScene& view);

/// Truth is traced for each view within a fifth of the time, with two independent halves. Settings that would
/// take more than what is left are left out and named. Time is each picture's own (PictureCost), without a
/// driver's start and with shaders built and the view's light cache filled.
SweepResult sweep(const BrickVolume& bricks, const ViewedScene& view, const SweepOptions& options);

/// Indices of the points that no other beats in both time and error, by time, as far as what they gain is
/// worth naming (kWorthNaming); and of the knee among them: the point farthest below the line between the
/// front's ends, both axes logarithmic.
std::vector<size_t> paretoFront(const std::vector<Measured>& points);
size_t kneeOf(const std::vector<Measured>& points, const std::vector<size_t>& front);

}  // namespace nephele
