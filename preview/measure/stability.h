// Methods run over the table of cases: where each may be trusted, and how it flickers. Depends on
// preview/method.h, scene and preview/measure alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "preview/measure/compare.h"
#include "preview/measure/scene_facts.h"
#include "preview/measure/stability_cases.h"
#include "preview/method.h"

namespace nephele {

/// A method with what is set beside a case's own scene.
struct StabilityWay {
  std::string name;  // "march, light cached"
  MethodRow row;
  std::optional<bool> lightCache{};  // none: not looked at
};

/// Numbers that no picture may hold, over its planes R, G, B, A and transmittance.
struct BadValues {
  size_t notFinite = 0, negative = 0, aboveOne = 0;  // the last: of alpha and transmittance
  bool any() const { return notFinite + negative + aboveOne > 0; }
};
BadValues badValuesIn(const Picture& picture);

/// One way in one case.
struct StabilityCell {
  size_t way = 0;
  std::string axis, value;
  SceneFacts facts;                 // of the case
  std::optional<NoisyError> error;  // none: no truth, a dark truth, or refused
  BadValues bad;
  std::string refused;  // the sentence, where the method refuses the case
};

/// How the change from frame to frame errs: √(mean (Δx − Δr)²)/mean r.
struct Flicker {
  size_t way = 0;
  std::string motion;  // "orbit" or "sequence"
  double error = 0.0;
  double change = 0.0;  // of truth, in the same measure
};

struct StabilityOptions {
  std::vector<MethodRow> methods;  // built ones; `reference` among them
  int size = 32;                   // pixels along both edges
  unsigned samples = 16;           // a pixel, for all but truth
  unsigned truthSamples = 128;     // of truth, a pixel
  int frames = 48;                 // of each motion; below 2: none
  bool quiet = false;
};

struct StabilityResult {
  std::vector<StabilityWay> ways;
  std::vector<StabilityCell> cells;  // in the table's order, way by way
  std::vector<Flicker> flicker;
};

/// Every built method but the reference, the march with cached and with marched light; and the reference,
/// which is looked at for bad values.
std::vector<StabilityWay> waysOf(const std::vector<MethodRow>& methods);

/// Runs all. A case's truth is single scattering. Throws WorldError where a driver fails.
StabilityResult runStability(const StabilityOptions& options);

}  // namespace nephele
